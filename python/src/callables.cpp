// A query is written into column-major arrays of doubles that Python owns, the callable is called under the lock, and
// its result is copied with the lock released. If one number represents three channels, it is their luminance.
#include "callables.h"

#include <nanobind/ndarray.h>

namespace crescent::python {

namespace {

using Made = nb::ndarray<nb::numpy, double>;
using Rows = nb::ndarray<const double, nb::ndim<2>, nb::device::cpu>;
using Column = nb::ndarray<const double, nb::ndim<1>, nb::device::cpu>;

/// Returns an array [n, k] that Python owns, filled column by column: fill(row, column).
template <class Fill> nb::object matrix(std::size_t n, std::size_t k, Fill&& fill) {
    auto* data = new double[n * k];
    const nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
    {
        const Unlocked free;
        for (std::size_t j = 0; j < k; ++j)
            for (std::size_t i = 0; i < n; ++i) data[j * n + i] = fill(i, j);
    }
    return nb::cast(Made(data, {n, k}, owner, {1, static_cast<std::int64_t>(n)}));
}

double component(Vec3d v, std::size_t j) { return j == 0 ? v.x : j == 1 ? v.y : v.z; }

nb::object directions(std::span<const Pair> at, Vec3d Pair::* which) {
    return matrix(at.size(), 3, [&](std::size_t i, std::size_t j) { return component(at[i].*which, j); });
}

void must_be(std::size_t n, std::size_t wanted) {
    if (n != wanted) throw nb::value_error("crescent._arrays let an array of another length through");
}

}  // namespace

/// The callables are called with the lock held; an exception stops the check and is raised again at its end.
template <class Ask> void CallableSampler::ask(Ask&& ask) const {
    if (raised_) raised_->check();
    const Locked held;
    try {
        ask();
        if (c_.serial && PyErr_CheckSignals() != 0) throw nb::python_error();
    } catch (...) {
        if (!raised_) throw;
        raised_->keep();
        throw Interrupted{};
    }
}

void CallableSampler::sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const {
    if (u.empty()) return;
    ask([&] {
        const nb::object from = matrix(u.size(), 3, [&](std::size_t, std::size_t j) { return component(wo, j); });
        const nb::object numbers = matrix(u.size(), static_cast<std::size_t>(c_.traits.numbers),
            [&](std::size_t i, std::size_t j) { return u[i][static_cast<int>(j)]; });
        const nb::tuple answer = nb::cast<nb::tuple>(call_python(c_.sample, from, numbers));
        const Rows wi = nb::cast<Rows>(answer[0]);
        const Column pdf = nb::cast<Column>(answer[1]);
        Rows weight;
        Column delta;
        if (!answer[2].is_none()) weight = nb::cast<Rows>(answer[2]);
        if (!answer[3].is_none()) delta = nb::cast<Column>(answer[3]);
        must_be(wi.shape(0), u.size());
        const Unlocked free;
        for (std::size_t i = 0; i < u.size(); ++i) {
            Draw& d = out[i] = Draw{{wi(i, 0), wi(i, 1), wi(i, 2)}, pdf(i)};
            if (weight.is_valid()) {
                d.weights = weight.shape(1) == 3 ? Vec3d{weight(i, 0), weight(i, 1), weight(i, 2)}
                                                 : Vec3d{weight(i, 0), weight(i, 0), weight(i, 0)};
                d.weight = weight.shape(1) == 3 ? luminance(d.weights) : d.weights.x;
            }
            if (delta.is_valid() && delta(i) > 0) {
                d.delta = delta(i);
                d.pdf = 0;
            }
            if (!c_.traits.has_pdf && d.pdf > 0) d.pdf = 1;
            if (c_.upper_only && d.wi.z <= 0) {
                d.pdf = 0;
                if (d.delta == 0) d.weight.reset();  // any result of the callables is ignored there
            }
        }
    });
    draws_ += u.size();
    count(u.size());
}

void CallableSampler::pdf(int, std::span<const Pair> at, std::span<double> out) const {
    if (c_.pdf.is_none()) return std::fill(out.begin(), out.end(), 1.0);
    if (at.empty()) return;
    ask([&] {
        const Column p = nb::cast<Column>(call_python(c_.pdf, directions(at, &Pair::wo), directions(at, &Pair::wi)));
        must_be(p.shape(0), at.size());
        const Unlocked free;
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = c_.upper_only && at[i].wi.z <= 0 ? 0 : p(i);
    });
    count(at.size());
}

void CallableSampler::f_channels(std::span<const Pair> at, std::span<Vec3d> out) const {
    if (at.empty() || c_.f.is_none()) return;
    ask([&] {
        const Rows f = nb::cast<Rows>(call_python(c_.f, directions(at, &Pair::wo), directions(at, &Pair::wi)));
        must_be(f.shape(0), at.size());
        const bool three = f.shape(1) == 3;
        const Unlocked free;
        for (std::size_t i = 0; i < at.size(); ++i) {
            out[i] = three ? Vec3d{f(i, 0), f(i, 1), f(i, 2)} : Vec3d{f(i, 0), f(i, 0), f(i, 0)};
            if (c_.upper_only && at[i].wi.z <= 0) out[i] = {};
        }
    });
    count(at.size());
}

void CallableSampler::f(std::span<const Pair> at, std::span<double> out) const {
    std::vector<Vec3d> by_channel(out.size());
    f_channels(at, by_channel);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = c_.traits.channels == 3 ? luminance(by_channel[i]) : by_channel[i].x;
}

}  // namespace crescent::python
