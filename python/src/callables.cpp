// The arrays of a query are filled with the lock free, handed over and called under it, and the answer is copied with
// the lock free. If one number represents three channels, it is their luminance.
#include "callables.h"

#include <nanobind/ndarray.h>

#include "scene_context.h"

namespace crescent::python {

namespace {

using Rows = nb::ndarray<const double, nb::ndim<2>, nb::device::cpu>;
using Column = nb::ndarray<const double, nb::ndim<1>, nb::device::cpu>;

void must_be(std::size_t n, std::size_t expected) {
    if (n != expected) throw nb::value_error("crescent._arrays let an array of another length through");
}

Draw draw_of(
    const Callables& c, const Rows& wi, const Column& pdf, const Rows& weight, const Column& delta, std::size_t i) {
    Draw d{{wi(i, 0), wi(i, 1), wi(i, 2)}, pdf(i)};
    if (weight.is_valid()) {
        d.weights = weight.shape(1) == 3 ? Vec3d{weight(i, 0), weight(i, 1), weight(i, 2)}
                                         : Vec3d{weight(i, 0), weight(i, 0), weight(i, 0)};
        d.weight = weight.shape(1) == 3 ? luminance(d.weights) : d.weights.x;
    }
    if (delta.is_valid() && delta(i) > 0) {
        d.delta = delta(i);
        d.pdf = 0;
    }
    if (c.upper_only && d.wi.z <= 0) {
        d.pdf = 0;
        if (d.delta == 0) d.weight.reset();  // any result of the callables is ignored there
    }
    return d;
}

}  // namespace

CallableSampler::CallableSampler(Callables callables) : c_(std::move(callables)) {
    const bool has_f = c_.f.is_valid() && !c_.f.is_none();
    constexpr std::size_t rows_a_call = 32768;
    declaration_ = {.name = c_.name,
        .traits = c_.traits,
        .has_f = has_f,
        .has_drawn_f = has_f || c_.weighs,
        .weighs = c_.weights.is_valid() && !c_.weights.is_none(),
        .serial = c_.serial,
        .limited = true,
        .uses = {c_.uses.begin(), c_.uses.end()},
        .batch_rows = rows_a_call,
        .device = c_.device};
}

/// Calls callable(wo, u or wi[, context]), and take(answer) with the lock held. An exception stops the work and is
/// raised again at its end.
template <class Take>
void CallableSampler::call(const nb::object& callable, const SamplerQuery& query, Take&& take) const {
    using Kind = SamplerQuery::Kind;
    if (raised_) raised_->check();
    Table wo = outgoing_of(query);
    Table second = query.kind == Kind::sample ? numbers_of(query.u, static_cast<std::size_t>(c_.traits.numbers))
                                              : incident_of(query.pairs);
    std::vector<Table> tables;
    if (query.scene) tables = context_of(*query.scene, query.rows(), c_.uses);
    if (query.kind == Kind::weigh) tables.push_back(densities_of(query));
    const Locked python_lock;
    try {
        if (query.scene) {
            nb::dict context;
            for (Table& table : tables) context[table.name().c_str()] = table.take();
            if (c_.uses.contains("lights")) put_lights(query.scene->lights, context);
            take(call_python(callable, wo.take(), second.take(), context));
        } else {
            take(call_python(callable, wo.take(), second.take()));
        }
        if (c_.serial && PyErr_CheckSignals() != 0) throw nb::python_error();
    } catch (...) {
        if (!raised_) throw;
        raised_->keep();
        throw Interrupted{};
    }
    answers_.fetch_add(query.rows(), std::memory_order_relaxed);
}

void CallableSampler::draw_rows(const SamplerQuery& query, std::span<Draw> out) const {
    const bool lacks_density = !query.scene && !c_.traits.has_pdf;  // a run divides by the pdf of the draw
    call(c_.sample, query, [&](const nb::object& value) {
        const nb::tuple answer = nb::cast<nb::tuple>(value);
        const Rows wi = nb::cast<Rows>(answer[0]);
        const Column pdf = nb::cast<Column>(answer[1]);
        Rows weight;
        Column delta;
        if (answer.size() > 2 && !answer[2].is_none()) weight = nb::cast<Rows>(answer[2]);
        if (answer.size() > 3 && !answer[3].is_none()) delta = nb::cast<Column>(answer[3]);
        must_be(wi.shape(0), out.size());
        must_be(wi.shape(1), 3);
        must_be(pdf.shape(0), out.size());
        const Unlocked free;
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = draw_of(c_, wi, pdf, weight, delta, i);
            if (lacks_density && out[i].pdf > 0) out[i].pdf = 1;
        }
    });
    draws_ += out.size();
}

void CallableSampler::pdf_rows(const SamplerQuery& query, std::span<double> out) const {
    if (c_.pdf.is_none()) return std::fill(out.begin(), out.end(), 1.0);
    call(c_.pdf, query, [&](const nb::object& answer) {
        const Column p = nb::cast<Column>(answer);
        must_be(p.shape(0), out.size());
        const Unlocked free;
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = c_.upper_only && query.pairs[i].wi.z <= 0 ? 0 : p(i);
    });
}

void CallableSampler::f_rows_by_channel(const SamplerQuery& query, std::span<Vec3d> out) const {
    if (!declaration_.has_f) return;
    call(c_.f, query, [&](const nb::object& answer) {
        const Rows f = nb::cast<Rows>(answer);
        must_be(f.shape(0), out.size());
        const bool has_three_channels = f.shape(1) == 3;
        const Unlocked free;
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = has_three_channels ? Vec3d{f(i, 0), f(i, 1), f(i, 2)} : Vec3d{f(i, 0), f(i, 0), f(i, 0)};
            if (c_.upper_only && query.pairs[i].wi.z <= 0) out[i] = {};
        }
    });
}

void CallableSampler::f_rows(const SamplerQuery& query, std::span<double> out) const {
    std::vector<Vec3d> by_channel(out.size());
    f_rows_by_channel(query, by_channel);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = c_.traits.channels == 3 ? luminance(by_channel[i]) : by_channel[i].x;
}

void CallableSampler::weight_rows(const SamplerQuery& query, std::span<double> out) const {
    const std::size_t rows = query.rows(), samplers = query.densities.size() / rows;
    call(c_.weights, query, [&](const nb::object& answer) {
        const Rows w = nb::cast<Rows>(answer);
        must_be(w.shape(0), rows);
        must_be(w.shape(1), samplers);
        for (std::size_t i = 0; i < rows; ++i)
            for (std::size_t k = 0; k < samplers; ++k) out[i * samplers + k] = w(i, k);
    });
}

std::map<std::string, std::shared_ptr<const CallableSampler>> samplers_of(const CallableArms& callables) {
    std::map<std::string, std::shared_ptr<const CallableSampler>> out;
    for (const auto& [name, draw, pdf, weights, numbers, uses, one_thread] : callables)
        out[name] = std::make_shared<CallableSampler>(Callables{.name = name,
            .sample = draw,
            .pdf = pdf,
            .f = nb::none(),
            .weights = weights,
            .traits = {.numbers = numbers, .has_pdf = !pdf.is_none()},
            .uses = {uses.begin(), uses.end()},
            .serial = one_thread});
    return out;
}

}  // namespace crescent::python
