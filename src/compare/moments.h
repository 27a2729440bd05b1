// A baseline as moments: one OpenEXR file with the mean and the variance of each pixel over the renders of a view. Its
// header has what the tests read from single renders (means of regions, spreads of tiles, largest deviations).
//   R G B  or  Y                     mean radiance, float; so the file is also a picture
//   variance.Y                       variance of Y of one render, float
//   deviation.R deviation.G .B       standard deviation of a channel of one render over "baseline.scale", half
//   failed.N                         renders in which the pixel is not finite, float; only if there are any
// 22 bytes per pixel in colour; a float render has 12.
#pragma once

#include <string>

#include "compare/plan.h"
#include "compare/renders.h"

namespace crescent::inline comparison {

/// Returns whether the file contains moments.
bool has_moments(const std::string& path);

/// Writes one arm of `all`. `constant`: all renders had the same pixels. Throws OutputError.
void write_moments(const std::string& path, const RenderStats& all, std::size_t arm, bool constant);

/// The contents of the header, read without the pixels.
struct MomentsHeader {
    std::size_t renders = 0;
    bool constant = false;
};
MomentsHeader read_moments_header(const std::string& path);

/// Reads the mean and the variance of each pixel, for the first pass; `weights` of R, G and B in Y. Throws InputError.
void read_moments_film(const std::string& path, const Rgb& weights, RenderStats& all, ArmStats& to);
/// Reads the results of the second pass; the regions of `all` must be among those of the file. Throws InputError.
void read_moments_regions(const std::string& path, const ComparePlan& plan, const RenderStats& all, ArmStats& to);

}  // namespace crescent::inline comparison
