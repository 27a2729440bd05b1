// Checks one TOML value against one key of the table: type, count, range, finite numbers, unit vectors, order.
#include "experiment/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "experiment/parser.h"
#include "experiment/tree.h"
#include "math/functions.h"

namespace crescent {

namespace {

constexpr double unit_tolerance = 1e-4;  // rounding error of a unit vector written with four decimals
constexpr double unit_rounding = 4 * std::numeric_limits<double>::epsilon();  // after the division by the length
constexpr std::size_t longest_list = 64;
constexpr std::size_t longest_text = 4096;

bool is_number(const Node& node) { return node.kind == Node::Kind::number || node.kind == Node::Kind::integer; }

/// Returns how many numbers the type has; 0: a list of any length.
std::size_t count_of(Type type) {
    if (type == Type::box) return 4;
    if (type == Type::matrix) return 12;
    return type == Type::numbers || type == Type::integers || type == Type::counts ? 0 : 3;
}

class ValueReader {
public:
    ValueReader(ParseContext& context, const Key& key, const std::string& path, Value& value)
        : draft_(context), key_(key), path_(path), value_(value) {}

    bool read(const Node& node) {
        switch (key_.type) {
            case Type::text:
            case Type::check:
            case Type::sampler:
            case Type::arm:
            case Type::shape: return text(node);
            case Type::texts: return texts(node);
            case Type::formulas: return formulas(node);
            case Type::word: return word(node);
            case Type::flag: return flag(node);
            case Type::integer:
            case Type::number: return scalar(node, value_.number);
            case Type::direction: return list(node) && unit();
            case Type::box: return list(node) && box();
            case Type::numbers:
            case Type::integers: return list(node) && ascending(node);
            case Type::counts: return list(node);
            case Type::point:
            case Type::factors:
            case Type::matrix:
            case Type::color:
            case Type::gray: return list(node);
        }
        return false;
    }

private:
    bool fail(const Node& node, const std::string& detail = "") {
        draft_.report(path_, node.location,
            fmt::format("{}: expected {}, found {}{}", path_, expectation(key_), describe(node), detail));
        return false;
    }
    bool fail(const std::string& message) {
        draft_.report(path_, fmt::format("{}: {}", path_, message));
        return false;
    }

