// Runs a comparison: reads the renders twice, tests, draws and writes the outputs.
#include "compare/compare.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/files.h"
#include "compare/bias.h"
#include "compare/metrics.h"
#include "compare/outputs.h"
#include "compare/page.h"
#include "compare/plan.h"
#include "compare/plates.h"
#include "compare/wording.h"
#include "output/format.h"
#include "output/junit.h"
#include "report/plates/canvas.h"

namespace crescent {

// ---- Metrics, tests and the state that follows from them.

namespace {

/// Returns the value of the plan, else the mean over the files of the arm if all of them state it.
template <class Read>
std::optional<double> stated_mean(const std::optional<double>& plan, const ArmStats& arm, Read read) {
    if (plan) return plan;
    double sum = 0;
    for (const RenderFile& file : arm.files) {
        if (!read(file)) return {};
        sum += *read(file);
    }
    return sum / static_cast<double>(arm.files.size());
}

}  // namespace

ArmResult measure_arm(const ComparePlan& plan, const RenderStats& stats, std::size_t a, ProgressMonitor& monitor) {
    ArmResult out;
    const ArmStats& arm = stats.arms[a];
    out.name = plan.arms[a].name;
    out.renders = arm.files.size();
    out.spp = stated_mean(plan.arms[a].spp, arm, [](const RenderFile& f) { return f.spp; });
    out.seconds = stated_mean(plan.arms[a].seconds, arm, [](const RenderFile& f) { return f.seconds; });
    const std::vector<Flips> flip = measure_flip(plan, stats, a, monitor);
    for (std::size_t r = 0; r < stats.regions.size(); ++r)
        out.regions.push_back(measure_region(stats, arm, r, {out.seconds, out.spp}, flip[r]));
    return out;
}

namespace {

double value_of(const ParsedQuantity& side, const CompareResult& result, std::string& why) {
    if (side.number) return *side.number;
    for (const ArmResult& arm : result.arms) {
        if (arm.name != side.adapter) continue;
        const MetricValue& value = arm.region(side.region).metric(side.word);
        if (value.value) return *value.value;
        why = fmt::format("{} has no value: {}", to_string(side), value.why);
    }
    return std::nan("");
}

/// Returns why no metric of a region can be asserted: some of its pixels are not finite on one side of a pair; "" if
/// all are.
std::string why_not_finite(const RenderStats& stats, const CompareResult& result, const std::string& region) {
    const auto set =
        std::find_if(stats.regions.begin(), stats.regions.end(), [&](const PixelSet& s) { return s.name == region; });
    const auto touches_region = [&](const FailingPixels& failing) {
        return std::any_of(failing.pixels.begin(), failing.pixels.end(),
            [&](std::uint32_t i) { return std::binary_search(set->left_out.begin(), set->left_out.end(), i); });
    };
    for (const BiasResult& b : result.bias)
        if (touches_region(b.non_finite.a) || touches_region(b.non_finite.b)) return failing_pixels(stats, b);
    if (stats.arms.size() > 1 || stats.reference) return {};
    const ArmStats& arm = stats.arms[0];
    const auto fails = [&](std::uint32_t i) { return arm.not_finite[i] == arm.files.size(); };
    const auto count = std::count_if(set->left_out.begin(), set->left_out.end(), fails);
    return count ? fmt::format("{} of its pixels are finite in no render", count) : "";
}

AssertionResult asserted(const AssertionPlan& plan, const RenderStats& stats, CompareResult& result) {
    AssertionResult out;
    out.name = plan.name;
    out.op = plan.check.op;
    out.text = to_string(plan.check);
    std::string why;
    out.measured = value_of(plan.check.left, result, why);
    out.bound = value_of(plan.check.right, result, why);
    if (!why.empty()) result.warnings.push_back(out.name + ": " + why);
    out.pass = holds(out.measured, out.op, out.bound);
    for (const ParsedQuantity* side : {&plan.check.left, &plan.check.right}) {
        if (side->number) continue;
        const std::string bad = why_not_finite(stats, result, side->region);
        if (bad.empty()) continue;
        out.pass = false;
        out.text += fmt::format(" (cannot hold in {}: {})", side->region, bad);
        break;
    }
    return out;
}

/// Returns what was not tested precisely enough for expect = "same"; "" if everything was.
std::string why_inconclusive(const ComparePlan& plan, const BiasResult& bias) {
    if (bias.non_finite.undecided)
        return fmt::format(
            "of {} and {}, {} pixels are not finite in half of the renders of one side or more and in "
            "none of the other; more renders are needed to test whether that is chance",
            bias.a, bias.b, bias.non_finite.undecided);
    for (const MeanTest& t : bias.regions) {
        if (!t.caveat.empty()) return fmt::format("{} and {} in {}: {}", bias.a, bias.b, t.region, t.caveat);
        if (!t.why.empty()) return fmt::format("{} and {} in {}: {}{}", bias.a, bias.b, t.region, t.why, t.requirement);
        for (const MeanTest& c : t.channels)
            if (!c.why.empty())
                return fmt::format(
                    "{} of {} and {} in {}: {}{}", c.region, bias.a, bias.b, t.region, c.why, c.requirement);
        if (!(t.smallest <= plan.smallest))
            return fmt::format(
                "{} and {} in {}: a difference of {:.2g} % would have been found, {:.2g} % is required; more "
                "renders are needed",
                bias.a, bias.b, t.region, 100 * t.smallest, 100 * plan.smallest);
    }
    return "";
}

void conclude(const ComparePlan& plan, CompareResult& result) {
    using State = CompareResult::State;
    for (const AssertionResult& a : result.assertions)
        if (!a.pass) {
            result.state = State::fails;
            result.sentence = std::isnan(a.measured) || std::isnan(a.bound)
                ? fmt::format("An assertion does not pass: {}: a side of it was not measured.", a.text)
                : fmt::format(
                      "An assertion fails: {}: measured {} and {}.", a.text, shortest(a.measured), shortest(a.bound));
        }
    if (plan.expect != Expectation::same) return;
    const auto state_pair = [&](std::size_t pair) {
        result.sentence = result.bias[pair].sentence;
        result.stated_pair = pair;
    };
    for (std::size_t k = 0; k < result.bias.size(); ++k)
        if (result.bias[k].differs()) {
            result.state = State::fails;
            state_pair(k);
        }
    for (std::size_t k = 0; k < result.bias.size(); ++k) {
        const BiasResult& bias = result.bias[k];
        const std::string why = bias.identical ? "" : why_inconclusive(plan, bias);
        if (why.empty() || result.state != State::holds) continue;
        result.state = State::inconclusive;
        if (bias.single) state_pair(k);
        else result.sentence = "Equality cannot be stated: " + why + ".";
    }
}

}  // namespace

CompareResult test_differences(const ComparePlan& plan, const RenderStats& stats, ProgressMonitor& monitor) {
    CompareResult out;
    out.warnings = stats.warnings;
    const std::size_t arms = stats.arms.size();
    for (std::size_t a = 0; a < arms; ++a) out.arms.push_back(measure_arm(plan, stats, a, monitor));
    for (std::size_t r = 0; r < stats.regions.size() && stats.reference; ++r)
        out.reference_error[stats.regions[r].name] = std::sqrt(reference_variance(stats, r));
    if (stats.reference) out.reference_error_from = reference_error_from(*stats.reference);
    const std::size_t pairs = arms * (arms - 1) / 2 + (stats.reference ? arms : 0);
    const double alpha = pairs ? plan.alpha / static_cast<double>(pairs) : plan.alpha;
    for (std::size_t a = 0; a < arms; ++a) {
        if (stats.reference) out.bias.push_back(test_bias(plan, stats, out, a, arms, {alpha, alpha}, monitor));
        for (std::size_t b = 0; b < a; ++b) {
            out.bias.push_back(test_bias(plan, stats, out, a, b, {alpha, alpha}, monitor));
            if (stats.arms[a].files.size() > 1 && stats.arms[b].files.size() > 1)
                out.noise.push_back(compare_noise(plan, stats, a, b, alpha));
        }
    }
    out.rankings = rank(out);
    out.ladders = ladders_of(out);
    for (const AssertionPlan& a : plan.assertions) out.assertions.push_back(asserted(a, stats, out));
    conclude(plan, out);
    return out;
}

CompareResult compare_renders(const ComparePlan& plan, const CompareOptions& options, const Provenance& provenance,
    ProgressMonitor& monitor, std::string& summary) {
    const plates::Canvas font_check(1, 1, {});  // reports a missing font, and a folder in use, before the work
    Staging staging(options.out);
    const RenderStats stats = read_all(plan, monitor);
    const CompareResult result = test_differences(plan, stats, monitor);
    std::map<std::string, std::vector<unsigned char>> pictures;
    for (const auto& [name, picture] : compare_plates(plan, stats, result))
        pictures[name] = encode_png(picture,
            {{"Software", "crescent " + provenance.version}, {"Title", name}, {"Command", provenance.command}});
    monitor.check();
    for (const auto& [name, png] : pictures) staging.write("plates/" + name + ".png", png);
    if (!result.ladders.empty()) staging.write("plates/ladders.svg", ladders_svg(result, plan.theme));
    const Json stored = compare_result_json(plan, stats, result, provenance);
    staging.write("metrics.json", text(stored));
    staging.write("metrics.csv", compare_csv(result));
    staging.write("junit.xml", junit_text(compare_report(plan, result)));
    staging.write("report.html", compare_html(stored, pictures));
    staging.commit(monitor);
    summary = compare_summary(plan, stats, result, options.out);
    return result;
}

}  // namespace crescent
