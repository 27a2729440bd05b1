// Files of a model and of what it names: regular ones, in its folder; numbers in them.
#include "model.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <fstream>

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

std::string lower_extension(const fs::path& file) {
    std::string out = file.extension().string();
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

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

}  // namespace crescent::importer
