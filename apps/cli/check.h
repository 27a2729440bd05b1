// Shared by `crescent check` and its self-tests.
#pragma once

#include <array>

#include "commands.h"
#include "crescent/crescent.h"
#include "progress.h"

namespace crescent::cli {

TestSettings test_settings_of(const CheckFlags& flags);
int exit_of(State state);
/// The same, if inconclusive results may be allowed.
int exit_of(State state, const CheckFlags& flags);
/// Prints at most 12 lines for one sampler; with `verbose`, or for several, the table and the details.
void print_verdicts(const CheckResult& result, bool verbose);
void write_files(const CheckFlags& flags, const CheckResult& result);
/// The values of --estimates, one or one for each channel.
std::array<double, 3> expected_values(const CheckFlags& flags, int channels);
std::string shortest(double v);
/// Returns the result for a program or plugin that could not be checked.
CheckResult unchecked_result(const SamplerError& fault, const CheckFlags& flags, const std::string& command);
/// Returns the limits of a program or plugin.
PipeLimits limits_of(const CheckFlags& flags, const ProgressMonitor& monitor);
/// Exit 0: compared; 1: with --expect same, f or the distribution differs; 4: a tail is too heavy to decide.
int check_against(const CheckFlags& flags, std::vector<CheckCase> a, std::span<const Waiver> waivers, bool expects_same,
    Progress& monitor);

/// Reports which verdict detects which fault. Exit 0 if every fault is detected.
int check_planted(const CheckFlags& flags, Progress& monitor);

}  // namespace crescent::cli
