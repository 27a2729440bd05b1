// A result as one HTML file that contains its pictures.
#pragma once

#include <string>

#include "check/report/result_json.h"
#include "check/verdict.h"

namespace crescent {

/// The summary, a matrix of w_o and verdicts, then for each case: maps of observed, expected and standardised
/// difference, weight histograms with their tail, and polar plots of p and f L cos. For a sampler without pdf(w): the
/// map and the table of the density that its draws imply. Not in crescent::check built alone.
std::string verdict_html(const CheckResult& result, const ResultSource& source = {});

}  // namespace crescent
