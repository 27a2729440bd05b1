// The bench's own error rates: how often it accuses right arms, over many seeds, and which verdict catches which
// planted fault.
#pragma once

#include "base/progress_monitor.h"
#include "verdicts/judge.h"

namespace crescent::inline verdicts {

/// Right arms of the list at three w_o each, their statistical tests alone, on `seeds` seeds; bins and integrals are
/// made once.
struct FalseAlarms {
    std::uint64_t seeds = 0, trials = 0, draws = 0;  // draws: a trial and seed
    std::uint64_t tests = 0, screened = 0, confirmed = 0;
    std::uint64_t calls = 0;  // seeds on which some right arm was called wrong
    double alpha = 0, screen = 0;
};
/// How often right arms are accused, over so many seeds. Throws Interrupted.
FalseAlarms measure_false_alarms(std::uint64_t seeds, const TestSettings& settings, ProgressMonitor& monitor);

/// Clopper & Pearson 1934: the 95 % interval of a rate.
std::pair<double, double> rate_interval(std::uint64_t hits, std::uint64_t of);
/// "3 of 1000 = 0.003 (95 %: 0.000619 to 0.00874)".
std::string rate_text(std::uint64_t hits, std::uint64_t of);

/// One line of the table of faults: the verdicts that catch it, in quick and in full mode.
struct Caught {
    std::string fault, breaks, quick, full;
};
/// docs/error-rates.md; law: what came of right samplers at random parameters, "" where they were not asked for.
std::string error_rates_text(const FalseAlarms& alarms, const std::string& law, std::span<const Caught> caught,
    const std::string& command, const std::string& version);

}  // namespace crescent::inline verdicts
