// Models of other programs, as crescent-import reads them.
#pragma once

#include <string>

#include "commands.h"

namespace crescent::cli {

/// What the importer found.
struct Imported {
    std::string files;  // bytes of a mesh, or of all meshes and images, at the places that the description states
    Json description;
};

/// Starts the importer. Throws InputError with the place of a mistake.
Imported import_model(const ImportFlags& flags, bool is_folder);

/// Writes an experiment of the whole scene, its meshes and its images into a folder.
int import_folder(const ImportFlags& flags);

[[noreturn]] void refuse(const std::string& file, const std::string& message);

// ---- Comment lines of what is printed; "" if there is nothing to state.

/// How the model was moved and scaled.
std::string moved_line(const Json& description);
/// What the file does not say, a line each.
std::string assumed_lines(const Json& description);
/// What is not taken along, a line each.
std::string left_out_lines(const Json& description);
/// "[1, 2, 3]", six digits each.
std::string point_text(Vec3d v);

}  // namespace crescent::cli
