// The result of a suite as text: for machines, build servers, the summary page of a pull request and the terminal.
#pragma once

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "compare/suite/suite.h"
#include "output/test_report.h"
#include "report/report.h"

namespace crescent {

/// docs/suite.schema.json describes it; equal inputs give equal bytes.
std::string suite_json(const Suite& suite, const SuiteResult& result, bool new_baseline, const Provenance& provenance);
/// One case for each view: changed, noisier, missing and new fail, unreadable and too few renders are errors; new is
/// skipped if `new_baseline` allows it. Annotations are at the place of the view in the suite file.
TestReport suite_report(
    const Suite& suite, const SuiteResult& result, bool new_baseline, const std::string& version = "");
/// One case: the call failed before there was a result. Annotations have the places of an InputError that are in
/// `file`.
TestReport failure_report(const std::string& file, const std::exception& error, const std::string& version = "");
/// A table of all views that are not the same, at most 60 kB.
std::string suite_markdown(const Suite& suite, const SuiteResult& result, const Provenance& provenance);
std::string suite_summary(const Suite& suite, const SuiteResult& result);
/// One page that works offline.
std::string suite_html(const Suite& suite, const SuiteResult& result, const Provenance& provenance);

/// The pictures of the views that are not the same or improved, as "plates/1-VIEW-difference.png", worst views first.
std::vector<std::pair<std::string, std::vector<unsigned char>>> suite_plates(const SuiteResult& result);

/// Views in the order of their states, changed first, then by the size of what changed, then by name.
std::vector<const ViewResult*> by_state(const SuiteResult& result);

}  // namespace crescent
