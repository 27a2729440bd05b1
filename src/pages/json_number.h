// JSON knows no NaN and no infinity. Here they are the strings "nan", "inf" and "-inf", so that a number which went
// wrong is read as such and never as an absent one (null).
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace crescent::inline pages {

using Json = nlohmann::ordered_json;

/// What stands in place of an interval that would mean nothing.
inline constexpr const char* heavy_tail = "heavy tail";

/// The one way a double enters a JSON of ours.
Json number(double x);
Json numbers(const std::vector<double>& all);

/// Two blanks of indent and a newline at the end; invalid UTF-8 in a name becomes U+FFFD.
std::string text(const Json& json);

}  // namespace crescent::inline pages
