// Files of a model and of what it names: regular ones, in its folder.
#include "model.h"

#include <algorithm>
#include <cctype>
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

bool is_inside(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    const fs::path outer = fs::weakly_canonical(fs::absolute(folder), error);
    const fs::path path = fs::weakly_canonical(fs::absolute(file), error);
    const auto end = std::mismatch(outer.begin(), outer.end(), path.begin(), path.end()).first;
    return !error && (end == outer.end() || end->empty());
}

}  // namespace crescent::importer
