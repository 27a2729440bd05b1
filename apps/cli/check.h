// What `crescent check` and its measurements of the bench itself share.
#pragma once

#include "commands.h"
#include "crescent/crescent.h"
#include "progress.h"

namespace crescent::cli {

TestSettings test_settings_of(const CheckFlags& flags);
int exit_of(State state);
/// The same, where the caller may allow what is inconclusive.
int exit_of(State state, const CheckFlags& flags);
void write_files(const CheckFlags& flags, const CheckResult& j);
std::string shortest(double v);
/// What is said of a program or plugin that never came to be judged.
CheckResult complaint(const SamplerError& fault, const CheckFlags& flags, const std::string& command);
/// What a program or plugin may take.
PipeLimits limits_of(const CheckFlags& flags, const ProgressMonitor& monitor);
/// Exit 0: compared; 1: with --expect same, f or the distribution differs; 4: a tail is too heavy to tell.
int check_against(
    const CheckFlags& flags, std::vector<CheckCase> a, std::span<const Waiver> waivers, bool same, Progress& monitor);

/// Which verdict catches which fault. Exit 0 where every fault is caught.
int check_planted(const CheckFlags& flags, Progress& monitor);
/// Exit 0 where no right sampler is accused more often than was promised.
int check_right(const CheckFlags& flags, ProgressMonitor& monitor);

}  // namespace crescent::cli
