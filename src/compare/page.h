// The sections of a comparison's page, as HTML; "" where there is nothing to say.
#pragma once

#include <string>

#include "compare/plan.h"
#include "compare/results.h"

namespace crescent::inline comparison {

/// The tables of the page: every metric by arm and region, with its interval.
std::string numbers_section(const ComparePlan& plan, const RenderStats& all, const CompareResult& result);
std::string rankings_section(const CompareResult& result);
std::string means_section(const CompareResult& result);
std::string noise_section(const CompareResult& result);
std::string ladders_section(const CompareResult& result);
std::string spectra_section(const RenderStats& all, const CompareResult& result);
std::string files_section(const RenderStats& all, const CompareResult& result);

}  // namespace crescent::inline comparison
