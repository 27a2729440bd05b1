// Results as lines of JSON, appended one at a time: a run that is killed loses at most the case it was at.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/calibration/cases.h"
#include "tests/calibration/engine.h"

namespace crescent::calibration {

/// How a case was run, apart from what it is.
struct RunOf {
    std::string engine;
    bool full = false, pipe = false;
};

/// What distinguishes one line from another: set, seed, index, w_o, engine, mode, pipe.
std::string identity_of(const CaseKey& key, const RunOf& run);

nlohmann::ordered_json record_of(const CaseKey& key, const RunOf& run, const Case& c, const Result& result);

/// The lines of a file that are whole; a torn last line is dropped, from the file too if `repair`. Throws InputError
/// with file and line where another line cannot be read.
std::vector<nlohmann::ordered_json> read_records(const std::string& path, bool repair);
std::string identity_of(const nlohmann::ordered_json& record);

/// Appends one line by one write.
void append_record(const std::string& path, const nlohmann::ordered_json& record);

/// What an engine gave as causes of a case: how many texts, whether one names the cause, and others beside it do not.
/// Of a fault whose cause must not be named: whether one text is true of it, and others are not.
struct Causes {
    int given = 0;
    bool named = false, others = false;
};
Causes causes_of(const nlohmann::ordered_json& record);

/// The same as CSV, a line a case, without texts: what is committed. It is read back for tables.
std::string csv_of(const std::vector<nlohmann::ordered_json>& records);
std::vector<nlohmann::ordered_json> read_csv(const std::string& path);

}  // namespace crescent::calibration
