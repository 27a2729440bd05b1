// The text of an OBJ file before assimp reads it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model.h"

namespace crescent::importer {

struct ObjText {
    std::string text;
    Vec3d origin{};                      // of the vertices in the text
    std::vector<std::string> libraries;  // of materials, as `mtllib` names them
    std::vector<std::string> left_out;   // "3 curves and surfaces"
};

/// What stands for a blank within the name of an object or a group, at which assimp would end it.
inline constexpr char blank_of_name = '\x1f';

/// Returns the text without byte order mark, comments and line continuations, with '\n' as the end of each line and
/// nothing before its first word. Vertices that are far away for their extent are relative to an origin: assimp keeps
/// them in single precision. Throws ModelError with the line for a vertex without its numbers, for an index of a
/// face that no vertex has, and for a face of more than most_corners corners.
ObjText checked_obj(std::string_view file);

/// Returns the text of an MTL file without statements at which assimp would refuse the model; adds what was removed to
/// the list, "'aniso' of 2 materials".
std::string checked_mtl(std::string_view file, std::vector<std::string>& left_out);

}  // namespace crescent::importer
