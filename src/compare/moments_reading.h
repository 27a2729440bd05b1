// Reads a file of moments: its header, and in two passes what the tests take from renders.
#pragma once

#include <cstddef>
#include <string>

#include "base/vec.h"
#include "compare/moments.h"
#include "compare/plan.h"
#include "compare/renders.h"

namespace crescent {

/// Returns the name of the header attribute with numbers of one kind.
std::string moments_attribute(const char* kind, std::size_t region, std::size_t quantity);

/// Reads the text: types and ranges are checked for an image of this size. Throws InputError with the file and the key.
MomentsText parse_moments_text(const std::string& text, const std::string& file, int width, int height);

/// The contents of the header, read without the pixels.
struct MomentsHeader {
    std::size_t renders = 0;
    bool constant = false;
};
/// Reads the header of a file of moments. Throws InputError.
MomentsHeader read_moments_header(const std::string& path);

/// Reads the mean and the variance of each pixel, for the first pass; `weights` of R, G and B in Y. Throws InputError.
void read_moments_film(const std::string& path, const Rgb& weights, RenderStats& stats, ArmStats& to);
/// Reads the results of the second pass; the regions of `stats` must be among those of the file. Throws InputError.
void read_moments_regions(const std::string& path, const ComparePlan& plan, const RenderStats& stats, ArmStats& to);

}  // namespace crescent
