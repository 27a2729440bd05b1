// Kinds of warnings in the order in which they come.
#include "compare/file_warnings.h"

#include <fmt/format.h>

#include <algorithm>

namespace crescent::inline comparing {

void FileWarnings::add(
    const std::string& file, const std::string& text, std::uint64_t pixels, const std::string& kind) {
    const std::string& key = kind.empty() ? text : kind;
    auto at = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& k) { return k.kind == key; });
    if (at == kinds_.end()) at = kinds_.insert(kinds_.end(), {key, file, text, 0, pixels, pixels});
    ++at->files;
    at->fewest = std::min(at->fewest, pixels), at->most = std::max(at->most, pixels);
}

std::vector<std::string> FileWarnings::lines() const {
    std::vector<std::string> out;
    for (const Kind& k : kinds_) {
        const std::string file = k.files > 1 ? fmt::format("{} (the first of {} files)", k.file, k.files) : k.file;
        const std::string pixels = k.most == 0 ? ""
            : k.fewest == k.most               ? fmt::format("{} pixel{} ", k.most, k.most == 1 ? "" : "s")
                                               : fmt::format("{} to {} pixels ", k.fewest, k.most);
        out.push_back(fmt::format("{}: {}{}", file, pixels, k.text));
    }
    return out;
}

}  // namespace crescent::inline comparing
