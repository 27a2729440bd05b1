// A case holds the shading points of one pixel, whose lights and material are those of the films, in single precision.
// Occlusion is left out: a shadow is no property of a sampler.
#include "run/arm_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/errors.h"
#include "base/text.h"
#include "check/sources/cases.h"
#include "check/sources/decorators.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "render/combination.h"
#include "render/estimator.h"
#include "render/shading_points.h"
#include "render/technique.h"
#include "run/execute.h"
#include "samplers/info.h"

namespace crescent {

namespace {

/// The shading points of one pixel.
using Point = std::shared_ptr<const ShadingPoints>;

SurfaceSetup surface_at(const ShadingPoints& point) {
    const bool has_lobe = point.lobe >= 0;
    return {.lobe = has_lobe ? static_cast<LobeKind>(point.lobe) : LobeKind::none,
        .rho_d = double(point.diffuse[0]),
        .rho_s = has_lobe ? point.rho_s_exact[0] : 0,
        .s = double(point.s[0]),
        .alpha = double(point.alpha[0])};
}

/// What all samplers at one point share: f of its surface.
class AtPoint : public InProcessAdapter {
public:
    AtPoint(std::string name, Point point, bool limited)
        : name_(std::move(name)), point_(std::move(point)), surface_(surface_at(*point_)), is_limited_(limited) {}
    std::string name() const override { return name_; }
    bool limited() const override { return is_limited_; }
    bool has_f() const override { return true; }
    void f(std::span<const Pair> pairs, std::span<double> out) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) out[i] = brdf_value(surface_, pairs[i].wo, pairs[i].wi);
    }

protected:
    static constexpr std::size_t most_rows = 8192;

    /// Gives each of these draws the weight f cos times factor(i) over its pdf, which becomes 1.
    template <class Factor> void set_weights(Vec3d wo, std::span<Draw> draws, Factor&& factor) const {
        std::vector<Pair> pairs;
        for (const Draw& draw : draws) pairs.push_back({wo, draw.wi});
        std::vector<double> value(pairs.size());
        f(pairs, value);
        for (std::size_t i = 0; i < draws.size(); ++i)
            if (const double p = draws[i].pdf; p != 0) {
                draws[i].weight = value[i] * std::max(draws[i].wi.z, 0.0) * factor(i) / p;
                draws[i].pdf = 1;
            }
    }

    const ShadingPoints& points() const { return *point_; }

    /// Calls work(rows, first, count) for consecutive parts of pairs, a run for each w_o.
    template <class Work> void in_batches(std::span<const Pair> pairs, Work&& work) const {
        std::vector<PointRun> runs;
        std::vector<Vec3<float>> wi;
        for (std::size_t first = 0; first < pairs.size(); first += most_rows) {
            const std::size_t rows = std::min(most_rows, pairs.size() - first);
            runs.clear();
            wi.clear();
            for (const Pair& pair : pairs.subspan(first, rows)) {
                const Vec3<float> wo = as<float>(pair.wo);
                const bool is_same =
                    !runs.empty() && runs.back().wo.x == wo.x && runs.back().wo.y == wo.y && runs.back().wo.z == wo.z;
                if (!is_same) runs.push_back({0, wo, 0});
                ++runs.back().rows;
                wi.push_back(as<float>(pair.wi));
            }
            work(PointRows{points(), runs}, std::span<const Vec3<float>>(wi), first);
        }
        if (is_limited_) count(pairs.size());
    }
    void density_of(const Technique& technique, std::span<const Pair> pairs, std::span<double> out) const {
        in_batches(pairs, [&](const PointRows& rows, std::span<const Vec3<float>> wi, std::size_t first) {
            technique.density(rows, wi, out.subspan(first, wi.size()));
        });
    }
    void draw_with(const Technique& technique, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const {
        const auto count_of = static_cast<std::size_t>(technique.numbers());
        std::vector<double> numbers;
        std::vector<PointDraw> draws;
        for (std::size_t first = 0; first < u.size(); first += most_rows) {
            const std::size_t rows = std::min(most_rows, u.size() - first);
            numbers.clear();
            draws.assign(rows, {});
            for (const PrimarySample& row : u.subspan(first, rows))
                for (std::size_t k = 0; k < count_of; ++k) numbers.push_back(row[static_cast<int>(k)]);
            const PointRun run{0, as<float>(wo), rows};
            technique.draw({points(), {&run, 1}}, numbers, draws);
            for (std::size_t i = 0; i < rows; ++i) out[first + i] = {widen(draws[i].wi), draws[i].pdf};
        }
        if (is_limited_) count(u.size());
    }

private:
    std::string name_;
    Point point_;
    SurfaceSetup surface_;
    bool is_limited_;
};

/// A sampler with one density; one that cannot evaluate it has the weight f cos / p of its draws.
class OneTechnique : public AtPoint {
public:
    OneTechnique(std::string name, Point point, bool limited, std::shared_ptr<const Technique> technique)
        : AtPoint(std::move(name), std::move(point), limited), technique_(std::move(technique)) {}
    Traits traits() const override { return {.numbers = technique_->numbers(), .has_pdf = technique_->has_density()}; }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        draw_with(*technique_, wo, u, out);
        if (!technique_->has_density()) set_weights(wo, out, [](std::size_t) { return 1.0; });
    }
    void pdf(int, std::span<const Pair> pairs, std::span<double> out) const override {
        if (technique_->has_density()) density_of(*technique_, pairs, out);
        else std::ranges::fill(out, 0);
    }

private:
    std::shared_ptr<const Technique> technique_;
};

