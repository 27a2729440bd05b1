// A white sky of radiance 1 over one surface seen from straight above: the mean of X is its albedo. One pixel's
// samples, all kept, for the tail.
#include "studies/furnace.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/errors.h"
#include "color/rgb.h"
#include "estimator/estimator.h"
#include "studies/furnace_sites.h"
#include "reference/lobe_albedo.h"
#include "stats/tail.h"

namespace crescent::inline studies {

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
    ProgressMonitor& monitor, const OutsideSamplers& outside) {
    const auto arm = std::find_if(
        experiment.arms.begin(), experiment.arms.end(), [&](const ArmPlan& a) { return a.name == plan.arm; });
    ensure(arm != experiment.arms.end(), "a furnace's arm is known");
    const Shape* shape = experiment.find_shape(plan.shape);
    ensure(shape != nullptr, "a furnace's shape is known");
    const bool lobe_only = plan.part == FurnacePart::lobe;
    const Surface surface = furnace_surface(experiment, *shape, lobe_only);
    const ShadingPoints sites = furnace_sites(surface, 1);
    FurnaceDraws out;
    out.samples.resize(plan.n);
    const Moments m = estimate_sites(sites, {arm->sampler, outside_of(outside, arm->name)}, plan.n, experiment.seed,
        isa, &monitor.stop, out.samples.data());
    const double n = static_cast<double>(plan.n);
    FurnaceMeter& meter = out.meter;
    meter.name = plan.name, meter.arm = plan.arm, meter.part = lobe_only ? "lobe" : "combined", meter.n = plan.n;
    const double rho_d = luminance(surface.rho_d);
    const double albedo = surface.rho_s > 0 ? lobe_albedo(surface.brdf, surface.s, surface.alpha, 1.0) : 0;
    meter.measured = (rho_d / pi * m.g[0] + surface.rho_s * m.g_lobe[0]) / n;
    meter.expected = rho_d + surface.rho_s * albedo;
    meter.se = plan.n > 1 ? std::sqrt(m.spread[0] / (n * (n - 1))) : 0;
    meter.bad = m.bad[0];
    return out;
}

FurnaceMeter read_furnace(FurnaceDraws draws) {
    draws.meter.tail = tail_of(std::move(draws.samples));
    return draws.meter;
}

std::vector<FurnaceMeter> furnaces(const Experiment& experiment, const Published* published, const std::string& isa,
    ProgressMonitor& monitor, const OutsideSamplers& outside) {
    std::vector<FurnaceMeter> out;
    for (const FurnacePlan& plan : experiment.furnaces) {
        out.push_back(read_furnace(draw_furnace(experiment, plan, isa, monitor, outside)));
        if (published) out.back().published = published->furnace(plan.name);
        monitor.check();
    }
    return out;
}

}  // namespace crescent::inline studies
