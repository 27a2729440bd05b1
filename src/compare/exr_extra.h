// Data of OpenEXR files next to radiance: variances, samples, times.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "compare/renders.h"
#include "images/exr_file.h"

namespace crescent {

/// The channels with the variance of a part's radiance and with its samples per pixel, by the names that renderers use.
struct ExrExtra {
    enum class Kind {
        none,
        variance,    // of the pixel
        error,       // the root of that
        of_samples,  // variance of one sample: pbrt's "Variance" next to "RelativeVariance"
        moments      // mean of squares of Y and mean of Y: Mitsuba's "m2_" layers
    } kind = Kind::none;
    std::vector<std::string> spread;  // channels: Y, or R, G and B; for moments m2 and the mean
    std::string samples;
};
ExrExtra exr_extra(const ExrPart& part);

/// Sets the variance of a render from the planes of `spread`.
void set_variance(Render& out, const ExrExtra& extra, const std::vector<std::vector<float>>& planes);
/// Sets the samples per pixel from their plane, if no attribute states them; a plane of shares of the maximum (Cycles)
/// is ignored. Throws InputError if a value is not a count.
void set_samples(Render& out, const ExrExtra& extra, const std::vector<float>& plane);

/// Returns the value of the first attribute whose name, without everything up to its last '.' or '/', is one of these
/// and that is not 0. Throws InputError if it is negative or not finite. `what`: its meaning, for the message.
std::optional<double> exr_attribute(
    const std::string& path, const ExrPart& part, const char* what, std::initializer_list<const char*> names);

}  // namespace crescent