/// Multiple importance sampling: the densities of its samplers, each with its weights.
class WeightedTechniques : public AtPoint {
public:
    WeightedTechniques(std::string name, Point point, bool limited, std::shared_ptr<const Combination> combination)
        : AtPoint(std::move(name), std::move(point), limited), combination_(std::move(combination)) {}
    Traits traits() const override { return {.numbers = most_numbers(combination_->parts())}; }
    int techniques() const override { return static_cast<int>(combination_->parts().size()); }
    std::string technique_name(int t) const override { return combination_->plan().of[static_cast<std::size_t>(t)]; }
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        draw_with(part(t), wo, u, out);
    }
    void pdf(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        density_of(part(t), pairs, out);
    }
    void mis_weight(int t, std::span<const Pair> pairs, std::span<double> out) const override {
        const std::size_t parts = combination_->parts().size();
        std::vector<std::vector<double>> p(parts, std::vector<double>(pairs.size()));
        for (std::size_t k = 0; k < parts; ++k) density_of(*combination_->parts()[k], pairs, p[k]);
        if (combination_->has_weight_function()) return weights_of_function(t, pairs, p, out);
        std::vector<double> densities(parts);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            for (std::size_t k = 0; k < parts; ++k) densities[k] = p[k][i];
            FormulaInputs in = formula_inputs(points(), {0, as<float>(pairs[i].wo), 1});
            in.cos_i = pairs[i].wi.z;
            out[i] = combination_->mis_weight(static_cast<std::size_t>(t), in, densities);
        }
    }

private:
    void weights_of_function(
        int t, std::span<const Pair> pairs, const std::vector<std::vector<double>>& p, std::span<double> out) const {
        in_batches(pairs, [&](const PointRows& rows, std::span<const Vec3<float>> wi, std::size_t first) {
            std::vector<std::vector<double>> batch_densities;
            for (const std::vector<double>& densities : p)
                batch_densities.emplace_back(densities.begin() + static_cast<std::ptrdiff_t>(first),
                    densities.begin() + static_cast<std::ptrdiff_t>(first + wi.size()));
            const std::vector<std::size_t> techniques(wi.size(), static_cast<std::size_t>(t));
            std::ranges::copy(
                combination_->mis_weights(rows, techniques, wi, batch_densities), out.begin() + std::ptrdiff_t(first));
        });
    }

    const Technique& part(int t) const { return *combination_->parts()[static_cast<std::size_t>(t)]; }
    std::shared_ptr<const Combination> combination_;
};

