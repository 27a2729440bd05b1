// What OpenEXR files say beside radiance: variances, samples, times.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "compare/exr_file.h"
#include "compare/render.h"

namespace crescent::inline comparing {

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
ExrExtra exr_extra(const ExrPart& part);

/// Sets the variance of a render from the planes of `spread`.
void set_variance(Render& out, const ExrExtra& extra, const std::vector<std::vector<float>>& planes);
/// Sets its samples a pixel, where nothing said them, from their plane; a share of the most (Cycles) says nothing.
/// Throws InputError where one of them is no count.
void set_samples(Render& out, const ExrExtra& extra, const std::vector<float>& plane);

/// The first attribute whose name, without what is before its last '.' or '/', is one of these and that is not 0.
/// Throws InputError where it is negative, infinite or no number. `what` it says, for the message.
std::optional<double> exr_attribute(
    const std::string& path, const ExrPart& part, const char* what, std::initializer_list<const char*> names);

}  // namespace crescent::inline comparing
