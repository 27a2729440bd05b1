// The form of a file of moments, see renders.h: its attributes and the limits of what is read.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compare/image_file.h"
#include "experiment/experiment.h"
#include "images/open_file.h"

namespace crescent {

inline constexpr const char* moments_format = "crescent moments 1";
inline constexpr const char* moments_text = "baseline.moments";  // name of the attribute with JSON
inline constexpr const char* moments_scale = "baseline.scale";

/// The tests keep 100 bytes per render and tile: 400 MB for 512 tiles.
inline constexpr std::size_t moments_renders_most = 8192;

/// Returns the name of the header attribute with numbers of one kind.
std::string moments_attribute(const char* kind, std::size_t region, std::size_t quantity);

/// A region whose statistics the file has.
struct MomentsRegion {
    std::string name;
    Box box;
};

/// The text of the header.
struct MomentsText {
    std::size_t renders = 0, quantities = 0;
    bool constant = false;
    double rounding = 0;
    Quantisation steps;
    std::vector<MomentsRegion> regions;
};

/// Reads the text: types and ranges are checked for an image of this size. Throws InputError with the file and the key.
MomentsText parse_moments_text(const std::string& text, const std::string& file, int width, int height);

}  // namespace crescent
