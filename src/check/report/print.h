// Output of verdicts: a table for the terminal, and a report for build servers and code hosts.
#pragma once

#include <string>
#include <utility>

#include "check/verdict.h"
#include "output/test_report.h"

namespace crescent {

/// One line for each finding over all w_o, one line for each arm with its verdicts, then the details; `includes_right`:
/// every verdict.
std::string verdict_table(const CheckResult& result, bool includes_right = false);
/// A case for each verdict; annotations at the file and line of the sampler (line 0: unknown).
TestReport verdict_report(
    const CheckResult& result, const std::pair<std::string, unsigned>& place = {}, const std::string& version = "");

// ---- Next steps in the terms of a front end: flags of the command line, calls of C++ or of Python.

/// The front end that shows a result.
enum class FrontEnd { command_line, cpp, python };

/// The next step for an inconclusive verdict: "--full draws more." or the equivalent call; "" if there is none.
std::string next_step_text(const Verdict& verdict, FrontEnd front_end = FrontEnd::command_line);
/// How to check the sampler at a single w_o: theta and azimuth in degrees.
std::string one_wo_text(std::pair<double, double> wo, FrontEnd front_end);

}  // namespace crescent
