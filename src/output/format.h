// Numbers as text: exactly for machines, in four figures for people. No units; none are added.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace crescent::inline output {

/// The shortest decimal that reads back as the same double; "nan", "inf", "-inf" for what has no decimal.
std::string shortest(double x);

/// For reading: `digits` significant figures, whole numbers from 1000 on, "0.0001" as the smallest plain fraction and
/// an exponent below it. NaN and infinities by name.
std::string figures(double x, int digits = 4);

/// At most six significant figures and no trailing zeros: "3", "1.99966".
std::string compact(double x);

/// As figures(), but a metric that counts (fireflies) stays a whole number, or a half between two where it is a median.
std::string figures_of(std::string_view metric, double x);

/// A ratio or share in percent, "6.7 %"; at most `digits` significant figures.
std::string percent(double fraction, int digits = 3);

/// Code points in UTF-8 text: the columns it takes in a terminal where every character is one wide.
std::size_t width(std::string_view utf8);

/// At most `columns` code points; what was cut leaves an ellipsis in the middle.
std::string clip(std::string_view utf8, std::size_t columns);

/// Padded with blanks to `columns` code points, on the right or on the left; clipped where longer.
std::string left(std::string_view utf8, std::size_t columns);
std::string right(std::string_view utf8, std::size_t columns);

/// "1 sample", "64 samples".
std::string plural(std::uint64_t count, std::string_view noun);

// ---- JSON knows no NaN and no infinity. Here they are the strings "nan", "inf" and "-inf", so that a number which
// went wrong is read as such and never as an absent one (null).

using Json = nlohmann::ordered_json;

/// What stands in place of an interval that would mean nothing.
inline constexpr const char* heavy_tail = "heavy tail";

/// The one way a double enters a JSON of ours.
Json number(double x);
Json numbers(const std::vector<double>& all);

/// Two blanks of indent and a newline at the end; invalid UTF-8 in a name becomes U+FFFD.
std::string text(const Json& json);

// ---- Bytes as text in a data: address.

/// RFC 4648, section 4, with padding.
std::string base64(const std::vector<unsigned char>& bytes);

// ---- A field of a CSV file, RFC 4180.

/// Quoted where it holds a comma, a quote or a line's end; quotes are doubled.
inline std::string csv_field(std::string_view field) {
    if (field.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(field);
    std::string out = "\"";
    for (const char c : field) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

}  // namespace crescent::inline output
