// Both sides are assumed to have the variance of the baseline, which falls as 1/N with N samples.
#include "compare/suite/render_plan.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "compare/anytime.h"
#include "compare/moments.h"
#include "compare/renders.h"
#include "compare/suite/measure.h"
#include "compare/suite/suite.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent {

// ---- Let s1 and s2 be the estimated over the true standard error, now and in the repetition. The repetition finds c
// s1 if c s1 + Z > t s2, with Z normal. In normal approximation of s (mean 1 - 1/(4 df), variance 1/(2 df)) this has a
// probability of 90 % if c m1 - t m2 = z sqrt(1 + c^2/(2 df1) + t^2/(2 df2)), z = 1.2816: a quadratic equation for c.
// In simulation c is accurate to 1 % from 10 degrees of freedom on, and too large by 10 % with 3. The standard error
// falls as n^-1/2 with n renders, the difference that rare events could explain as 1/n.

namespace {

constexpr std::size_t most_renders = 100000;

}  // namespace

double found_difference(const Welch& test, double estimate_df, double level, double information) {
    if (!(test.df > 0) || !(estimate_df > 0) || !std::isfinite(test.se)) return HUGE_VAL;
    constexpr double z = 1.2815515655446004;  // P(Z < z) = 0.9
    const double t =
        information > 0 ? anytime_quantile(level, test.df, information) : student_quantile(1 - level / 2, test.df);
    if (!std::isfinite(t)) return HUGE_VAL;
    const double m1 = 1 - 1 / (4 * estimate_df), m2 = 1 - 1 / (4 * test.df);
    const double a = m1 * m1 - z * z / (2 * estimate_df), b = m1 * m2 * t,
                 c = m2 * m2 * t * t - z * z * (1 + t * t / (2 * test.df));
    const double root = b * b - a * c;
    return a > 0 && root >= 0 ? test.se * (b + std::sqrt(root)) / a : HUGE_VAL;
}

double detectable_with(const RegionPower& power, std::size_t renders, double level) {
    const double n = static_cast<double>(renders), a = power.variance_a / n, b = power.variance_b / n;
    Welch test;
    test.se = std::sqrt(power.paired ? a : a + b);
    test.df = power.paired ? n - 1 : a + b > 0 ? (a + b) * (a + b) * (n - 1) / (a * a + b * b) : 2 * (n - 1);
    const double information = !power.anytime ? 0 : power.paired ? n : n / 2;
    return std::max(found_difference(test, power.estimate_df, level, information), power.hidden_difference / n);
}

std::optional<std::size_t> renders_needed(const RegionPower& power, double smallest, double level) {
    const double limit = smallest * power.mean;
    const auto is_enough = [&](std::size_t n) { return detectable_with(power, n, level) <= limit; };
    if (!(limit > 0) || !is_enough(most_renders)) return {};
    std::size_t low = 1, high = most_renders;  // too few, enough
    while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (is_enough(middle) ? high : low) = middle;
    }
    return high;
}

