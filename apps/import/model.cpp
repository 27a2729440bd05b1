// Files of a model and of what it names: regular ones, in its folder; numbers in them.
#include "model.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>

#include "lines.h"

namespace crescent::importer {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& file) {
    std::error_code unknown;
    if (!fs::is_regular_file(file, unknown)) throw ModelError(file.string() + ": expected a regular file");
    std::ifstream in(file, std::ios::binary);
    std::string out(fs::file_size(file), '\0');
    in.read(out.data(), static_cast<std::streamsize>(out.size()));
    if (!in) throw ModelError(file.string() + ": cannot be read");
    return out;
}

std::string lower_extension(const fs::path& file) { return lower_case(file.extension().string()); }

std::optional<double> number_in(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double out = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
    if (error == std::errc::invalid_argument || end != word.data() + word.size()) return std::nullopt;
    // from_chars does not give what is beyond.
    return error == std::errc::result_out_of_range ? std::strtod(std::string(word).c_str(), nullptr) : out;
}

bool is_inside(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    const fs::path outer = fs::weakly_canonical(fs::absolute(folder), error);
    const fs::path path = fs::weakly_canonical(fs::absolute(file), error);
    const auto end = std::mismatch(outer.begin(), outer.end(), path.begin(), path.end()).first;
    return !error && (end == outer.end() || end->empty());
}

std::optional<FoundFile> file_named(std::string_view name, std::span<const fs::path> folders, const fs::path& outer) {
    std::string with_slashes(name);
    std::ranges::replace(with_slashes, '\\', '/');
    const auto find_path = [&](const fs::path& path) -> std::optional<fs::path> {
        std::error_code ignored;
        for (const fs::path& folder : folders)
            if (const fs::path file = folder / path; fs::is_regular_file(file, ignored) && is_inside(outer, file))
                return file;
        return std::nullopt;
    };
    if (name.empty() || name.find('\0') != name.npos) return std::nullopt;
    for (const fs::path& path : {fs::path(name), fs::path(with_slashes)})
        if (auto file = find_path(path)) return FoundFile{*std::move(file)};
    if (auto file = find_path(fs::path(with_slashes).filename())) return FoundFile{*std::move(file), true};
    return std::nullopt;
}

void count_kind(Kinds& kinds, const std::string& name) {
    constexpr std::size_t most_kinds = 50, longest = 60;
    const auto entry = kinds.find(name);
    if (entry != kinds.end()) ++entry->second;
    else ++kinds[kinds.size() < most_kinds && name.size() <= longest ? name : other_kinds];
}

std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t most_names = 3;
    std::string out;
    for (std::size_t k = 0; k < std::min(names.size(), most_names); ++k)
        out += (k > 0 ? ", '" : "'") + names[k].substr(0, 100) + "'";
    if (names.size() > most_names) out += fmt::format(" and {} more", names.size() - most_names);
    return out;
}

}  // namespace crescent::importer
