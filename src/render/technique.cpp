// Built-in samplers are constructed once a run of rows; rows of an external sampler are passed on in its own batches.
#include "render/technique.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "render/kernel.h"

#define CRESCENT_ISA scalar
#include "render/kernel_body.h"

namespace crescent {

namespace {

constexpr double not_usable = std::numeric_limits<double>::quiet_NaN();

template <template <class> class A> class BuiltInTechnique : public Technique {
public:
    int numbers() const override { return 2; }
    int built_in() const override { return arm_index(A<float>::name); }

    void draw(const PointRows& rows, std::span<const double> u, std::span<PointDraw> out) const override {
        std::size_t row = 0;
        each_run(rows, [&](const A<float>& arm, const PointRun& run) {
            for (std::size_t i = 0; i < run.rows; ++i, ++row) {
                const auto d = arm.sample(run.wo, {as_float(u[2 * row]), as_float(u[2 * row + 1])});
                out[row] = {d.wi, static_cast<double>(d.pdf.v)};
                if constexpr (requires { d.meets_light; }) {
                    out[row].light = d.disk;
                    out[row].meets_light = d.meets_light;
                }
                if constexpr (requires { d.texel; }) out[row].texel = d.texel;
                if constexpr (requires { d.triangle; }) out[row].triangle = d.triangle;
            }
        });
    }
    void density(const PointRows& rows, std::span<const Vec3<float>> wi, std::span<double> out) const override {
        std::size_t row = 0;
        each_run(rows, [&](const A<float>& arm, const PointRun& run) {
            for (std::size_t i = 0; i < run.rows; ++i, ++row)
                out[row] = static_cast<double>(arm.pdf(run.wo, wi[row]).v);
        });
    }

private:
    template <class Work> static void each_run(const PointRows& rows, Work&& work) {
        const ShadingPoints& p = rows.points;
        std::vector<std::byte> memory(p.kernel_memory());
        scalar::LightRoom<float> room(p, memory.data());
        for (const PointRun& run : rows.runs) {
            const scalar::Lights<float> lights(p, run.point, room);
            ShadingPoint<float> point{.wo = run.wo,
                .s = p.s[run.point],
                .alpha = p.alpha[run.point],
                .diffuse = p.diffuse[run.point],
                .lobe = p.rho_s[run.point]};
            point.lobe_kind = static_cast<LobeKind>(p.lobe);
            lights.show(point);
            work(A<float>(point), run);
        }
    }
};

/// Calls work(scene, first row, rows) for consecutive parts of the rows, none longer than the sampler takes.
template <class Work> void in_batches(const SamplerDeclaration& declaration, const PointRows& point_rows, Work&& work) {
    const ShadingPoints& p = point_rows.points;
    const std::vector<SceneLight> lights = declaration.uses_lights() ? lights_of(p) : std::vector<SceneLight>{};
    std::vector<SurfaceRun> runs;
    std::vector<LightAtPoint> lights_at;
    std::size_t first = 0, rows = 0;
    const auto flush = [&] {
        if (rows > 0) work(SceneRows{.runs = runs, .lights = lights, .lights_at = lights_at}, first, rows);
        first += rows;
        rows = 0;
        runs.clear();
        lights_at.clear();
    };
    for (const PointRun& run : point_rows.runs)
        for (std::size_t start = 0; start < run.rows;) {
            const std::size_t part = std::min(run.rows - start, declaration.batch_rows - rows);
            runs.push_back(run_at(p, run.point, widen(run.wo), part));
            if (!lights.empty()) add_lights_at(p, run.point, lights_at);
            start += part;
            rows += part;
            if (rows == declaration.batch_rows) flush();
        }
    flush();
}

/// Sets `pairs` to w_o and w_i of rows from `first` on.
void set_pairs(const SceneRows& scene, std::span<const Vec3<float>> wi, std::size_t first, std::vector<Pair>& pairs) {
    pairs.clear();
    for (const SurfaceRun& run : scene.runs)
        for (std::size_t i = 0; i < run.rows; ++i) pairs.push_back({run.wo, widen(wi[first + pairs.size()])});
}

class ExternalTechnique : public Technique {
public:
    explicit ExternalTechnique(std::shared_ptr<const SamplerAdapter> sampler)
        : sampler_(std::move(sampler)), declaration_(sampler_->declaration()) {}
    int numbers() const override { return declaration_.traits.own_numbers(); }
    EvaluationDevice device() const override { return declaration_.device; }
    bool has_density() const override { return declaration_.traits.has_pdf; }

