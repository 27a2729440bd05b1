// A result as JSON, docs/check.schema.json, and back: what is stored is enough for its page.
#pragma once

#include <string>

#include "check/verdict.h"

namespace crescent {

/// The origin of a result; equal calls have equal ones.
struct ResultSource {
    std::string version, commit, command;
};

/// Equal calls give equal bytes: no times are in it.
std::string verdict_json(const CheckResult& result, const ResultSource& source = {});

/// What verdict_json() wrote.
struct StoredResult {
    CheckResult result;
    ResultSource source;
};
/// Throws InputError, with `name` for the file, if the text is something else.
StoredResult read_verdict_json(const std::string& text, const std::string& name);
/// The same of a text that is parsed.
StoredResult result_from_json(const nlohmann::ordered_json& json, const std::string& name);

}  // namespace crescent
