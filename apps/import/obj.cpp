// Lines are read as assimp reads them: what it would skip or misread without a word is corrected or refused here.
#include "obj.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "model.h"

namespace crescent::importer {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Whether a number begins behind this text, which may have its sign.
bool begins_number(std::string_view before) {
    if (before.ends_with('-') || before.ends_with('+')) before.remove_suffix(1);
    return !before.empty() && is_blank(before.back());
}

bool is_number(std::string_view word) { return number_in(word).has_value(); }

/// The box of the vertices, and whether one has a weight.
struct Extent {
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    bool has_weights = false;

    void add(const std::vector<std::string_view>& words) {
        has_weights = has_weights || words.size() == 4;
        std::size_t k = 0;
        for (const auto axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
            const double value = number_in(words[k++]).value_or(0);
            low.*axis = std::min(low.*axis, value);
            high.*axis = std::max(high.*axis, value);
        }
    }
    /// The middle, if it is more than a hundred extents away: single precision would leave fewer than
    /// 2^17 steps.
    Vec3d origin() const {
        double extent = 0, largest = 0;
        for (const auto axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
            extent = std::max(extent, high.*axis - low.*axis);
            largest = std::max({largest, std::fabs(low.*axis), std::fabs(high.*axis)});
        }
        if (has_weights || !std::isfinite(largest) || !(extent > 0) || largest <= 100 * extent) return {};
        return 0.5 * (low + high);
    }
};

/// The text with the numbers of its vertices relative to an origin.
std::string moved_to(Vec3d origin, std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view line = text.substr(begin, end - begin);
        begin = end + 1;
        if (line.starts_with("v ") || line.starts_with("v\t")) {
            out += 'v';
            line.remove_prefix(1);
            for (const double x : {origin.x, origin.y, origin.z}) {
                line.remove_prefix(line.find_first_not_of(" \t"));
                const std::string_view word = line.substr(0, line.find_first_of(" \t"));
                line.remove_prefix(word.size());
                out += fmt::format(" {:.17g}", number_in(word).value_or(0) - x);
            }
        }
        out += line;
        out += '\n';
    }
    return out;
}

/// Joins continued lines; the lines that were joined follow as empty ones, so that numbers of lines stay. A line that
/// begins with '#' is a comment and is not continued: it becomes empty. assimp skips a number without a digit before
/// its dot, and takes the next one: a vertex with .5 becomes one with 0.5.
std::string normalised(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    std::string out;
    out.reserve(text.size() + 1);
    std::size_t begin = 0, owed = 0;  // of the line in `out`; empty lines after it
    for (std::size_t k = 0; k <= text.size(); ++k) {
        const bool is_end = k == text.size() || text[k] == '\r' || text[k] == '\n';
        if (!is_end) {
            const bool is_indent = out.size() == begin && is_blank(text[k]);
            if (text[k] == '.' && out.size() > begin + 1 && out[begin] == 'v' && begins_number(out)) out += '0';
            if (!is_indent) out += text[k];
            continue;
        }
        if (k + 1 < text.size() && text[k] == '\r' && text[k + 1] == '\n') ++k;
        if (out.size() > begin && out[begin] == '#') out.resize(begin);
        if (out.size() > begin && out.back() == '\\' && k < text.size()) {
            out.back() = ' ';
            ++owed;
            continue;
        }
        out.append(owed + 1, '\n');
        owed = 0;
        begin = out.size();
    }
    return out;
}

/// The largest index of a kind that is counted from the first, and its line: the element may follow.
struct Largest {
    std::int64_t index = 0;
    std::size_t line = 0;
};

constexpr std::array<std::string_view, 3> kinds = {"v", "vt", "vn"};
constexpr std::array<std::size_t, 3> numbers_of = {3, 1, 3};
/// How many of so many numbers assimp reads: of v also a weight or a colour.
constexpr std::size_t read_of(std::size_t kind, std::size_t count) {
    if (kind != 0) return std::min<std::size_t>(count, 3);
    return count > 6 ? 6 : count == 5 ? 3 : count;
}

/// Of MTL: keys with numbers, and other ones. assimp refuses a file with others, and with words in place of numbers.
constexpr std::array<std::string_view, 14> keys_with_numbers = {
    "Ka", "Kd", "Ks", "Ke", "Tf", "Ns", "Ni", "d", "Tr", "illum", "Pr", "Pm", "Ps", "Pc"};
constexpr std::array<std::string_view, 6> other_keys = {"newmtl", "bump", "norm", "refl", "disp", "Pcr"};

}  // namespace

