// Checks the values of an experiment file against their keys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiment/parser.h"
#include "experiment/schema.h"
#include "experiment/tree.h"

namespace crescent {

/// Returns "; did you mean 'phong'?", or nothing if no valid word is near.
std::string hint(std::string_view word, const std::vector<std::string>& valid);

/// Checks one value against its key; reports an error and returns false if it does not fit.
bool read_value(ParseContext& context, const Key& key, const Node& node, const std::string& path, Value& value);

}  // namespace crescent
