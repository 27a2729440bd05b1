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

FurnaceMeter measure_one(const Experiment& experiment, const FurnacePlan& plan, const std::string& isa,
    ProgressMonitor& monitor, const OutsideSamplers& outside) {
    const auto arm = std::find_if(
        experiment.arms.begin(), experiment.arms.end(), [&](const ArmPlan& a) { return a.name == plan.arm; });
    ensure(arm != experiment.arms.end(), "a furnace's arm is known");
    const Shape* shape = experiment.find_shape(plan.shape);
    ensure(shape != nullptr, "a furnace's shape is known");
    const bool lobe_only = plan.part == FurnacePart::lobe;
    const Surface surface = furnace_surface(experiment, *shape, lobe_only);
    const ShadingPoints sites = furnace_sites(surface, 1);
    std::vector<float> samples(plan.n);
    const Moments m = estimate_sites(sites, {arm->sampler, outside_of(outside, arm->name)}, plan.n, experiment.seed,
        isa, &monitor.stop, samples.data());
    const double n = static_cast<double>(plan.n);
    FurnaceMeter out;
    out.name = plan.name, out.arm = plan.arm, out.part = lobe_only ? "lobe" : "combined", out.n = plan.n;
    const double rho_d = luminance(surface.rho_d);
    const double albedo = surface.rho_s > 0 ? lobe_albedo(surface.brdf, surface.s, surface.alpha, 1.0) : 0;
    out.measured = (rho_d / pi * m.g[0] + surface.rho_s * m.g_lobe[0]) / n;
    out.expected = rho_d + surface.rho_s * albedo;
    out.se = plan.n > 1 ? std::sqrt(m.spread[0] / (n * (n - 1))) : 0;
    out.tail = tail_of(std::move(samples));
    out.bad = m.bad[0];
    return out;
}

}  // namespace

std::vector<FurnaceMeter> furnaces(const Experiment& experiment, const Published* published, const std::string& isa,
    ProgressMonitor& monitor, const OutsideSamplers& outside) {
    std::vector<FurnaceMeter> out;
    for (const FurnacePlan& plan : experiment.furnaces) {
        out.push_back(measure_one(experiment, plan, isa, monitor, outside));
        if (published) out.back().published = published->furnace(plan.name);
        monitor.check();
    }
    return out;
}

}  // namespace crescent::inline studies
