// The table of an experiment file, or of another file, as a JSON Schema.
#pragma once

#include <string>

#include "experiment/schema.h"

namespace crescent {

/// Returns the table as a JSON Schema, draft 7, under this title.
std::string json_schema_of(const Section& root, const char* title);

/// Returns the table of an experiment file as such a schema.
std::string schema_json();

}  // namespace crescent
