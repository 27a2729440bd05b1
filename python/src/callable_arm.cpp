// The arrays of a batch are filled with the lock free, handed over and called under it, and the answer is copied with
// the lock free. Columns are contiguous: an array [n, K, 3] has one column for each of its 3 K components.
#include "callable_arm.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <memory>
#include <vector>

namespace crescent::python {

namespace {

using Owned = nb::ndarray<nb::numpy, double>;
using Rows = nb::ndarray<const double, nb::ndim<2>, nb::device::cpu>;
using Column = nb::ndarray<const double, nb::ndim<1>, nb::device::cpu>;

double component(const Vec3d& v, std::size_t j) { return j == 0 ? v.x : j == 1 ? v.y : v.z; }

/// An array that is filled before Python owns it: rows, and the shape of one row.
class Table {
public:
    Table(std::string name, std::size_t rows, std::vector<std::size_t> of_row)
        : name_(std::move(name)), rows_(rows), of_row_(std::move(of_row)) {
        for (const std::size_t k : of_row_) columns_ *= k;
        data_.reset(new double[std::max<std::size_t>(1, rows_ * columns_)]);
    }
    const std::string& name() const { return name_; }
    std::size_t columns() const { return columns_; }
    double* column(std::size_t k) { return data_.get() + k * rows_; }

    /// With the lock held, once.
    nb::object take() {
        std::vector<std::size_t> shape{rows_};
        std::vector<std::int64_t> strides{1};
        std::int64_t stride = static_cast<std::int64_t>(rows_ * columns_);
        for (const std::size_t k : of_row_) {
            stride /= static_cast<std::int64_t>(std::max<std::size_t>(1, k));
            shape.push_back(k);
            strides.push_back(stride);
        }
        double* data = data_.release();
        const nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
        return nb::cast(Owned(data, shape.size(), shape.data(), owner, strides.data()));
    }

private:
    std::string name_;
    std::size_t rows_;
    std::vector<std::size_t> of_row_;
    std::size_t columns_ = 1;
    std::unique_ptr<double[]> data_;
};

/// One value a run, at(run, column), repeated over its rows.
template <class At> Table per_run(
    const char* name, const ExternalBatch& batch, std::size_t rows, std::vector<std::size_t> of_row, At&& at) {
    Table out(name, rows, std::move(of_row));
    for (std::size_t j = 0; j < out.columns(); ++j) {
        double* to = out.column(j);
        for (std::size_t r = 0; r < batch.runs.size(); ++r) to = std::fill_n(to, batch.runs[r].rows, at(r, j));
    }
    return out;
}

Table numbers_of(const ExternalBatch& batch, std::size_t rows, std::size_t count) {
    Table out("u", rows, {count});
    for (std::size_t k = 0; k < count; ++k) {
        double* to = out.column(k);
        for (std::size_t i = 0; i < rows; ++i) to[i] = batch.u[i * count + k];
    }
    return out;
}

/// What the lights are to each row.
void add_lights(const ExternalBatch& batch, std::size_t rows, std::vector<Table>& to) {
    const std::size_t count = batch.lights.size();
    const auto vectors = [&](const char* name, Vec3d ExternalLightAt::* which) {
        to.push_back(per_run(name, batch, rows, {count, 3},
            [&](std::size_t r, std::size_t j) { return component(batch.lights_at[r * count + j / 3].*which, j % 3); }));
    };
    vectors("position", &ExternalLightAt::center);
    vectors("normal", &ExternalLightAt::normal);
    vectors("edge_u", &ExternalLightAt::edge_u);
    vectors("edge_v", &ExternalLightAt::edge_v);
    to.push_back(per_run("shines", batch, rows, {count},
        [&](std::size_t r, std::size_t j) { return batch.lights_at[r * count + j].shines ? 1.0 : 0.0; }));
}

/// The constants of the lights, with the lock held.
void put_lights(std::span<const ExternalLight> lights, nb::dict& to) {
    nb::list kinds;
    Table radius("radius", lights.size(), {}), radiance("radiance", lights.size(), {3});
    for (std::size_t k = 0; k < lights.size(); ++k) {
        kinds.append(nb::str(lights[k].kind.data(), lights[k].kind.size()));
        radius.column(0)[k] = lights[k].radius;
        for (std::size_t c = 0; c < 3; ++c) radiance.column(c)[k] = lights[k].radiance[c];
    }
    to["kind"] = kinds;
    to["radius"] = radius.take();
    to["radiance"] = radiance.take();
}

std::vector<Table> context_of(const ExternalBatch& batch, std::size_t rows, const std::set<std::string>& uses) {
    std::vector<Table> all;
    const auto surface = [&](const char* name, double ExternalSurface::* which) {
        if (!uses.contains(name)) return;
        all.push_back(
            per_run(name, batch, rows, {}, [&](std::size_t r, std::size_t) { return batch.runs[r].surface.*which; }));
    };
    surface("s", &ExternalSurface::s);
    surface("alpha", &ExternalSurface::alpha);
    surface("rho_s", &ExternalSurface::lobe);
    for (const char* name : {"side", "eta"})  // scenes are opaque, and seen from the side of the normal
        if (uses.contains(name))
            all.push_back(per_run(name, batch, rows, {}, [](std::size_t, std::size_t) { return 1.0; }));
    if (uses.contains("rho_d"))
        all.push_back(
            per_run("rho_d", batch, rows, {3}, [&](std::size_t r, std::size_t c) { return batch.runs[r].rho_d[c]; }));
    if (uses.contains("lights")) add_lights(batch, rows, all);
    return all;
}

constexpr const char* another_shape = "crescent._context let an array of another shape through";

/// Calls callable(wo, second, context) for a batch, and take(answer) with the lock held.
template <class Take> void call_for(const CallableArmPlan& plan, Raised& raised, const nb::object& callable,
    const ExternalBatch& batch, std::size_t rows, Table second, Take&& take, std::unique_ptr<Table> more = nullptr) {
    Table wo =
        per_run("wo", batch, rows, {3}, [&](std::size_t r, std::size_t j) { return component(batch.runs[r].wo, j); });
    std::vector<Table> tables = context_of(batch, rows, plan.uses);
    const Locked held;
    try {
        nb::dict context;
        for (Table& table : tables) context[table.name().c_str()] = table.take();
        if (more) context[more->name().c_str()] = more->take();
        if (plan.uses.contains("lights")) put_lights(batch.lights, context);
        take(call_python(callable, wo.take(), second.take(), context));
        if (plan.serial && PyErr_CheckSignals() != 0) throw nb::python_error();
    } catch (...) {
        raised.keep();
        throw Interrupted{};
    }
}

Table directions_of(std::span<const Vec3d> wi) {
    Table out("wi", wi.size(), {3});
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < wi.size(); ++i) out.column(j)[i] = component(wi[i], j);
    return out;
}

}  // namespace

