// baseline.json, the manifest of a baseline that --accept writes: for each view its files with their hashes, and where
// they come from. A baseline is compared only if its files are those of the manifest.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "output/format.h"

namespace crescent {

inline constexpr const char* manifest_name = "baseline.json";

/// A file of a view: its name in the folder of the manifest, and its hash in hexadecimal digits (XXH3, 128 bits).
struct ManifestFile {
    std::string name, hash;
};

struct ManifestView {
    std::vector<ManifestFile> files;
    std::size_t renders = 0;
    Json entry;  // all that is stated about the view
};

struct Manifest {
    std::string folder;
    std::map<std::string, ManifestView> views;
    Json removed = Json::object();  // views that were removed: date, reason, program
};

/// Reads the text of a manifest: sizes, types and names are checked. Throws InputError with the place in `file`.
Manifest parse_manifest(const std::string& text, const std::string& file);
/// Returns the manifest in a folder; nothing if there is none. Throws InputError.
std::optional<Manifest> read_manifest(const std::string& folder);
/// Returns its text, with views by name.
std::string manifest_text(const Manifest& manifest);

/// Returns how the files of a view differ from the manifest: missing, not listed, of other contents, not yet pulled by
/// Git LFS. `files`: the paths that the patterns of the baseline found.
std::vector<Diagnostic> manifest_differences(
    const Manifest& manifest, const std::string& view, const std::vector<std::string>& files);

/// Returns the hash of a file's contents as in the manifest. Throws InputError if it cannot be read.
std::string hash_of_file(const std::string& path);
/// Returns the name of a path in a folder.
std::string name_in(const std::string& folder, const std::string& path);

}  // namespace crescent
