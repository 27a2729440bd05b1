// Samplers are checked on all cores, each with seed_of() of its number, and counted in their order afterwards, so that
// the table does not depend on the number of threads. Rates have Clopper & Pearson's 95 % interval.
#include "tests/known_samplers/study/false_alarms.h"

#include <algorithm>
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include "check/report/summary.h"
#include "math/simd/random.h"
#include "math/statistics.h"

namespace crescent {

namespace {

RightFamily& family_of(FalseAlarmStudy& study, const std::string& name) {
    for (RightFamily& f : study.families)
        if (f.name == name) return f;
    study.families.push_back({name, 0, 0, 0});
    return study.families.back();
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
        const CheckCase check_case = correct_case(first + i, given.seed);
        ProgressMonitor inner;
        all[i] = run_checks({&check_case, 1}, settings, inner);
        monitor.advance(1);
    });
    FalseAlarmStudy study;
    study.alpha = given.alpha;
    study.full = given.full;
    for (std::uint64_t i = 0; i < count; ++i) {
        RightFamily& f = family_of(study, right_sampler(first + i, given.seed).family);
        const bool wrong = all[i].state == State::wrong, open = all[i].state == State::inconclusive;
        ++f.checked;
        f.false_alarms += wrong;
        f.undecided += open;
        ++study.checked;
        study.false_alarms += wrong;
        study.undecided += open;
        if (wrong || open) study.message.push_back(fmt::format("{}: {}", first + i, what_is_wrong(all[i])));
    }
    return study;
}

std::string false_alarm_text(const FalseAlarmStudy& study) {
    std::string out = "| family | judged | accused | inconclusive |\n|---|---|---|---|\n";
    for (const RightFamily& f : study.families)
        out += fmt::format("| {} | {} | {} | {} |\n", f.name, f.checked, f.false_alarms, f.undecided);
    out += fmt::format("\nAccused in {} mode: {}; promised: at most {:g}. Inconclusive: {}.\n",
        study.full ? "full" : "quick", rate_text(study.false_alarms, study.checked), study.alpha,
        rate_text(study.undecided, study.checked));
    return out;
}

}  // namespace crescent
