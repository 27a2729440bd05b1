// A comparison as text: for machines, build servers and the terminal.
#pragma once

#include <string>

#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/results.h"
#include "output/format.h"
#include "output/test_report.h"
#include "report/report.h"

namespace crescent {

/// metrics.json, which docs/compare.schema.json describes; equal inputs give equal values.
Json compare_result_json(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, const Provenance& provenance);
/// One metric per row, RFC 4180.
std::string compare_csv(const CompareResult& result);
/// The assertions and the expectation, and those that fail at the compare file; file: "" without one.
TestReport compare_report(const ComparePlan& plan, const CompareResult& result, const std::string& file = "",
    const std::string& version = "");
std::string compare_summary(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, const std::string& out_dir);
/// The method of places whose noise is correlated, as in the JSON.
inline constexpr const char* dependent_method = "Benjamini-Yekutieli";

}  // namespace crescent