/// Resampled importance sampling: no density of a direction, but its weight f cos W. Its candidates use random numbers
/// that are hashed from the two of a sample.
class Resampled : public AtPoint {
public:
    Resampled(std::string name, Point point, bool limited, std::shared_ptr<const Combination> combination)
        : AtPoint(std::move(name), std::move(point), limited), combination_(std::move(combination)) {}
    Traits traits() const override { return {.has_pdf = false}; }
    void pdf(int, std::span<const Pair>, std::span<double> out) const override { std::ranges::fill(out, 0); }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        std::vector<WeightedDirection> weighted_draws;
        const std::size_t rows_a_batch = 512;
        for (std::size_t first = 0; first < u.size(); first += rows_a_batch) {
            const std::size_t rows = std::min(rows_a_batch, u.size() - first);
            weighted_draws.assign(rows, {});
            const PointRun run{0, as<float>(wo), rows};
            combination_->sample(
                {points(), {&run, 1}},
                [&](std::size_t, std::size_t row, std::uint32_t block) { return hashed(u[first + row], block); },
                weighted_draws);
            const std::span<Draw> draws = out.subspan(first, rows);
            for (std::size_t i = 0; i < rows; ++i)
                draws[i] = {widen(weighted_draws[i].draw.wi), double(weighted_draws[i].draw.pdf.v)};
            set_weights(wo, draws, [&](std::size_t i) { return double(weighted_draws[i].weight); });
        }
        if (limited()) count(u.size() * static_cast<std::size_t>(*combination_->plan().candidates));
    }

private:
    static Vec2<float> hashed(const PrimarySample& u, std::uint32_t block) {
        const auto x = std::bit_cast<std::uint64_t>(u.x), y = std::bit_cast<std::uint64_t>(u.y);
        const auto low = [](std::uint64_t v) { return static_cast<std::uint32_t>(v ^ (v >> 32)); };
        const auto h = pcg4d(Vec4u<std::uint32_t>{
            low(x), low(y), block, static_cast<std::uint32_t>(x >> 32) ^ static_cast<std::uint32_t>(y >> 29)});
        return {unit_float<float>(h.x), unit_float<float>(h.y)};
    }
    std::shared_ptr<const Combination> combination_;
};

/// The lights that shine on a point, for the integrals of a check; their radiance is its luminance.
CaseLighting lighting_at(const Scene& scene, const ShadingPoints& points) {
    CaseLighting out;
    out.fill = luminance(scene.fill());
    const std::vector<SceneLight> lights = lights_of(points);
    std::vector<LightAtPoint> local_lights;
    add_lights_at(points, 0, local_lights);
    for (std::size_t k = 0; k < lights.size(); ++k) {
        if (!local_lights[k].shines) continue;
        const double radiance = luminance(lights[k].radiance);
        const Vec3d c = local_lights[k].center, n = local_lights[k].normal, u = local_lights[k].edge_u,
                    v = local_lights[k].edge_v;
        if (dot(u, u) > 0) {
            out.area_lights.push_back({radiance, lights::Rectangle{c - u - v, 2.0 * u, 2.0 * v, true}});
        } else if (dot(n, n) > 0) {  // a disk; a side that shines faces the point
            out.disks.push_back({radiance, c, dot(c, n) < 0 ? n : n * -1.0, lights[k].radius});
        } else {
            out.area_lights.push_back({radiance, lights::Sphere{c, lights[k].radius}});
        }
    }
    if (points.around) {
        const auto first = [](const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z) {
            return Vec3d{double(x[0]), double(y[0]), double(z[0])};
        };
        out.around = points.around;
        out.position = first(points.px, points.py, points.pz);
        out.frame = {first(points.tx, points.ty, points.tz), first(points.bx, points.by, points.bz),
            first(points.nx, points.ny, points.nz)};
    }
    return out;
}

class Cases {
public:
    Cases(const Experiment& experiment, std::string sampler, const ExternalSamplers& external_samplers, Grid wo,
        double seconds)
        : scene_(experiment),
          experiment_(experiment),
          sampler_(std::move(sampler)),
          external_samplers_(external_samplers),
          wo_(std::move(wo)),
          seconds_(seconds),
          shapes_(shape_map(scene_)),
          is_limited_(std::ranges::any_of(with_arms_of(experiment, {sampler_}).arms,
              [](const ArmPlan& arm) { return arm.is_external() || arm.combination.weights_python; })) {
        count_in_view(experiment, shapes_);
    }

