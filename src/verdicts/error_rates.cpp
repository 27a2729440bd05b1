// Bins and integrals of the list's right arms are made once; draws and tests are anew on each seed. Rates with exact
// binomial intervals of 95 %.
#include "verdicts/error_rates.h"

#include <chrono>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include "base/parallel.h"
#include "simd/random.h"
#include "stats/distributions.h"
#include "subjects/list.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

bool is_right(const Trial& t) {
    return !t.theory.wrong && (t.theta_deg == 0 || t.theta_deg == 45 || t.theta_deg == 85);
}

/// The first verdict that is wrong of those that depend on the draws at hand.
std::optional<Verdict> accusation(TrialContext& work) {
    for (const VerdictKind* kind : verdict_kinds)
        if (kind->asked_of_other_seeds)
            if (Verdict v = kind->judge(work); v.state == State::wrong) return v;
    return {};
}

}  // namespace

std::pair<double, double> rate_interval(std::uint64_t hits, std::uint64_t of) {
    if (of == 0) return {0, 1};
    const ShareInterval p = binomial_interval(static_cast<double>(of), static_cast<double>(hits), 0.025);
    return {p.low, p.high};
}

std::string rate_text(std::uint64_t hits, std::uint64_t of) {
    const auto [low, high] = rate_interval(hits, of);
    return fmt::format("{} of {} = {:.3g} (95 %: {:.3g} to {:.3g})", hits, of,
        of ? static_cast<double>(hits) / static_cast<double>(of) : 0.0, low, high);
}

FalseAlarms measure_false_alarms(std::uint64_t seeds, const TestSettings& given, ProgressMonitor& monitor) {
    std::vector<Trial> trials;
    for (Trial& t : trials_of("", {}, false))
        if (is_right(t)) trials.push_back(std::move(t));
    TestSettings settings = given;
    settings.share(count_tests(trials));
    TestCounts test_counts;
    std::vector<std::atomic<int>> alarms(seeds);
    monitor.begin("false alarms", static_cast<double>(trials.size() * seeds));
    parallel_for(std::size_t{0}, trials.size(), [&](std::size_t i) {
        TrialContext work(trials[i], settings, test_counts, static_cast<std::uint32_t>(i));
        work.measure_density();
        for (std::uint64_t k = 0; k < seeds; ++k) {
            monitor.check();
            work.redraw(seed_of(settings.seed, static_cast<std::uint32_t>(k)));
            if (const std::optional<Verdict> v = accusation(work)) {
                ++alarms[k];
                monitor.log(fmt::format("seed {}: {} [{}] {}: {}", k, v->arm, v->trial, v->name, v->say));
            }
            monitor.advance(1);
        }
    });
    FalseAlarms out;
    out.seeds = seeds;
    out.trials = trials.size();
    out.draws = settings.draws;
    out.tests = test_counts.tests;
    out.screened = test_counts.screened;
    out.confirmed = test_counts.confirmed;
    out.alpha = settings.alpha;
    out.screen = settings.screen;
    for (const auto& a : alarms) out.calls += a > 0;
    return out;
}

std::string error_rates_text(const FalseAlarms& a, const std::string& law, std::span<const Caught> caught,
    const std::string& command, const std::string& version) {
    std::string out = "# The bench's own error rates\n\n";
    out += fmt::format(
        "Written by the program on {:%Y-%m-%d} ({}); made again with\n\n```sh\n{}\n```\n\nNot run in the tests: needs "
        "hours.\n\n",
        fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())), version, command);
    out += fmt::format(
        "## How often a right arm is accused\n\nEvery right arm of the list on every surface and light, w_o at 0, 45 "
        "and 85 deg: {} cases of {} draws, {} seeds. Bins and integrals are made once;\n"
        "draws, tests and confirmations anew on each seed: normalised, density, identity, physics and mean, as "
        "`crescent check` asks them. The statistical tests share a family-wise error of {:g} over one call.\n\n",
        a.trials, a.draws, a.seeds, a.alpha);
    out += "| what | rate |\n|---|---|\n";
    out += fmt::format(
        "| a test fails on its first seed (level {:.3g}) | {} |\n", a.screen, rate_text(a.screened, a.tests));
    out += fmt::format("| and again on a fresh one: an accusation | {} |\n", rate_text(a.confirmed, a.tests));
    out += fmt::format("| a whole call accuses some right arm (promised: at most {:g}) | {} |\n", a.alpha,
        rate_text(a.calls, a.seeds));
    if (!law.empty()) out += "\n## How often a right sampler at random parameters is accused\n\n" + law;
    out +=
        "\n## Which verdict catches which planted fault\n\nEach at w_o 0, 45 and 75 deg (`crescent check --planted`, "
        "and with `--full`).\n\n| fault | in | quick | full |\n|---|---|---|---|\n";
    std::uint64_t quick = 0, full = 0, asked = 0;
    for (const Caught& c : caught) {
        out += fmt::format("| {} | {} | {} | {} |\n", c.fault, c.breaks, c.quick.empty() ? "**not caught**" : c.quick,
            c.full.empty() ? "**not caught**" : c.full);
        quick += !c.quick.empty();
        full += !c.full.empty();
        ++asked;
    }
    return out +
        fmt::format("\nCaught in quick mode: {}. In full mode: {}.\n", rate_text(quick, asked), rate_text(full, asked));
}

}  // namespace crescent::inline verdicts
