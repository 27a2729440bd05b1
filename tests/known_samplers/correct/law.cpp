// Samplers are judged on all cores, each with seed_of() of its number, and counted in their order afterwards, so that
// the table is the same on any number of threads. Rates come with Clopper & Pearson's 95 % interval.
#include "tests/known_samplers/correct/law.h"

#include <algorithm>
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include "math/simd/random.h"
#include "math/statistics.h"

namespace crescent {

namespace {

RightFamily& family_of(FalseAlarmStudy& law, const std::string& name) {
    for (RightFamily& f : law.families)
        if (f.name == name) return f;
    law.families.push_back({name, 0, 0, 0});
    return law.families.back();
}

}  // namespace

FalseAlarmStudy measure_false_alarms(
    std::uint64_t first, std::uint64_t count, const TestSettings& given, ProgressMonitor& monitor) {
    std::vector<CheckResult> all(count);
    monitor.begin("right samplers", static_cast<double>(count));
    oneapi::tbb::parallel_for(std::uint64_t{0}, count, [&](std::uint64_t i) {
        monitor.check();
        TestSettings settings = given;
        settings.seed = seed_of(given.seed, static_cast<std::uint32_t>(first + i));
        const CheckCase trial = right_trial(first + i, given.seed);
        ProgressMonitor inner;
        all[i] = judge({&trial, 1}, settings, inner);
        monitor.advance(1);
    });
    FalseAlarmStudy law;
    law.alpha = given.alpha;
    law.full = given.full;
    for (std::uint64_t i = 0; i < count; ++i) {
        RightFamily& f = family_of(law, right_sampler(first + i, given.seed).family);
        const bool wrong = all[i].state == State::wrong, open = all[i].state == State::inconclusive;
        ++f.judged;
        f.accused += wrong;
        f.undecided += open;
        ++law.judged;
        law.accused += wrong;
        law.undecided += open;
        if (wrong || open) law.said.push_back(fmt::format("{}: {}", first + i, what_is_wrong(all[i])));
    }
    return law;
}

std::string right_law_text(const FalseAlarmStudy& law) {
    std::string out = "| family | judged | accused | inconclusive |\n|---|---|---|---|\n";
    for (const RightFamily& f : law.families)
        out += fmt::format("| {} | {} | {} | {} |\n", f.name, f.judged, f.accused, f.undecided);
    out += fmt::format("\nAccused in {} mode: {}; promised: at most {:g}. Inconclusive: {}.\n",
        law.full ? "full" : "quick", rate_text(law.accused, law.judged), law.alpha,
        rate_text(law.undecided, law.judged));
    return out;
}

}  // namespace crescent
