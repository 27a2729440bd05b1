// A comparison as text: for machines, build servers and the terminal.
#pragma once

#include "compare/results.h"
#include "report/report.h"

namespace crescent::inline comparison {

/// docs/compare.schema.json says what stands in it; equal inputs give equal bytes.
std::string compare_json(
    const ComparePlan& plan, const RenderStats& all, const CompareResult& result, const Provenance& provenance);
/// One metric a row, RFC 4180.
std::string compare_csv(const CompareResult& result);
std::string compare_junit(const ComparePlan& plan, const CompareResult& result);
std::string compare_summary(
    const ComparePlan& plan, const RenderStats& all, const CompareResult& result, const std::string& out_dir);
/// One page that opens offline; `plates` are PNG bytes by name.
std::string compare_html(const ComparePlan& plan, const RenderStats& all, const CompareResult& result,
    const Provenance& provenance, const std::map<std::string, std::vector<unsigned char>>& plates);

}  // namespace crescent::inline comparison
