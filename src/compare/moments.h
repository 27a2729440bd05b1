// A baseline as moments: one OpenEXR file with the mean and the spread of each pixel over the renders of a view, and in
// its header what the tests read of single renders (means of regions, spreads of tiles, largest deviations).
//   R G B  or  Y                     mean radiance, float; so the file is also a picture
//   variance.Y                       variance of Y of one render, float
//   deviation.R deviation.G .B       standard deviation of a channel of one render over "baseline.scale", half
//   failed.N                         renders in which the pixel is not finite, float; only if there are any
// 22 bytes per pixel in colour, where a float render has 12.
#pragma once

#include <string>

#include "compare/plan.h"
#include "compare/renders.h"

namespace crescent::inline comparison {

/// Whether the file holds moments.
bool holds_moments(const std::string& path);

/// Writes one arm of these readings. `constant`: all renders had the same pixels. Throws OutputError.
void write_moments(const std::string& path, const RenderStats& all, std::size_t arm, bool constant);

/// What the header says without its pixels.
struct MomentsHeader {
    std::size_t renders = 0;
    bool constant = false;
};
MomentsHeader read_moments_header(const std::string& path);

/// The mean and the spread of each pixel, for the first pass; `weights` of R, G and B in Y. Throws InputError.
void read_moments_film(const std::string& path, const Rgb& weights, RenderStats& all, ArmStats& to);
/// What the second pass would read; the regions of `all` must be among those of the file. Throws InputError.
void read_moments_regions(const std::string& path, const ComparePlan& plan, const RenderStats& all, ArmStats& to);

}  // namespace crescent::inline comparison
