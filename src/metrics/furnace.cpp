// A sky of radiance 1 over one surface seen from directly above: the mean of X is its albedo. All samples of one pixel
// are kept, for the tail.
#include "metrics/furnace.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/errors.h"
#include "base/vec.h"
#include "experiment/published.h"
#include "math/statistics.h"
#include "render/estimator.h"
#include "render/reference/lobe_albedo.h"

namespace crescent {

namespace {

std::optional<Tail> tail_of(std::vector<float> x) {
    const std::size_t length = tail_length(x.size());
    std::erase_if(x, [](float v) { return std::isnan(v); });
    if (length == 0 || x.size() <= length) return {};
    std::partial_sort(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(length + 1), x.end(), std::greater<>());
    return fit_tail(std::span<const float>(x.data(), length + 1));
}

}  // namespace

FurnaceDraws draw_furnace(const Experiment& experiment, const FurnacePlan& plan, const std::string& isa,
    ProgressMonitor& monitor, const ExternalSamplers& external) {
    const auto arm = std::find_if(
        experiment.arms.begin(), experiment.arms.end(), [&](const ArmPlan& a) { return a.name == plan.arm; });
    ensure(arm != experiment.arms.end(), "a furnace's arm is known");
    const auto surface_index = experiment.find_surface(plan.shape);
    ensure(surface_index.has_value(), "a furnace's shape is known");
    const bool lobe_only = plan.part == FurnacePart::lobe;
    const Surface surface = furnace_surface(experiment, experiment.material(*surface_index), lobe_only);
    const ShadingPoints shading_points = furnace_points(surface, 1);
    FurnaceDraws out;
    out.samples.resize(plan.n);
    const Moments m = estimate_points(shading_points, {arm->sampler, external_of(external, arm->name)}, plan.n,
        experiment.seed, isa, &monitor.stop, out.samples.data());
    const double n = static_cast<double>(plan.n);
    FurnaceResult& metric = out.metric;
    metric.name = plan.name;
    metric.arm = plan.arm;
    metric.part = lobe_only ? "lobe" : "combined";
    metric.n = plan.n;
    const double rho_d = luminance(surface.rho_d);
    const double albedo = surface.rho_s > 0 ? lobe_albedo(surface.brdf, surface.s, surface.alpha, 1.0) : 0;
    metric.measured = (rho_d / pi * m.g[0] + surface.rho_s * m.g_lobe[0]) / n;
    metric.expected = rho_d + surface.rho_s * albedo;
    metric.se = plan.n > 1 ? std::sqrt(m.spread[0] / (n * (n - 1))) : 0;
    metric.bad = m.bad[0];
    return out;
}

FurnaceResult read_furnace(FurnaceDraws draws) {
    draws.metric.tail = tail_of(std::move(draws.samples));
    return draws.metric;
}

std::vector<FurnaceResult> furnaces(const Experiment& experiment, const Published* published, const std::string& isa,
    ProgressMonitor& monitor, const ExternalSamplers& external) {
    std::vector<FurnaceResult> out;
    for (const FurnacePlan& plan : experiment.furnaces) {
        out.push_back(read_furnace(draw_furnace(experiment, plan, isa, monitor, external)));
        if (published) out.back().published = published->furnace(plan.name);
        monitor.check();
    }
    return out;
}

// ---- Shading points at the origin with the world's axes as frame, under a fill of radiance 1 and no other light; each
// has its own pixel index, so its own random numbers.

Surface furnace_surface(const SceneData& scene, const Material& material, bool lobe_only) {
    Surface surface = surface_of(material, scene.s());
    if (lobe_only) surface.rho_d = {};
    return surface;
}

ShadingPoints furnace_points(const Surface& surface, std::size_t count, double cos_o) {
    ShadingPoints shading_points;
    shading_points.lobe = surface.rho_s > 0 ? static_cast<int>(surface.brdf) : -1;
    shading_points.count = count;
    const auto fill = [&](std::vector<float>& array, double value) { array.assign(count, static_cast<float>(value)); };
    for (std::size_t i = 0; i < count; ++i) shading_points.pixel.push_back(static_cast<std::uint32_t>(i));
    shading_points.shape.assign(count, 0);
    fill(shading_points.wox, std::sqrt(1 - cos_o * cos_o));
    fill(shading_points.woy, 0);
    fill(shading_points.woz, cos_o);
    fill(shading_points.s, surface.s);
    fill(shading_points.alpha, surface.alpha);
    fill(shading_points.diffuse, luminance(surface.rho_d));
    fill(shading_points.rho_s, surface.rho_s);
    for (auto* zero : {&shading_points.px, &shading_points.py, &shading_points.pz, &shading_points.ty,
             &shading_points.tz, &shading_points.bx, &shading_points.bz, &shading_points.nx, &shading_points.ny})
        fill(*zero, 0);
    for (auto* one : {&shading_points.tx, &shading_points.by, &shading_points.nz}) fill(*one, 1);
    fill(shading_points.fill_d, luminance(surface.rho_d) / pi + 0.0);  // never -0
    fill(shading_points.fill_s, surface.rho_s);
    shading_points.lambert.assign(count, {surface.rho_d[0] / pi, surface.rho_d[1] / pi, surface.rho_d[2] / pi});
    shading_points.rho_s_exact.assign(count, surface.rho_s);
    shading_points.tint.assign(count, surface.tint);
    shading_points.pad();
    return shading_points;
}

// ---- Draws four million samples over the region's pixels, at most 256 per pixel, and keeps the largest of all.

TailPlan tail_plan(std::uint64_t pixels) {
    if (pixels == 0) return {};
    constexpr std::uint64_t sample_limit = 4'000'000, most_a_pixel = 256;
    const std::uint64_t n = std::min(std::max<std::uint64_t>(sample_limit / pixels, 1), most_a_pixel);
    const std::size_t length = tail_length(pixels * n);
    return {n, length == 0 ? 0 : length + 1};
}

std::optional<Tail> region_tail(const Scene& scene, const SamplerRef& arm, std::uint32_t seed, const AreaPixels& pixels,
    const std::string& isa, ProgressMonitor& monitor) {
    const TailPlan plan = tail_plan(pixels.count());
    if (plan.largest_count == 0) return std::nullopt;
    std::uint64_t draw_count = 0;
    return fit_pooled_tail(
        largest_samples(scene, arm, plan.n, seed, pixels.tight(), plan.largest_count, isa, monitor, draw_count));
}

}  // namespace crescent
