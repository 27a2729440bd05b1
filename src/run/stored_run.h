// A run that was written earlier: its metrics.json, and the plates beside it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "run/collect.h"

namespace crescent {

/// What can be read of it.
struct StoredRun {
    Measured measured;                 // without films
    std::vector<std::string> missing;  // plates of the experiment that are not in plates/
};

/// The PNG files of a folder by their names without .png. Throws InputError if one is something else.
Plates read_plates(const std::filesystem::path& folder);

/// `json`: the content of `path`, a metrics.json. Throws InputError if it is something else, or a plate is no PNG.
StoredRun open_run(const Json& json, const std::string& path);

}  // namespace crescent