    void draw(const PointRows& point_rows, std::span<const double> u, std::span<PointDraw> out) const override {
        const auto count = static_cast<std::size_t>(numbers());
        std::vector<Draw> draws;
        in_batches(declaration_, point_rows, [&](const SceneRows& scene, std::size_t first, std::size_t rows) {
            draws.resize(rows);
            sampler_->evaluate({.kind = SamplerQuery::Kind::sample,
                                   .u = {u.subspan(first * count, rows * count), count},
                                   .scene = &scene},
                {.draws = draws});
            for (std::size_t i = 0; i < rows; ++i) out[first + i] = usable(draws[i]);
        });
    }
    void density(const PointRows& point_rows, std::span<const Vec3<float>> wi, std::span<double> out) const override {
        std::vector<Pair> pairs;
        in_batches(declaration_, point_rows, [&](const SceneRows& scene, std::size_t first, std::size_t rows) {
            set_pairs(scene, wi, first, pairs);
            sampler_->evaluate({.kind = SamplerQuery::Kind::pdf, .pairs = pairs, .scene = &scene},
                {.values = out.subspan(first, rows)});
        });
        for (double& p : out)
            if (!(p >= 0 && p <= std::numeric_limits<float>::max())) p = not_usable;
    }

private:
    static PointDraw usable(const Draw& draw) {
        if (draw.pdf == 0) return {};
        if (!is_usable(draw.wi, draw.pdf)) return {{0, 0, 1}, not_usable};
        return {as<float>(draw.wi), draw.pdf};
    }

    std::shared_ptr<const SamplerAdapter> sampler_;
    SamplerDeclaration declaration_;
};

class MixtureTechnique : public Technique {
public:
    MixtureTechnique(Techniques parts, WeightList weights) : parts_(std::move(parts)), weights_(std::move(weights)) {}
    int numbers() const override { return most_numbers(parts_); }
    EvaluationDevice device() const override { return device_of(parts_); }
    void draw(const PointRows& rows, std::span<const double> u, std::span<PointDraw> out) const override {
        const auto count = static_cast<std::size_t>(numbers());
        const std::vector<double> weights = weights_at(rows, weights_);
        const Choices choices = choose(rows, u, count, weights, parts_.size());
        std::vector<std::vector<double>> p;
        draw_chosen(parts_, rows, u, count, choices, out, p);
        std::size_t row = 0;
        for (std::size_t r = 0; r < rows.runs.size(); ++r)
            for (std::size_t i = 0; i < rows.runs[r].rows; ++i, ++row)
                if (out[row].pdf != 0) out[row].pdf = sum(weights, p, r, row);
    }
    void density(const PointRows& rows, std::span<const Vec3<float>> wi, std::span<double> out) const override {
        const std::vector<double> weights = weights_at(rows, weights_);
        std::vector<std::vector<double>> p(parts_.size(), std::vector<double>(wi.size()));
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            const auto first = static_cast<std::size_t>(std::ranges::find(parts_, parts_[k]) - parts_.begin());
            if (first < k) p[k] = p[first];  // a part that occurs several times is evaluated once
            else parts_[k]->density(rows, wi, p[k]);
        }
        std::size_t row = 0;
        for (std::size_t r = 0; r < rows.runs.size(); ++r)
            for (std::size_t i = 0; i < rows.runs[r].rows; ++i, ++row) out[row] = sum(weights, p, r, row);
    }

private:
    double sum(const std::vector<double>& weights, const std::vector<std::vector<double>>& p, std::size_t run,
        std::size_t row) const {
        double out = 0;
        for (std::size_t k = 0; k < parts_.size(); ++k) out += weights[run * parts_.size() + k] * p[k][row];
        return out;
    }
    Techniques parts_;
    WeightList weights_;
};

}  // namespace

std::size_t PointRows::count() const {
    std::size_t rows = 0;
    for (const PointRun& run : runs) rows += run.rows;
    return rows;
}

std::shared_ptr<const Technique> built_in_technique(std::string_view sampler) {
    std::shared_ptr<const Technique> out;
    for_each_sampler(Samplers{}, [&]<template <class> class A>() {
        if constexpr (!requires { A<float>::techniques; }) {
            if (A<float>::name == sampler) out = std::make_shared<BuiltInTechnique<A>>();
        }
    });
    ensure(out != nullptr, "the parser lets only samplers with one direction through");
    return out;
}

