// One line per mistake, "file:line:column: message". nearest() takes the word with the least edit distance (Levenshtein
// 1966, ignoring case): at most 2 or a third of the word's letters, whichever is more, and always below its length.
#include "base/errors.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>

namespace crescent {

namespace {

std::string join(const std::vector<Diagnostic>& diagnostics) {
    std::string text;
    for (const Diagnostic& c : diagnostics) {
        if (!text.empty()) text += '\n';
        const std::string place = printable(to_string(c.location));
        text += place.empty() ? c.message : place + ": " + c.message;
    }
    return text;
}

/// Levenshtein 1966: fewest insertions, deletions and substitutions that turn a into b, ignoring case.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const bool is_equal =
                std::tolower(static_cast<unsigned char>(a[i])) == std::tolower(static_cast<unsigned char>(b[j]));
            const std::size_t best = std::min({row[j] + 1, row[j + 1] + 1, diagonal + (is_equal ? 0 : 1)});
            diagonal = row[j + 1];
            row[j + 1] = best;
        }
    }
    return row[b.size()];
}

}  // namespace

std::string to_string(const SourceLocation& place) {
    if (place.line == 0) return place.file;
    return fmt::format("{}:{}:{}", place.file, place.line, place.column);
}

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::invalid_argument(join(diagnostics)), diagnostics_(std::move(diagnostics)) {}

OutputError not_built(std::string_view part) {
    return OutputError(fmt::format("{} is not built yet: ./build-all in the folder of the sources builds it", part));
}

Bug::Bug(const std::source_location& place, std::string_view claim)
    : std::logic_error(fmt::format("{}:{}: internal check failed: {}", place.file_name(), place.line(), claim)) {}

std::string nearest(std::string_view word, const std::vector<std::string>& valid) {
    std::string best;
    std::size_t best_distance = std::min(std::max<std::size_t>(2, word.size() / 3) + 1, word.size());
    for (const std::string& candidate : valid) {
        const std::size_t d = edit_distance(word, candidate);
        if (d < best_distance) {
            best_distance = d;
            best = candidate;
        }
    }
    return best;
}

}  // namespace crescent
