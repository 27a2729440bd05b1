// A baseline as moments: one OpenEXR file with the mean and the variance of each pixel over the renders of a view. Its
// header has what the tests read from single renders (means of regions, spreads of tiles, largest deviations).
//
//   R G B  or  Y                   mean radiance, float; so the file is also a picture
//   variance.Y                     variance of Y of one render, float
//   deviation.R deviation.G .B     standard deviation of a channel of one render over "baseline.scale", half
//   failed.N                       renders in which the pixel is not finite, float; only if there are any
//
// 22 bytes per pixel in colour; a float render has 12.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compare/image_file.h"
#include "compare/renders.h"
#include "experiment/experiment.h"
#include "images/open_file.h"
#include "scene/scene_data.h"

namespace crescent {

inline constexpr const char* moments_format = "crescent moments 1";
inline constexpr const char* moments_text = "baseline.moments";  // name of the attribute with JSON
inline constexpr const char* moments_scale = "baseline.scale";

/// The tests keep 100 bytes per render and tile: 400 MB for 512 tiles.
inline constexpr std::size_t moments_renders_most = 8192;

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

/// Returns whether the file contains moments.
bool has_moments(const std::string& path);

/// Writes one arm of `stats`. `constant`: all renders had the same pixels. Throws OutputError.
void write_moments(const std::string& path, const RenderStats& stats, std::size_t arm, bool constant);

}  // namespace crescent
