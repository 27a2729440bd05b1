// Which renders of two arms were made with the same random numbers: those with the same number in their names.
#include <fmt/format.h>

#include <algorithm>

#include "compare/judge.h"

namespace crescent::inline comparing {

namespace {

/// Numbers of a file's name that are not the same in all files of its arm: what tells its render.
std::vector<std::uint64_t> own_numbers(const ArmReadings& arm, std::size_t file) {
    std::vector<std::uint64_t> out;
    const auto& own = arm.files[file].numbers;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const bool varies = std::any_of(arm.files.begin(), arm.files.end(),
            [&](const RenderFile& f) { return f.numbers.size() != own.size() || f.numbers[i] != own[i]; });
        if (varies) out.push_back(own[i]);
    }
    return out.empty() ? own : out;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> pairs_of(const ArmReadings& a, const ArmReadings& b) {
    std::vector<std::vector<std::uint64_t>> theirs;
    for (std::size_t j = 0; j < b.files.size(); ++j) theirs.push_back(own_numbers(b, j));
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (std::size_t i = 0; i < a.files.size(); ++i) {
        const std::vector<std::uint64_t> own = own_numbers(a, i);
        const auto found = std::count(theirs.begin(), theirs.end(), own);
        if (found != 1 || own.empty())
            throw InputError({a.files[i].path, 0, 0},
                own.empty()
                    ? "--pair: expected a number in its name"
                    : fmt::format(
                          "--pair: expected one render of the other arm with the number {} in its name, found {}",
                          fmt::join(own, ", "), found));
        out.emplace_back(i, static_cast<std::size_t>(std::find(theirs.begin(), theirs.end(), own) - theirs.begin()));
    }
    if (out.size() != b.files.size())
        throw InputError({b.files[0].path, 0, 0}, "--pair: expected as many renders of one arm as of the other");
    return out;
}

}  // namespace crescent::inline comparing