ObjText checked_obj(std::string_view file) {
    ObjText out{normalised(file), {}, {}};
    std::array<std::int64_t, 3> counts{};
    std::array<Largest, 3> largest{};
    std::size_t curves = 0, points_and_lines = 0;
    Extent extent;
    const auto check_corner = [&](std::string_view corner, std::size_t line) {
        for (std::size_t kind = 0; kind < 3 && !corner.empty(); ++kind) {
            const std::string_view word = corner.substr(0, corner.find('/'));
            corner.remove_prefix(std::min(word.size() + 1, corner.size()));
            if (word.empty()) continue;
            std::int64_t index = 0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
            if (error != std::errc{} || end != word.data() + word.size() || index == 0)
                throw ModelError(fmt::format("line {}: expected an index, not '{}'", line, word));
            if (index < -counts[kind])
                throw ModelError(fmt::format(
                    "line {}: the index {} of '{}', of which {} are above", line, index, kinds[kind], counts[kind]));
            if (index > largest[kind].index) largest[kind] = {index, line};
        }
    };
    std::size_t line = 0;
    for (std::size_t begin = 0; begin < out.text.size();) {
        ++line;
        const std::size_t end = std::min(out.text.find('\n', begin), out.text.size());
        std::string_view rest = std::string_view(out.text).substr(begin, end - begin);
        begin = end + 1;
        const auto next = [&rest] {
            rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
            const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
            rest.remove_prefix(word.size());
            return word;
        };
        const std::string_view key = next();
        curves += key == "curv" || key == "curv2" || key == "surf";
        if (key == "o" || key == "g") {
            // assimp ends a name at a blank.
            const std::size_t from = rest.find_first_not_of(" \t"), to = rest.find_last_not_of(" \t");
            if (from != rest.npos)
                for (std::size_t k = from; k < to; ++k)
                    if (rest[k] == ' ' || rest[k] == '\t')
                        out.text[static_cast<std::size_t>(rest.data() - out.text.data()) + k] = blank_of_name;
        }
        points_and_lines += key == "p" || key == "l";
        if (key == "mtllib") {
            const std::size_t from = std::min(rest.find_first_not_of(" \t"), rest.size());
            out.libraries.emplace_back(rest.substr(from, rest.find_last_not_of(" \t") + 1 - from));
        }
        const auto kind = static_cast<std::size_t>(std::ranges::find(kinds, key) - kinds.begin());
        if (kind == kinds.size() && key != "f") continue;
        // assimp takes a comment behind numbers for more of them.
        if (const std::size_t comment = rest.find('#'); comment != rest.npos) {
            std::fill_n(out.text.begin() + static_cast<std::ptrdiff_t>(end - rest.size() + comment),
                rest.size() - comment, ' ');
            rest = rest.substr(0, comment);
        }
        if (kind < kinds.size()) {
            ++counts[kind];
            std::vector<std::string_view> words;
            for (std::string_view word = next(); !word.empty(); word = next()) words.push_back(word);
            if (words.size() < numbers_of[kind] || !std::ranges::all_of(words, is_number))
                throw ModelError(fmt::format("line {}: expected {} numbers after '{}'", line, numbers_of[kind], key));
            if (kind == 0) extent.add(words);
            // assimp skips a line with another count.
            const std::size_t kept = read_of(kind, words.size());
            if (kept < words.size())
                std::fill(out.text.begin() + (words[kept].data() - out.text.data()),
                    out.text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
            continue;
        }
        std::size_t corners = 0;
        for (std::string_view corner = next(); !corner.empty(); corner = next()) {
            if (++corners > most_corners)
                throw ModelError(fmt::format("line {}: expected a face of at most {} corners", line, most_corners));
            check_corner(corner, line);
        }
    }
    for (std::size_t kind = 0; kind < 3; ++kind)
        if (largest[kind].index > counts[kind])
            throw ModelError(fmt::format("line {}: the index {} of '{}', of which there are {}", largest[kind].line,
                largest[kind].index, kinds[kind], counts[kind]));
    if (curves > 0) out.left_out.push_back(fmt::format("{} curves and surfaces", curves));
    if (points_and_lines > 0) out.left_out.push_back(fmt::format("{} points and lines", points_and_lines));
    out.origin = extent.origin();
    if (dot(out.origin, out.origin) > 0) out.text = moved_to(out.origin, out.text);
    return out;
}

std::string checked_mtl(std::string_view file, std::vector<std::string>& left_out) {
    std::string out = normalised(file);
    std::map<std::string, std::size_t, std::less<>> removed;
    for (std::size_t begin = 0; begin < out.size();) {
        const std::size_t end = std::min(out.find('\n', begin), out.size());
        const std::string_view line = std::string_view(out).substr(begin, end - begin);
        const std::size_t key_end = std::min(line.find_first_of(" \t"), line.size());
        const std::string_view key = line.substr(0, key_end);
        const std::size_t first = std::min(line.find_first_not_of(" \t", key_end), line.size());
        const std::string_view word = line.substr(first, line.find_first_of(" \t", first) - first);
        const bool has_numbers = std::ranges::find(keys_with_numbers, key) != keys_with_numbers.end();
        const bool is_known = has_numbers
            ? is_number(word)
            : key.empty() || key.starts_with("map_") || std::ranges::find(other_keys, key) != other_keys.end();
        if (!is_known) {
            ++removed[has_numbers ? fmt::format("{} {}", key, word) : std::string(key)];
            std::fill(
                out.begin() + static_cast<std::ptrdiff_t>(begin), out.begin() + static_cast<std::ptrdiff_t>(end), ' ');
        }
        begin = end + 1;
    }
    for (const auto& [what, count] : removed)
        left_out.push_back(fmt::format("'{}' of {} material{}", what, count, count == 1 ? "" : "s"));
    return out;
}

}  // namespace crescent::importer
