// Numbers as text: exact for machines, four significant figures for people. Without units.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace crescent {

/// Returns the shortest decimal that reads back as the same double; "nan", "inf", "-inf" for the rest.
std::string shortest(double x);

/// For reading: `digits` significant figures, integers from 1000 on, "0.0001" as the smallest plain fraction and an
/// exponent below it. NaN and infinities by name.
std::string figures(double x, int digits = 4);

/// At most six significant figures and no trailing zeros: "3", "1.99966".
std::string compact(double x);

/// Like figures(), but a metric that counts (fireflies) stays an integer, or ends in a half for a median between two.
std::string figures_of(std::string_view metric, double x);
/// The same; an RMSE that is NaN is "below ref." if the reference is paired.
std::string figures_of(std::string_view metric, double x, bool paired);

/// A ratio or share in percent, "6.7 %"; at most `digits` significant figures.
std::string percent(double fraction, int digits = 3);

/// "0.9754 +- 0.0002": the half width of the interval with one digit, or two if the first is 1, and the value to the
/// same place.
std::string with_error(double value, double half);
/// "12.3 % +- 0.4 %" for shares.
std::string percent_with_error(double share, double half);

/// "(0.5, 0, 0.866)".
std::string direction_text(Vec3<double> w);

/// Returns the code points in UTF-8 text: its columns in a terminal if every character is one wide.
std::size_t width(std::string_view utf8);

/// Returns at most `columns` code points; removed text is replaced by an ellipsis in the middle.
std::string clip(std::string_view utf8, std::size_t columns);

/// Pads with blanks to `columns` code points, on the right or on the left; clips longer text.
std::string left(std::string_view utf8, std::size_t columns);
std::string right(std::string_view utf8, std::size_t columns);

/// With a true minus sign before digits.
std::string with_minus(std::string_view text);
/// The number of a cell of a table, with_minus(); an en dash if there is none.
std::string cell_text(std::string_view text);

/// "a, b and c".
std::string listed(const std::vector<std::string>& items);

/// "1 sample", "64 samples".
std::string plural(std::uint64_t count, std::string_view noun);

// ---- JSON has no NaN and no infinity: they are the strings "nan", "inf" and "-inf", so that an invalid number is
// never read as a missing one (null).

using Json = nlohmann::ordered_json;

/// Replaces an interval that would be meaningless.
inline constexpr const char* heavy_tail = "heavy tail";

/// Used for every double in a JSON file.
Json number(double x);
Json numbers(const std::vector<double>& values);
/// Reads what number() made. Throws Json::exception.
double read_number(const Json& json);
/// The objects of a list that reads "a, b and c": each with the `separator` after it.
Json separated(std::vector<Json> objects);

/// Parses at most 64 levels of arrays and objects, since what reads or compares them is recursive. Throws
/// Json::exception.
Json parse_json(const std::string& text);
/// The same of a file. Throws InputError with its `name`: "expected {what}: ...".
Json parse_json(const std::string& text, const std::string& name, std::string_view what);

/// Indents by two blanks and ends with a newline; invalid UTF-8 in a name becomes U+FFFD.
std::string text(const Json& json);

// ---- Bytes as text in a data: address.

/// RFC 4648, section 4, with padding.
std::string base64(const std::vector<unsigned char>& bytes);

// ---- A field of a CSV file, RFC 4180.

/// Quoted if it contains a comma, a quote or a line end; quotes are doubled.
inline std::string csv_field(std::string_view field) {
    if (field.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(field);
    std::string out = "\"";
    for (const char c : field) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

}  // namespace crescent
