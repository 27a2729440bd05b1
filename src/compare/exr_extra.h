// What OpenEXR files say beside radiance: variances, samples, times.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compare/render.h"

namespace crescent::inline comparing {

std::string lower(std::string text);
/// layer -> colour (lower case) -> channel: "RenderLayer.Combined.R" stands under RenderLayer.Combined and r.
std::map<std::string, std::map<std::string, std::string>> exr_channels(const Imf::Header& header);

/// Where a part has the variance of its radiance, by the names that renderers give it, and its samples a pixel.
struct ExrExtra {
    enum class Kind {
        none,
        variance,    // of the pixel
        error,       // its root
        of_samples,  // variance of one sample: pbrt's "Variance" beside "RelativeVariance"
        moments      // mean of squares of Y and mean of Y: Mitsuba's "m2_" layers
    } kind = Kind::none;
    std::vector<std::string> spread;  // channels: one of Y, or R, G and B; of moments m2 and the mean
    std::string samples;
};
ExrExtra exr_extra(const Imf::Header& header, const std::string& part);

/// Sets the variance of a render from the planes of `spread`.
void set_variance(Render& out, const ExrExtra& extra, const std::vector<std::vector<float>>& planes);
/// Sets its samples a pixel, where nothing said them, from their plane; a share of the most (Cycles) says nothing.
void set_samples(Render& out, const ExrExtra& extra, const std::vector<float>& plane);

/// The first attribute whose name, without what stands before its last '.' or '/', is one of these.
std::optional<double> exr_attribute(const Imf::Header& header, std::initializer_list<const char*> names);

}  // namespace crescent::inline comparing
