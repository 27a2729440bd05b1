// Results as lines of JSON, appended one at a time: an interrupted run loses at most one case.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/calibration/cases.h"
#include "tests/calibration/engine.h"

namespace crescent::calibration {

/// How a case was run.
struct RunOf {
    std::string engine;
    bool full = false, pipe = false;
};

/// The identity of a line: set, seed, index, w_o, engine, mode, pipe.
std::string identity_of(const CaseKey& key, const RunOf& run);

nlohmann::ordered_json record_of(const CaseKey& key, const RunOf& run, const Case& c, const Result& result);

/// The complete lines of a file; an incomplete last line is dropped, with `repair` from the file too. Throws InputError
/// with file and line if another line cannot be read.
std::vector<nlohmann::ordered_json> read_records(const std::string& path, bool repair);
std::string identity_of(const nlohmann::ordered_json& record);

/// Appends one line with a single write.
void append_record(const std::string& path, const nlohmann::ordered_json& record);

/// The causes that an engine gave for a case: the number of texts, whether one names the cause, and whether others do
/// not. For a fault without a cause that must be named: whether one text is true, and whether others are not.
struct Causes {
    int given = 0;
    bool named = false, others = false;
};
Causes causes_of(const nlohmann::ordered_json& record);

/// The records as CSV, one line for each case, without texts, for version control. It can be read back for tables.
std::string csv_of(const std::vector<nlohmann::ordered_json>& records);
std::vector<nlohmann::ordered_json> read_csv(const std::string& path);

}  // namespace crescent::calibration