    bool text(const Node& node) {
        if (node.kind != Node::Kind::text) return fail(node);
        if (node.text.size() > longest_text)
            return fail(fmt::format("expected at most {} bytes, found {}", longest_text, node.text.size()));
        const bool has_control =
            std::any_of(node.text.begin(), node.text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
        if (has_control) return fail("expected one line of text without control characters");
        value_.text = node.text;
        return true;
    }

    bool texts(const Node& node) {
        if (node.kind == Node::Kind::text) return text(node) && (value_.texts = {value_.text}, true);
        if (!node.is_array() || node.members.empty() || node.members.size() > longest_list * longest_list)
            return fail(node);
        for (const Member& member : node.members) {
            if (!text(member.value)) return false;
            value_.texts.push_back(value_.text);
        }
        return true;
    }

    /// A number becomes its shortest text.
    bool formulas(const Node& node) {
        if (!node.is_array() || node.members.empty() || node.members.size() > longest_list) return fail(node);
        for (const Member& member : node.members) {
            if (is_number(member.value)) value_.texts.push_back(fmt::format("{}", member.value.number));
            else if (text(member.value)) value_.texts.push_back(value_.text);
            else return false;
        }
        return true;
    }

    bool word(const Node& node) {
        const auto it = std::find(key_.words.begin(), key_.words.end(), node.text);
        if (node.kind != Node::Kind::text || it == key_.words.end())
            return fail(node, node.kind == Node::Kind::text ? hint(node.text, key_.words) : "");
        value_.word = static_cast<int>(it - key_.words.begin());
        value_.flag = value_.word != 0;
        value_.text = node.text;
        return true;
    }

    bool flag(const Node& node) {
        if (node.kind != Node::Kind::flag) return fail(node);
        value_.flag = node.flag;
        return true;
    }

    bool scalar(const Node& node, double& to) {
        const bool is_whole = key_.type == Type::integer || key_.type == Type::integers || key_.type == Type::counts ||
            key_.type == Type::box;
        if (is_whole ? node.kind != Node::Kind::integer : !is_number(node)) return fail(node);
        if (!std::isfinite(node.number)) return fail(node, "; numbers are finite");
        const bool has_range =
            key_.type != Type::box && key_.type != Type::direction;  // these two are checked as a whole
        if (has_range && !key_.range.holds(node.number)) return fail(node);
        to = node.number;
        return true;
    }

    bool list(const Node& node) {
        const std::size_t count = count_of(key_.type);
        if ((count == 0 || key_.type == Type::gray || key_.type == Type::factors) && is_number(node)) {
            value_.numbers.resize(1);
            return scalar(node, value_.numbers[0]);
        }
        if (!node.is_array() || (count != 0 && node.members.size() != count) || node.members.empty()) return fail(node);
        if (node.members.size() > longest_list) return fail(node, fmt::format("; at most {} are taken", longest_list));
        value_.numbers.resize(node.members.size());
        bool is_good = true;
        for (std::size_t i = 0; i < value_.numbers.size(); ++i)
            is_good = scalar(node.members[i].value, value_.numbers[i]) && is_good;
        return is_good;
    }

    bool ascending(const Node& node) {
        for (std::size_t i = 1; i < value_.numbers.size(); ++i) {
            const double previous = value_.numbers[i - 1], current = value_.numbers[i];
            if (current > previous) continue;
            draft_.report(path_, node.members[i].value.location,
                fmt::format("{}: expected {}, found {} after {}", path_, expectation(key_),
                    current == previous ? fmt::format("{} again", current) : fmt::format("{}", current), previous));
            return false;
        }
        return true;
    }

    bool unit() {
        std::vector<double>& v = value_.numbers;
        const double length = math::hypot(v[0], v[1], v[2]);
        if (length == 0) return fail("expected a unit vector, found the zero vector");
        if (std::abs(length - 1) <= unit_rounding) return true;  // a second reading does not change it
        if (std::abs(length - 1) > unit_tolerance)
            return fail(
                fmt::format("expected a unit vector, found length {:.6g}; the unit vector is [{:.6g}, {:.6g}, {:.6g}]",
                    length, v[0] / length, v[1] / length, v[2] / length));
        for (double& x : v) x /= length;
        return true;
    }

    bool box() {
        const std::vector<double>& v = value_.numbers;
        if (!std::all_of(v.begin(), v.end(), [&](double x) { return key_.range.holds(x); }))
            return fail(fmt::format("expected pixels {}, found [{}]", to_string(key_.range), listed(v)));
        for (int axis = 0; axis < 2; ++axis) {
            const auto low = static_cast<std::size_t>(axis), high = low + 2;
            if (v[high] < v[low])
                return fail(
                    fmt::format("expected [x0, y0, x1, y1] with {0}0 <= {0}1, found {0}0 = {1} and {0}1 = {2}: {3}",
                        axis ? 'y' : 'x', v[low], v[high], v[high] + 1 == v[low] ? "an empty box" : "an inverted box"));
        }
        return true;
    }

    ParseContext& draft_;
    const Key& key_;
    const std::string& path_;
    Value& value_;
};

/// Returns whether other renderers have this word and crescent does not support it yet.
bool is_beyond(std::string_view word) {
    constexpr std::string_view words[] = {"mesh", "triangle", "ply", "obj", "texture", "bitmap", "envmap",
        "environment", "hdri", "infinite", "glass", "dielectric", "conductor", "mirror", "plastic", "ior", "eta",
        "roughness", "transmission", "volume", "medium", "curve", "instance", "lens", "emission"};
    return std::ranges::any_of(words, [&](std::string_view w) { return word.starts_with(w); });
}

}  // namespace

std::string hint(std::string_view word, const std::vector<std::string>& valid) {
    if (const std::string suggestion = did_you_mean(word, valid); !suggestion.empty()) return suggestion;
    return is_beyond(word) ? "; README.md says what a scene can be" : "";
}

bool read_value(ParseContext& context, const Key& key, const Node& node, const std::string& path, Value& value) {
    return ValueReader(context, key, path, value).read(node);
}

}  // namespace crescent
