// The result of a suite as text: for machines, build servers, the summary page of a pull request and the terminal.
#pragma once

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "compare/suite/suite.h"
#include "report/report.h"

namespace crescent {

/// docs/suite.schema.json describes it; equal inputs give equal bytes.
std::string suite_json(const Suite& suite, const SuiteResult& result, bool new_baseline, const Provenance& provenance);
/// Results that are not "same" or "improved" in the Static Analysis Results Interchange Format 2.1.0, with the place of
/// the view in the suite file, for code hosts.
std::string suite_sarif(const Suite& suite, const SuiteResult& result, bool new_baseline, const Provenance& provenance);
/// One case for each view: changed, noisier, missing and new fail, unreadable and too few renders are errors; new is
/// skipped if `new_baseline` allows it.
std::string suite_junit(const Suite& suite, const SuiteResult& result, bool new_baseline);
/// One case: the call failed before there was a result.
std::string failure_junit(const std::string& file, const std::string& message);
/// The same in SARIF, with the places of an InputError that are in `file`. `version`: of crescent.
std::string failure_sarif(const std::string& version, const std::string& file, const std::exception& error);
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
