// Lines are read as assimp reads them: what it would skip or misread without a word is corrected or refused here.
#include "obj.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "model.h"

namespace crescent::importer {

namespace {

/// Joins continued lines; the lines that were joined follow as empty ones, so that numbers of lines stay. A line that
/// begins with '#' is a comment and is not continued: it becomes empty.
std::string normalised(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    std::string out;
    out.reserve(text.size() + 1);
    std::size_t begin = 0, owed = 0;  // of the line in `out`; empty lines after it
    for (std::size_t k = 0; k <= text.size(); ++k) {
        const bool is_end = k == text.size() || text[k] == '\r' || text[k] == '\n';
        if (!is_end) {
            const bool is_indent = out.size() == begin && (text[k] == ' ' || text[k] == '\t');
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

}  // namespace

ObjText checked_obj(std::string_view file) {
    ObjText out{normalised(file), {}, {}};
    std::array<std::int64_t, 3> counts{};
    std::array<Largest, 3> largest{};
    std::size_t curves = 0, points_and_lines = 0;
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
            for (std::size_t k = 0; k < numbers_of[kind]; ++k) {
                const std::string_view word = next();
                const std::size_t sign = word.starts_with('-') || word.starts_with('+') ? 1 : 0;
                const bool is_number =
                    sign < word.size() && std::string_view("0123456789.nNiI").find(word[sign]) != word.npos;
                if (!is_number)
                    throw ModelError(
                        fmt::format("line {}: expected {} numbers after '{}'", line, numbers_of[kind], key));
            }
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
    return out;
}

}  // namespace crescent::importer