    std::vector<CheckCase> at_pixels(int count) {
        const std::vector<std::uint32_t> pixels = geometry_pixels();
        for (int k = 0; k < count && static_cast<std::size_t>(k) < pixels.size(); ++k) {
            const std::uint64_t pixel_count = pixels.size(),
                                case_count = std::min<std::uint64_t>(pixel_count, std::uint64_t(count));
            const Point point = point_of(pixels[(2 * std::uint64_t(k) + 1) * pixel_count / (2 * case_count)]);
            for (const auto& [theta, azimuth] : wo_) add(point, tilt(theta, azimuth), theta, azimuth);
            if (!wo_.empty()) continue;
            const Vec3d wo{double(point->wox[0]), double(point->woy[0]), double(point->woz[0])};
            if (!(wo.z > 0)) continue;
            add(point, wo, math::acos(std::min(wo.z, 1.0)) * 180 / pi, turn_of(wo));
        }
        return std::move(cases_);
    }

    std::vector<CheckCase> on_grid(bool full) {
        for (const std::uint32_t pixel : middle_of_each_shape()) {
            const Point point = point_of(pixel);
            for (const auto& [theta, azimuth] : wo_.empty() ? wo_grid(full) : wo_)
                add(point, tilt(theta, azimuth), theta, azimuth);
        }
        return std::move(cases_);
    }

private:
    static double turn_of(Vec3d w) {
        const double turn = math::atan2(w.y, w.x) * 180 / pi;
        return turn < 0 ? turn + 360 : turn;
    }

    std::vector<std::uint32_t> geometry_pixels() const {
        std::vector<std::uint32_t> out;
        for (std::size_t i = 0; i < shapes_.shape.size(); ++i)
            if (shapes_.shape[i] >= 0) out.push_back(static_cast<std::uint32_t>(i));
        return out;
    }

    /// The middle one of the pixels of each shape in view, in the order of the scene's shapes.
    std::vector<std::uint32_t> middle_of_each_shape() const {
        std::map<int, std::vector<std::uint32_t>> pixels_by_shape;
        for (const std::uint32_t pixel : geometry_pixels()) pixels_by_shape[shapes_.shape[pixel]].push_back(pixel);
        std::vector<std::uint32_t> out;
        for (const auto& [shape, pixels] : pixels_by_shape) out.push_back(pixels[pixels.size() / 2]);
        return out;
    }

    Point point_of(std::uint32_t pixel) const {
        const Image& image = scene_.image();
        const int i = static_cast<int>(pixel) % image.width, j = static_cast<int>(pixel) / image.width;
        for (ShadingPoints& group : shading_points_of(scene_, {i, j, i + 1, j + 1}, nullptr))
            if (group.count == 1) return std::make_shared<const ShadingPoints>(std::move(group));
        throw Bug(std::source_location::current(), "a geometry pixel has a shading point");
    }

    void add(const Point& point, Vec3d wo, double theta, double azimuth) {
        const Image& image = scene_.image();
        const std::uint32_t pixel = point->pixel[0], width = static_cast<std::uint32_t>(image.width);
        const LobeInfo* lobe = point->lobe < 0 ? nullptr : &lobe_info(static_cast<LobeKind>(point->lobe));
        CheckCase t;
        t.brdf = experiment_.surface_name(point->shape[0]);
        t.lighting = fmt::format("pixel {} {}", pixel % width, pixel / width);
        t.wo = wo;
        const auto round_angle = [](double v) { return std::round(v * 1e4) / 1e4; };
        t.theta_deg = round_angle(theta);
        t.azimuth_deg = theta > 0 ? round_angle(azimuth) : 0;
        if (lobe && lobe->parameter == LobeParameter::s) t.parameters.emplace_back("s", double(point->s[0]));
        if (lobe && lobe->parameter == LobeParameter::alpha)
            t.parameters.emplace_back("alpha", double(point->alpha[0]));
        t.surface = surface_at(*point);
        t.light = lighting_at(scene_, *point);
        for (const char* peer : {"uniform", "cosine"}) {
            if (sampler_ == peer) continue;
            t.arm = peer;
            t.baseline = true;
            t.adapter = std::make_shared<OneTechnique>(peer, point, false, built_in_technique(peer));
            peers_.push_back(t);
        }
        t.arm = sampler_;
        t.baseline = false;
        t.adapter = adapter_at(point);
        cases_.push_back(std::move(t));
        std::ranges::move(peers_, std::back_inserter(cases_));
        peers_.clear();
    }

