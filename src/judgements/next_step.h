// Next steps in the words of a front end: flags of the command line, calls of C++ or of Python.
#pragma once

#include <string>
#include <utility>

#include "judgements/verdict.h"

namespace crescent::inline judgements {

/// Who shows a judgement.
enum class FrontEnd { command_line, cpp, python };

/// What would settle a verdict that is inconclusive: "--full draws more." or the same in calls; "" for none.
std::string settling(const Verdict& verdict, FrontEnd front_end = FrontEnd::command_line);
/// How to judge the sampler at one w_o alone: theta and azimuth in degrees.
std::string one_wo_text(std::pair<double, double> wo, FrontEnd front_end);

}  // namespace crescent::inline judgements
