#include "obj.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "model.h"

namespace crescent::importer {

namespace {

/// Joins continued lines; the lines that were joined follow as empty ones, so that numbers of lines stay.
std::string normalised(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    std::string out;
    out.reserve(text.size());
    std::size_t owed = 0;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const bool is_end = text[k] == '\r' || text[k] == '\n';
        if (!is_end) {
            out += text[k];
            continue;
        }
        if (text[k] == '\r' && k + 1 < text.size() && text[k + 1] == '\n') ++k;
        if (out.ends_with('\\')) {
            out.back() = ' ';
            ++owed;
            continue;
        }
        out.append(owed + 1, '\n');
        owed = 0;
    }
    return out;
}

/// The largest index of a kind that is counted from the first, and its line: the element may follow.
struct Largest {
    std::int64_t index = 0;
    std::size_t line = 0;
};

constexpr std::array<const char*, 3> kinds = {"v", "vt", "vn"};

}  // namespace

std::string checked_obj(std::string text) {
    text = normalised(text);
    std::array<std::int64_t, 3> counts{};
    std::array<Largest, 3> largest{};
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
    for (std::size_t begin = 0; begin < text.size();) {
        ++line;
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view rest = std::string_view(text).substr(begin, end - begin);
        begin = end + 1;
        const auto next = [&rest] {
            const std::size_t from = std::min(rest.find_first_not_of(" \t"), rest.size());
            rest.remove_prefix(from);
            const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
            rest.remove_prefix(word.size());
            return word;
        };
        const std::string_view key = next();
        for (std::size_t kind = 0; kind < 3; ++kind) counts[kind] += key == kinds[kind];
        if (key != "f") continue;
        std::size_t corners = 0;
        for (std::string_view corner = next(); !corner.empty() && corner[0] != '#'; corner = next()) {
            if (++corners > most_corners)
                throw ModelError(fmt::format("line {}: expected a face of at most {} corners", line, most_corners));
            check_corner(corner, line);
        }
    }
    for (std::size_t kind = 0; kind < 3; ++kind)
        if (largest[kind].index > counts[kind])
            throw ModelError(fmt::format("line {}: the index {} of '{}', of which there are {}", largest[kind].line,
                largest[kind].index, kinds[kind], counts[kind]));
    return text;
}

}  // namespace crescent::importer