namespace {

ViewPlan plan_view(const Suite& suite, const SuiteView& view, std::size_t compared) {
    ViewPlan out;
    out.name = view.name;
    out.smallest = suite.smallest(view);
    ComparePlan plan;
    plan.file = suite.file.empty() ? "crescent compare" : suite.file;
    RenderArm& arm = plan.arms.emplace_back();
    arm.name = "baseline";
    arm.location = {plan.file, 0, 0};
    arm.layer = suite.options.layer;
    arm.moments = view.baseline.size() == 1 && has_moments(view.baseline.front());
    const RenderSource source = files_read_with(suite.options.reading());
    std::vector<std::uint64_t> hashes;
    for (const std::string& path : view.baseline) {
        const std::uint64_t hash = pixel_hash(source.read(path, arm.moments ? "" : arm.layer));
        if (std::find(hashes.begin(), hashes.end(), hash) == hashes.end()) {
            hashes.push_back(hash);
            arm.files.push_back(path);
        }
    }
    plan.regions = view.regions;
    plan.flip = false;
    ProgressMonitor quiet;
    const RenderStats stats = read_all(plan, quiet, source);
    const ArmStats& baseline = stats.arms[0];
    out.renders = baseline.files.size();
    out.spp = baseline.files[0].spp;
    if (out.renders < 2) {
        out.why = view.baseline.size() > 1 ? "deterministic: its renders have the same pixels, one is enough"
                                           : "one render has no variance: two or more are needed";
        return out;
    }
    const double level = suite.options.alpha * share_of_means / static_cast<double>(compared) / 2 /
        static_cast<double>(stats.regions.size()) * level_share(0, stats.quantities);
    for (std::size_t r = 0; r < stats.regions.size(); ++r) {
        std::vector<double> means;
        for (const auto& render : baseline.regions) means.push_back(render[r].y);
        const MeanInterval m = mean_interval(means, confidence);
        const double variance = m.se * m.se * static_cast<double>(m.n);
        std::array<std::optional<std::size_t>, 3> counts;
        for (std::size_t s = 0; s < plan_samples.size(); ++s) {
            RegionPower power;
            power.mean = std::fabs(m.mean);
            power.variance_a = power.variance_b = variance / plan_samples[s];
            power.estimate_df = static_cast<double>(m.n - 1);
            counts[s] = renders_needed(power, out.smallest, level);
        }
        constexpr std::size_t as_rendered = 1;
        const auto& largest = out.render_counts[as_rendered];
        if (!out.region.empty() && counts[as_rendered] && (!largest || *counts[as_rendered] <= *largest)) continue;
        out.region = stats.regions[r].name;
        out.render_counts = counts;
        out.mean = m.mean;
        out.deviation = std::sqrt(variance);
    }
    return out;
}

std::string samples_text(const ViewPlan& plan, std::size_t s) {
    const std::string renders =
        plan.render_counts[s] ? plural(*plan.render_counts[s], "render") : std::string("more than 100000 renders");
    return plan.spp ? fmt::format("{} at {} spp", renders, compact(*plan.spp * plan_samples[s]))
                    : fmt::format("{} at {} times the samples", renders, compact(plan_samples[s]));
}

}  // namespace

std::vector<ViewPlan> plan_renders(const Suite& suite, ProgressMonitor& monitor) {
    std::vector<ViewPlan> out;
    std::size_t views = 0;
    for (const SuiteView& view : suite.views) views += !view.baseline.empty();
    if (views == 0)
        throw InputError({suite.file, 0, 0},
            fmt::format("--plan: expected renders of the baseline, found no file that matches '{}'",
                fmt::join(suite.options.baseline, "', '")));
    monitor.begin("views", static_cast<double>(views));
    for (const SuiteView& view : suite.views) {
        monitor.check();
        if (view.baseline.empty()) continue;
        out.push_back(plan_view(suite, view, views));
        monitor.advance(1);
    }
    return out;
}

std::string render_plan_text(const Suite& suite, const std::vector<ViewPlan>& plans) {
    std::string out = fmt::format(
        "Renders of each side with which a difference of the stated size is found with a probability of 90 %, at alpha "
        "= {} over {}:\n",
        compact(suite.options.alpha), plural(plans.size(), "view"));
    std::size_t longest = 0;
    for (const ViewPlan& plan : plans) longest = std::max(longest, width(plan.name));
    for (const ViewPlan& plan : plans) {
        out += left(plan.name, longest) + "  ";
        if (!plan.why.empty()) {
            out += plan.why + "\n";
            continue;
        }
        std::vector<std::string> choices;
        for (std::size_t s = 0; s < plan_samples.size(); ++s) choices.push_back(samples_text(plan, s));
        out += fmt::format("{} of mean Y in {}: {}; the baseline has {}\n", percent(plan.smallest, 2), plan.region,
            fmt::join(choices, ", "), plan.renders);
    }
    return out;
}

std::string render_plan_json(const Suite& suite, const std::vector<ViewPlan>& plans) {
    Json out = {{"format", "crescent render plan 1"}, {"alpha", crescent::number(suite.options.alpha)},
        {"views", Json::array()}};
    for (const ViewPlan& plan : plans) {
        Json view = {{"view", plan.name}, {"renders", plan.renders}, {"smallest", crescent::number(plan.smallest)}};
        if (plan.spp) view["spp"] = crescent::number(*plan.spp);
        if (!plan.why.empty()) view["why"] = plan.why;
        else {
            view["region"] = plan.region;
            view["mean_y"] = crescent::number(plan.mean);
            view["standard_deviation_of_render_mean"] = crescent::number(plan.deviation);
            for (std::size_t s = 0; s < plan_samples.size(); ++s)
                view["needed"].push_back({{"samples", plan_samples[s]},
                    {"renders", plan.render_counts[s] ? Json(*plan.render_counts[s]) : Json(nullptr)}});
        }
        out["views"].push_back(std::move(view));
    }
    return text(out);
}

}  // namespace crescent
