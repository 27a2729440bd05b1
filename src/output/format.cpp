// shortest() is std::to_chars(); the others are rounded by {fmt}, figures() to the decimals that the number's power of
// ten leaves. Code points are counted by the bytes that begin one in UTF-8.
#include "output/format.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"
#include "math/functions.h"
#include "output/stored_json.h"

namespace crescent {
namespace {

bool starts_code_point(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

/// Returns the offset of code point number `count`.
std::size_t offset_of(std::string_view text, std::size_t count) {
    std::size_t index = 0;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (starts_code_point(text[i]) && index++ == count) return i;
    return text.size();
}

}  // namespace

std::string shortest(double x) {
    if (std::isnan(x)) return "nan";
    if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, x);
    return {text, end.ptr};
}

std::string figures(double x, int digits) {
    if (!std::isfinite(x)) return shortest(x);
    if (x == 0) return "0";
    const double size = std::fabs(x);
    if (size < 1e-4 || size >= 1e9) return fmt::format("{:.{}e}", x, std::max(0, digits - 2));
    const std::string rounded = fmt::format("{:.{}e}", size, digits - 1);  // 9.99996 is 1.000e+01 to four figures
    const int power = std::stoi(rounded.substr(rounded.find('e') + 1));
    return fmt::format("{:.{}f}", x, size >= 1000 || power >= 3 ? 0 : std::max(0, digits - 1 - power));
}

std::string compact(double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x) : shortest(x); }

std::string figures_of(std::string_view metric, double x) {
    if (metric == "fireflies" && std::isfinite(x))
        return fmt::format("{}", 2 * x == std::floor(2 * x) ? x : std::round(x));
    return figures(x);
}

std::string figures_of(std::string_view metric, double x, bool paired) {
    return paired && std::isnan(x) && metric.starts_with("rmse") ? "below ref." : figures_of(metric, x);
}

std::string percent(double fraction, int digits) {
    if (!std::isfinite(fraction)) return shortest(fraction);
    const double value = 100 * fraction;
    const std::string text = fmt::format("{:.{}g}", value, digits);
    constexpr double longest = 1e9;  // from here on a power of ten is easier to read
    const bool is_whole = text.find("e+") != std::string::npos && std::fabs(value) < longest;
    return (is_whole ? fmt::format("{:.0f}", value) : text) + " %";
}

namespace {

/// "2.61 +- 0.02" with a unit behind each number; a value alone if its error is not known.
std::string with_error_and_unit(double value, double half, std::string_view unit) {
    if (!(half > 0) || !std::isfinite(half)) return fmt::format("{:.5g}{}", value, unit);
    const double exponent = std::floor(math::log10(half) + 1e-9);
    const int digits = -static_cast<int>(exponent) + (half < 1.95 * math::pow(10, exponent) ? 1 : 0);
    if (digits > 12 || digits < -3) return fmt::format("{:.5g}{} +- {:.1g}{}", value, unit, half, unit);
    const int decimals = std::max(digits, 0);
    return fmt::format("{:.{}f}{} +- {:.{}f}{}", value, decimals, unit, half, decimals, unit);
}

}  // namespace

std::string with_error(double value, double half) { return with_error_and_unit(value, half, ""); }

std::string percent_with_error(double share, double half) { return with_error_and_unit(100 * share, 100 * half, " %"); }

std::string direction_text(Vec3<double> w) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", w.x, w.y, w.z); }

std::size_t width(std::string_view utf8) {
    return static_cast<std::size_t>(std::count_if(utf8.begin(), utf8.end(), starts_code_point));
}

std::string clip(std::string_view utf8, std::size_t columns) {
    const std::size_t text_width = width(utf8);
    if (text_width <= columns) return std::string(utf8);
    if (columns == 0) return {};
    const std::size_t head = (columns - 1) / 2, tail = columns - 1 - head;
    return std::string(utf8.substr(0, offset_of(utf8, head))) + "…" +
        std::string(utf8.substr(offset_of(utf8, text_width - tail)));
}

std::string left(std::string_view utf8, std::size_t columns) {
    const std::string text = clip(utf8, columns);
    return text + std::string(columns - width(text), ' ');
}

std::string right(std::string_view utf8, std::size_t columns) {
    const std::string text = clip(utf8, columns);
    return std::string(columns - width(text), ' ') + text;
}

std::string with_minus(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_minus = text[i] == '-' && i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
        out += is_minus ? "−" : std::string(1, text[i]);
    }
    return out;
}

std::string cell_text(std::string_view text) { return text.empty() ? "–" : with_minus(text); }

namespace {

/// What follows item `i` of `count` in "a, b and c".
const char* separator(std::size_t i, std::size_t count) { return i + 2 < count ? ", " : i + 2 == count ? " and " : ""; }

}  // namespace

std::string listed(const std::vector<std::string>& items) {
    std::string out;
    for (std::size_t i = 0; i < items.size(); ++i) out += items[i] + separator(i, items.size());
    return out;
}

std::string plural(std::uint64_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

// ---- Finite doubles are written as JSON numbers, others as the words of shortest(), by nlohmann::json.

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(shortest(x)); }

Json numbers(const std::vector<double>& values) {
    Json out = Json::array();
    for (const double x : values) out.push_back(number(x));
    return out;
}

Json separated(std::vector<Json> objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) objects[i]["separator"] = separator(i, objects.size());
    return objects;
}

double read_number(const Json& json) {
    if (!json.is_string()) return json.get<double>();
    for (const double x : {HUGE_VAL, -HUGE_VAL, std::nan("")})
        if (json == number(x)) return x;
    throw Json::type_error::create(302, "expected a number, \"nan\", \"inf\" or \"-inf\"", &json);
}

Json parse_json(const std::string& text) {
    constexpr int deepest = 64;
    return Json::parse(text, [](int depth, Json::parse_event_t, const Json& value) {
        if (depth > deepest) throw Json::other_error::create(501, "values that are nested too deep", &value);
        return true;
    });
}

Json parse_json(const std::string& text, const std::string& name, std::string_view what) {
    try {
        return parse_json(text);
    } catch (const Json::exception& error) {
        throw InputError({name, 0, 0}, fmt::format("expected {}: {}", what, unreadable_json(error)));
    }
}

std::string text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

// ---- Three bytes make 24 bits and four digits; one or two left over make two or three digits, padded with "=".

std::string base64(const std::vector<unsigned char>& bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out((bytes.size() + 2) / 3 * 4, '=');
    char* to = out.data();
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t remaining = std::min<std::size_t>(3, bytes.size() - i);
        const unsigned word =
            bytes[i] << 16 | (remaining > 1 ? bytes[i + 1] << 8 : 0) | (remaining > 2 ? bytes[i + 2] : 0);
        for (std::size_t k = 0; k <= remaining; ++k) to[k] = digits[word >> (18 - 6 * k) & 63];
        to += 4;
    }
    return out;
}

// ---- One <testsuites> around one <testsuite>: counts by state, properties, then the cases in their order. Times are
// in seconds to a thousandth and are written only if a case has one; a suite's is their sum.

}  // namespace crescent
