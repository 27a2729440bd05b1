// Output of verdicts: a summary and a table for the terminal, JSON, JUnit for build servers, and one HTML file that
// contains its pictures.
#pragma once

#include <string>
#include <utility>

#include "check/verdict.h"

namespace crescent::inline results {

/// The origin of a result; equal calls have equal ones.
struct ResultSource {
    std::string version, commit, command;
};

/// One line for each finding over all w_o, one line for each arm with its verdicts, then the details; `all`: every
/// verdict.
std::string verdict_table(const CheckResult& result, bool all = false);
/// Format: docs/check.schema.json. Equal calls give equal bytes: values that vary between runs are in verdict_timing.
std::string verdict_json(const CheckResult& result, const ResultSource& source = {});
/// Seconds of each verdict, nanoseconds of a sample, variance x time and the resulting ranks.
std::string verdict_timing(const CheckResult& result, const ResultSource& source = {});
std::string verdict_junit(const CheckResult& result);
/// The summary, a matrix of w_o and verdicts, then for each case: maps of observed, expected and standardised
/// difference, weight histograms with their tail, and polar plots of p and f L cos. For a sampler without pdf(w): the
/// map and the table of the density that its draws imply. Not in crescent::check built alone.
std::string verdict_html(const CheckResult& result, const ResultSource& source = {});

// ---- Next steps in the terms of a front end: flags of the command line, calls of C++ or of Python.

/// The front end that shows a result.
enum class FrontEnd { command_line, cpp, python };

/// The next step for an inconclusive verdict: "--full draws more." or the equivalent call; "" if there is none.
std::string next_step_text(const Verdict& verdict, FrontEnd front_end = FrontEnd::command_line);
/// How to check the sampler at a single w_o: theta and azimuth in degrees.
std::string one_wo_text(std::pair<double, double> wo, FrontEnd front_end);

}  // namespace crescent::inline results