    /// A sample of many candidates costs as much as a sample of a slow program.
    std::shared_ptr<const SamplerAdapter> combined_at(
        const Point& point, const std::shared_ptr<const Combination>& combination) const {
        if (combination->plan().kind == CombinationKind::ris)
            return std::make_shared<Resampled>(sampler_, point, is_limited_, combination);
        if (const auto technique = combination->technique())
            return std::make_shared<OneTechnique>(sampler_, point, is_limited_, technique);
        return std::make_shared<WeightedTechniques>(sampler_, point, is_limited_, combination);
    }

    std::shared_ptr<const SamplerAdapter> adapter_at(const Point& point) const {
        const ArmPlan* arm = experiment_.find_arm(sampler_);
        if (const auto entry = external_samplers_.find(sampler_); entry != external_samplers_.end()) {
            if (const auto combination = std::dynamic_pointer_cast<const Combination>(entry->second))
                return limited_in_time(combined_at(point, combination), seconds_);
            return std::make_shared<OneTechnique>(sampler_, point, is_limited_, external_technique(entry->second));
        }
        const std::string name = arm ? arm->sampler : sampler_;
        if (name == "mis-balance" || name == "mis-power") {
            CombinationPlan plan;
            plan.kind = CombinationKind::mis;
            plan.of = {"mixture", "light-area"};
            plan.heuristic = name == "mis-power" ? MisHeuristic::power : MisHeuristic::balance;
            if (!built_in_) {
                Techniques parts = {built_in_technique("mixture"), built_in_technique("light-area")};
                built_in_ = std::make_shared<Combination>(
                    name, plan, std::move(parts), nullptr, SourceLocation{}, SourceLocation{});
            }
            return std::make_shared<WeightedTechniques>(sampler_, point, false, built_in_);
        }
        return std::make_shared<OneTechnique>(sampler_, point, false, built_in_technique(name));
    }

    Scene scene_;
    const Experiment& experiment_;
    std::string sampler_;
    const ExternalSamplers& external_samplers_;
    Grid wo_;  // empty: that of the pixel, or the grid
    double seconds_;
    ShapeMap shapes_;
    bool is_limited_;  // a part of the sampler is a program, a library or Python
    std::vector<CheckCase> cases_, peers_;
    mutable std::shared_ptr<const Combination> built_in_;
};

}  // namespace

Experiment with_arms_of(Experiment experiment, std::vector<std::string> names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        const ArmPlan* arm = experiment.find_arm(names[i]);
        if (!arm) continue;
        std::vector<std::string> parts = arm->combination.of;
        if (arm->combination.target) parts.push_back(*arm->combination.target);
        for (std::string& part : parts)
            if (std::ranges::find(names, part) == names.end()) names.push_back(std::move(part));
    }
    std::erase_if(
        experiment.arms, [&](const ArmPlan& arm) { return std::ranges::find(names, arm.name) == names.end(); });
    return experiment;
}

std::vector<CheckCase> arm_cases(const Experiment& experiment, const std::string& sampler,
    const ExternalSamplers& external_samplers, const ArmCasesPlan& plan) {
    const std::vector<std::string> built_in = sampler_names();
    if (!experiment.find_arm(sampler) && std::ranges::find(built_in, sampler) == built_in.end()) {
        std::vector<std::string> valid;
        for (const ArmPlan& arm : experiment.arms) valid.push_back(arm.name);
        for (const std::string& name : built_in)
            if (std::ranges::find(valid, name) == valid.end()) valid.push_back(name);
        throw InputError({plan.flag + " " + sampler, 0, 0},
            fmt::format("no arm or sampler '{}' in {}: expected one of {}{}", printable(sampler, 64), experiment.file,
                fmt::join(valid, ", "), did_you_mean(sampler, valid)));
    }
    Cases cases(experiment, sampler, external_samplers, plan.wo, plan.seconds);
    return plan.pixels > 0 ? cases.at_pixels(plan.pixels) : cases.on_grid(plan.full);
}

}  // namespace crescent
