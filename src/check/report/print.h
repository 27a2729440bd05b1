// Verdicts for the reader: a summary and a table for the terminal, JSON, JUnit for build servers, one HTML file with
// its pictures.
#pragma once

#include <string>
#include <utility>

#include "check/verdict.h"

namespace crescent::inline results {

/// Where a result comes from; equal calls have equal ones.
struct ResultSource {
    std::string version, commit, command;
};

/// One line a finding over all w_o, an arm a line with its verdicts, then the details; `all`: every verdict.
std::string verdict_table(const CheckResult& result, bool all = false);
/// docs/check.schema.json. Equal calls give equal bytes: what varies from run to run stands in verdict_timing.
std::string verdict_json(const CheckResult& result, const ResultSource& source = {});
/// Seconds of each verdict, nanoseconds of a sample, variance x time and the ranks that follow from them.
std::string verdict_timing(const CheckResult& result, const ResultSource& source = {});
std::string verdict_junit(const CheckResult& result);
/// The summary, a matrix of w_o and verdicts, then case by case: maps of observed, expected and standardised
/// difference, weight histograms with their tail, and roses of p over f L cos; of a sampler without pdf(w) the map and
/// the table of the density that its draws imply.
std::string verdict_html(const CheckResult& result, const ResultSource& source = {});

// ---- Next steps in the words of a front end: flags of the command line, calls of C++ or of Python.

/// Who shows a result.
enum class FrontEnd { command_line, cpp, python };

/// What would settle a verdict that is inconclusive: "--full draws more." or the same in calls; "" for none.
std::string settling(const Verdict& verdict, FrontEnd front_end = FrontEnd::command_line);
/// How to check the sampler at one w_o alone: theta and azimuth in degrees.
std::string one_wo_text(std::pair<double, double> wo, FrontEnd front_end);

}  // namespace crescent::inline results