void CallableArm::draw(const ExternalBatch& batch, const ExternalDraws& out) const {
    raised_->check();
    const std::size_t rows = out.pdf.size();
    Table u = numbers_of(batch, rows, static_cast<std::size_t>(plan_.numbers));
    call_for(plan_, *raised_, plan_.draw, batch, rows, std::move(u), [&](const nb::object& given) {
        const nb::tuple answer = nb::cast<nb::tuple>(given);
        const Rows wi = nb::cast<Rows>(answer[0]);
        const Column pdf = nb::cast<Column>(answer[1]);
        if (wi.shape(0) != rows || wi.shape(1) != 3 || pdf.shape(0) != rows) throw nb::value_error(another_shape);
        const Unlocked free;
        for (std::size_t i = 0; i < rows; ++i) {
            out.wi[i] = {wi(i, 0), wi(i, 1), wi(i, 2)};
            out.pdf[i] = pdf(i);
        }
    });
}

void CallableArm::density(const ExternalBatch& batch, std::span<const Vec3d> wi, std::span<double> out) const {
    raised_->check();
    const std::size_t rows = out.size();
    call_for(plan_, *raised_, plan_.pdf, batch, rows, directions_of(wi), [&](const nb::object& answer) {
        const Column pdf = nb::cast<Column>(answer);
        if (pdf.shape(0) != rows) throw nb::value_error(another_shape);
        for (std::size_t i = 0; i < rows; ++i) out[i] = pdf(i);
    });
}

void CallableArm::weigh(
    const ExternalBatch& batch, std::span<const Vec3d> wi, std::span<const double> p, std::span<double> out) const {
    raised_->check();
    const std::size_t rows = wi.size(), samplers = p.size() / rows;
    auto densities = std::make_unique<Table>("p", rows, std::vector{samplers});
    for (std::size_t k = 0; k < samplers; ++k)
        for (std::size_t i = 0; i < rows; ++i) densities->column(k)[i] = p[i * samplers + k];
    call_for(
        plan_, *raised_, plan_.weights, batch, rows, directions_of(wi),
        [&](const nb::object& answer) {
            const Rows w = nb::cast<Rows>(answer);
            if (w.shape(0) != rows || w.shape(1) != samplers) throw nb::value_error(another_shape);
            for (std::size_t i = 0; i < rows; ++i)
                for (std::size_t k = 0; k < samplers; ++k) out[i * samplers + k] = w(i, k);
        },
        std::move(densities));
}

}  // namespace crescent::python