EvaluationDevice device_of(const Techniques& parts) {
    for (const std::shared_ptr<const Technique>& part : parts)
        if (const EvaluationDevice device = part->device(); device.declared()) return device;
    return {};
}

int most_numbers(const Techniques& parts) {
    int largest = 2;
    for (const auto& part : parts) largest = std::max(largest, part->numbers());
    return largest;
}

std::shared_ptr<const Technique> external_technique(std::shared_ptr<const SamplerAdapter> sampler) {
    return std::make_shared<ExternalTechnique>(std::move(sampler));
}

void external_weights(const SamplerAdapter& sampler, const PointRows& point_rows, std::span<const Vec3<float>> wi,
    std::span<const double> p, std::span<double> out) {
    const std::size_t of_row = wi.empty() ? 0 : p.size() / wi.size();
    std::vector<Pair> pairs;
    in_batches(sampler.declaration(), point_rows, [&](const SceneRows& scene, std::size_t first, std::size_t rows) {
        set_pairs(scene, wi, first, pairs);
        sampler.evaluate({.kind = SamplerQuery::Kind::weigh,
                             .pairs = pairs,
                             .scene = &scene,
                             .densities = p.subspan(first * of_row, rows * of_row)},
            {.values = out.subspan(first * of_row, rows * of_row)});
    });
}

std::shared_ptr<const Technique> mixture_technique(Techniques parts, WeightList weights) {
    return std::make_shared<MixtureTechnique>(std::move(parts), std::move(weights));
}

FormulaInputs formula_inputs(const ShadingPoints& points, const PointRun& run) {
    FormulaInputs in;
    in.s = double(points.s[run.point]);
    in.alpha = double(points.alpha[run.point]);
    in.rho_d = double(points.diffuse[run.point]);
    in.rho_s = points.rho_s_exact[run.point];
    in.cos_o = double(run.wo.z);
    return in;
}

std::vector<double> weights_at(const PointRows& rows, const WeightList& weights) {
    std::vector<double> out(rows.runs.size() * weights.size());
    for (std::size_t r = 0; r < rows.runs.size(); ++r)
        weights.evaluate(
            formula_inputs(rows.points, rows.runs[r]), std::span(out).subspan(r * weights.size(), weights.size()));
    return out;
}

Choices choose(const PointRows& rows, std::span<const double> u, std::size_t numbers, std::span<const double> weights,
    std::size_t parts) {
    Choices out;
    std::size_t row = 0;
    for (std::size_t r = 0; r < rows.runs.size(); ++r) {
        const std::span<const double> w = weights.subspan(r * parts, parts);
        for (std::size_t i = 0; i < rows.runs[r].rows; ++i, ++row) {
            out.part.emplace_back();
            out.stretched.push_back(
                choose_part([&](std::size_t k) { return w[k]; }, parts, u[row * numbers], out.part.back()));
        }
    }
    return out;
}

void draw_chosen(const Techniques& parts, const PointRows& point_rows, std::span<const double> u, std::size_t numbers,
    const Choices& choices, std::span<PointDraw> out, std::vector<std::vector<double>>& p) {
    const std::size_t rows = choices.part.size();
    p.assign(parts.size(), std::vector<double>(rows));
    std::vector<std::size_t> row_indices;
    std::vector<PointRun> runs;
    std::vector<double> numbers_of_part, densities;
    std::vector<PointDraw> draws;
    std::vector<Vec3<float>> wi;
    /// Collects the rows that have the part, or have not.
    const auto select_rows = [&](std::size_t k, bool has_part) {
        row_indices.clear();
        runs.clear();
        std::size_t row = 0;
        for (const PointRun& run : point_rows.runs) {
            runs.push_back({run.point, run.wo, 0});
            for (std::size_t i = 0; i < run.rows; ++i, ++row)
                if ((choices.part[row] == k) == has_part && (has_part || out[row].pdf != 0)) {
                    row_indices.push_back(row);
                    ++runs.back().rows;
                }
            if (runs.back().rows == 0) runs.pop_back();
        }
        return !row_indices.empty();
    };
    for (std::size_t k = 0; k < parts.size(); ++k) {
        if (!select_rows(k, true)) continue;
        const auto count = static_cast<std::size_t>(parts[k]->numbers());
        numbers_of_part.clear();
        for (const std::size_t row : row_indices) {
            numbers_of_part.push_back(choices.stretched[row]);
            for (std::size_t j = 1; j < count; ++j) numbers_of_part.push_back(u[row * numbers + j]);
        }
        draws.resize(row_indices.size());
        parts[k]->draw({point_rows.points, runs}, numbers_of_part, draws);
        for (std::size_t i = 0; i < row_indices.size(); ++i) {
            out[row_indices[i]] = draws[i];
            p[k][row_indices[i]] = draws[i].pdf;
        }
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
        if (!select_rows(k, false)) continue;
        wi.clear();
        for (const std::size_t row : row_indices) wi.push_back(out[row].wi);
        densities.resize(row_indices.size());
        parts[k]->density({point_rows.points, runs}, wi, densities);
        for (std::size_t i = 0; i < row_indices.size(); ++i) p[k][row_indices[i]] = densities[i];
    }
}

