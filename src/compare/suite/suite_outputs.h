// The result of a suite as text: for machines, build servers, the summary page of a pull request and the terminal.
#pragma once

#include "compare/suite/suite.h"
#include "report/report.h"

namespace crescent::inline comparison {

/// docs/suite.schema.json describes it; equal inputs give equal bytes.
std::string suite_json(const Suite& suite, const SuiteResult& result, bool strict, const Provenance& provenance);
/// One case for each view: changed, noisier and missing fail, too few renders is an error, new is skipped.
std::string suite_junit(const Suite& suite, const SuiteResult& result, bool strict);
/// A table of all views that are not the same, at most 60 kB.
std::string suite_markdown(const Suite& suite, const SuiteResult& result, const Provenance& provenance);
std::string suite_summary(const Suite& suite, const SuiteResult& result);
/// One page that works offline.
std::string suite_html(const Suite& suite, const SuiteResult& result, const Provenance& provenance);

/// Views in the order of their states, changed first, then by name.
std::vector<const ViewResult*> by_state(const SuiteResult& result);

// ---- The pictures of a view in the report: photographs of the means of both sides and a map of their relative
// difference.

/// For a view with renders of one side only.
void picture_one_side(const Suite& suite, const SuiteView& view, const RenderSource& source, ViewResult& out);
/// For a view with both. The size follows from the number of views, larger if the view may have changed.
void picture_both_sides(const Suite& suite, const RenderStats& all, const BiasResult& means, ViewResult& out);

}  // namespace crescent::inline comparison
