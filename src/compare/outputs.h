// A comparison as text: for machines, build servers and the terminal.
#pragma once

#include <string>

#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/results.h"
#include "output/format.h"
#include "report/report.h"

namespace crescent {

/// metrics.json, which docs/compare.schema.json describes; equal inputs give equal values.
Json compare_result_json(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, const Provenance& provenance);
/// One metric per row, RFC 4180.
std::string compare_csv(const CompareResult& result);
std::string compare_junit(const ComparePlan& plan, const CompareResult& result);
std::string compare_summary(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, const std::string& out_dir);
/// The method of places whose noise is correlated, as in the JSON.
inline constexpr const char* dependent_method = "Benjamini-Yekutieli";

/// The assertions and the expectation that fail, as SARIF 2.1.0, at the compare file; file: "" without one.
std::string compare_sarif(
    const ComparePlan& plan, const CompareResult& result, const std::string& file, const Provenance& provenance);

}  // namespace crescent