// ---- Positions are those that the kernels use: float, in the local frame of each point. Disks come first, as in the
// scene.

namespace {

LocalLight<double> local_light(const LightArrays& arrays, std::size_t index) {
    const auto number = [&](std::size_t k) { return static_cast<double>(arrays.numbers[k][index]); };
    const auto vector = [&](std::size_t k) { return Vec3d{number(k), number(k + 1), number(k + 2)}; };
    LocalLight<double> out{.kind = arrays.kind,
        .power = static_cast<double>(arrays.power),
        .a = vector(0),
        .b = vector(3),
        .c = vector(6),
        .number = {}};
    for (std::size_t k = 0; k < out.number.size(); ++k) out.number[k] = number(9 + k);
    return out;
}

LightAtPoint disk_at(const DiskArrays& disk, std::size_t index) {
    const Vec3d center{double(disk.cx[index]), double(disk.cy[index]), double(disk.cz[index])};
    const Vec3d normal{double(disk.nx[index]), double(disk.ny[index]), double(disk.nz[index])};
    return {.center = center,
        .normal = normal,
        .edge_u = {},
        .edge_v = {},
        .shines = shines_flat(center, normal, static_cast<double>(disk.radius), disk.two_sided)};
}

template <class Kind> LightAtPoint light_at(const LocalLight<double>& light) {
    LightAtPoint out{light.a, {}, {}, {}, Kind::shines(light)};
    if constexpr (requires { Kind::half_edges(light); }) {
        const auto [u, v] = Kind::half_edges(light);
        out.edge_u = u;
        out.edge_v = v;
        out.normal = normalize(cross(u, v));
    }
    return out;
}

}  // namespace

std::vector<SceneLight> lights_of(const ShadingPoints& shading_points) {
    std::vector<SceneLight> out;
    if (shading_points.count == 0) return out;
    for (const DiskArrays& disk : shading_points.disks)
        out.push_back({lights::Disk::name, disk.radiance, static_cast<double>(disk.radius)});
    for (const LightArrays& arrays : shading_points.others)
        with_light_kind(arrays.kind, [&]<class Kind>() {
            out.push_back({Kind::name, arrays.radiance, std::sqrt(Kind::radius2(local_light(arrays, 0)))});
        });
    return out;
}

void add_lights_at(const ShadingPoints& shading_points, std::size_t index, std::vector<LightAtPoint>& to) {
    for (const DiskArrays& disk : shading_points.disks) to.push_back(disk_at(disk, index));
    for (const LightArrays& arrays : shading_points.others)
        with_light_kind(arrays.kind, [&]<class Kind>() { to.push_back(light_at<Kind>(local_light(arrays, index))); });
}

SurfaceRun run_at(const ShadingPoints& points, std::size_t index, Vec3<double> wo, std::size_t rows) {
    const Rgb& lambert = points.lambert[index];
    return {.wo = wo,
        .surface = {.s = double(points.s[index]),
            .alpha = double(points.alpha[index]),
            .diffuse = double(points.diffuse[index]),
            .lobe = points.rho_s_exact[index]},
        .rows = rows,
        .rho_d = {lambert[0] * pi, lambert[1] * pi, lambert[2] * pi}};
}

bool is_usable(const Vec3<double>& wi, double p) {
    const auto pdf = static_cast<float>(p);
    return std::fabs(dot(wi, wi) - 1) <= 2e-4 && pdf > 0 && pdf <= std::numeric_limits<float>::max();
}

}  // namespace crescent
