// The arrays of a batch are filled with the lock free.
#include "scene_context.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

namespace crescent::python {

namespace {

double component(const Vec3d& v, std::size_t j) { return j == 0 ? v.x : j == 1 ? v.y : v.z; }

/// One value a run, value_at(run, column), repeated over its rows.
template <class At> Table per_run(
    const char* name, const SceneRows& scene, std::size_t rows, std::vector<std::size_t> of_row, At&& value_at) {
    Table out(name, rows, std::move(of_row));
    for (std::size_t j = 0; j < out.columns(); ++j) {
        double* to = out.column(j);
        for (std::size_t r = 0; r < scene.runs.size(); ++r) to = std::fill_n(to, scene.runs[r].rows, value_at(r, j));
    }
    return out;
}

Table directions_of(const char* name, std::span<const Pair> pairs, Vec3d Pair::* which) {
    Table out(name, pairs.size(), {3});
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < pairs.size(); ++i) out.column(j)[i] = component(pairs[i].*which, j);
    return out;
}

/// What the lights are to each row.
void add_lights(const SceneRows& scene, std::size_t rows, std::vector<Table>& to) {
    const std::size_t count = scene.lights.size();
    const auto vectors = [&](const char* name, Vec3d LightAtPoint::* which) {
        to.push_back(per_run(name, scene, rows, {count, 3},
            [&](std::size_t r, std::size_t j) { return component(scene.lights_at[r * count + j / 3].*which, j % 3); }));
    };
    vectors("position", &LightAtPoint::center);
    vectors("normal", &LightAtPoint::normal);
    vectors("edge_u", &LightAtPoint::edge_u);
    vectors("edge_v", &LightAtPoint::edge_v);
    to.push_back(per_run("shines", scene, rows, {count},
        [&](std::size_t r, std::size_t j) { return scene.lights_at[r * count + j].shines ? 1.0 : 0.0; }));
}

}  // namespace

Table::Table(std::string name, std::size_t rows, std::vector<std::size_t> of_row)
    : name_(std::move(name)), rows_(rows), of_row_(std::move(of_row)) {
    for (const std::size_t k : of_row_) columns_ *= k;
    data_.reset(new double[std::max<std::size_t>(1, rows_ * columns_)]);
}

nb::object Table::take() {
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
    return nb::cast(nb::ndarray<nb::numpy, double>(data, shape.size(), shape.data(), owner, strides.data()));
}

Table numbers_of(const NumberRows& u, std::size_t count) {
    Table out("u", u.size(), {count});
    for (std::size_t k = 0; k < count; ++k) {
        double* to = out.column(k);
        for (std::size_t i = 0; i < u.size(); ++i) to[i] = u(i, k);
    }
    return out;
}

Table outgoing_of(const SamplerQuery& query) {
    if (query.kind != SamplerQuery::Kind::sample) return directions_of("wo", query.pairs, &Pair::wo);
    if (query.scene)
        return per_run("wo", *query.scene, query.rows(), {3},
            [&](std::size_t r, std::size_t j) { return component(query.scene->runs[r].wo, j); });
    Table out("wo", query.rows(), {3});
    for (std::size_t j = 0; j < 3; ++j) std::fill_n(out.column(j), query.rows(), component(query.wo, j));
    return out;
}

Table incident_of(std::span<const Pair> pairs) { return directions_of("wi", pairs, &Pair::wi); }

Table densities_of(const SamplerQuery& query) {
    const std::size_t rows = query.rows(), samplers = query.densities.size() / rows;
    Table out("p", rows, {samplers});
    for (std::size_t k = 0; k < samplers; ++k)
        for (std::size_t i = 0; i < rows; ++i) out.column(k)[i] = query.densities[i * samplers + k];
    return out;
}

std::vector<Table> context_of(const SceneRows& scene, std::size_t rows, const std::set<std::string>& uses) {
    std::vector<Table> tables;
    const auto surface = [&](const char* name, double SurfaceParameters::* which) {
        if (!uses.contains(name)) return;
        tables.push_back(
            per_run(name, scene, rows, {}, [&](std::size_t r, std::size_t) { return scene.runs[r].surface.*which; }));
    };
    surface("s", &SurfaceParameters::s);
    surface("alpha", &SurfaceParameters::alpha);
    surface("rho_s", &SurfaceParameters::lobe);
    for (const char* name : {"side", "eta"})  // scenes are opaque, and seen from the side of the normal
        if (uses.contains(name))
            tables.push_back(per_run(name, scene, rows, {}, [](std::size_t, std::size_t) { return 1.0; }));
    if (uses.contains("rho_d"))
        tables.push_back(
            per_run("rho_d", scene, rows, {3}, [&](std::size_t r, std::size_t c) { return scene.runs[r].rho_d[c]; }));
    if (uses.contains("lights")) add_lights(scene, rows, tables);
    return tables;
}

void put_lights(std::span<const SceneLight> lights, nb::dict& to) {
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

}  // namespace crescent::python
