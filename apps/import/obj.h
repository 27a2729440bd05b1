// The text of an OBJ file before assimp reads it.
#pragma once

#include <string>

namespace crescent::importer {

/// Returns the text without byte order mark and line continuations, with '\n' as the end of each line. Throws
/// ModelError with the line for an index of a face that no vertex has, and for a face of more than most_corners
/// corners.
std::string checked_obj(std::string text);

}  // namespace crescent::importer
