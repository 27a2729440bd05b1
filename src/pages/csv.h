// A field of a CSV file, RFC 4180.
#pragma once

#include <string>
#include <string_view>

namespace crescent::inline pages {

/// Quoted where it holds a comma, a quote or a line's end; quotes are doubled.
inline std::string csv_field(std::string_view field) {
    if (field.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(field);
    std::string out = "\"";
    for (const char c : field) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

}  // namespace crescent::inline pages
