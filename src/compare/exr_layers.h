// Which channels of an OpenEXR file are a picture, by the names that renderers give them.
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compare/exr_file.h"
#include "compare/renders.h"

namespace crescent::inline comparison {

// ---- What OpenEXR files say beside radiance: variances, samples, times.

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

std::string lower(std::string text);
/// "ViewLayer.Variance" -> variance.
std::string last_name(const std::string& layer);

/// layer -> colour -> channel. "RenderLayer.Combined.R" is under RenderLayer.Combined and r; so are "rgba.red",
/// "Name.[red]", "C/r" and "diffuse_R" under their layers. Colours are in lower case: r, g, b, y, ry, by, x, z; what is
/// no colour keeps its name.
using ColourChannels = std::map<std::string, std::string>;
std::map<std::string, ColourChannels> exr_channels(const ExrPart& part);

/// Channels that make a picture.
struct ExrLayer {
    enum class Kind { rgb, grey, xyz, luminance_chroma } kind = Kind::rgb;
    int part = 0;
    std::string name;                   // "part/layer", as --layer takes it
    std::string alone;                  // the same where the file has one part, which need not be named
    std::string prefix;                 // the layer in its part
    std::vector<std::string> channels;  // R, G, B; Y; X, Y, Z; Y, RY, BY
    bool radiance = true;               // else taken only where --layer names it
};

/// The layer that is wanted ("": the beauty). Throws InputError, with the channels found, where there is none or it
/// cannot be known which.
ExrLayer chosen_layer(const ExrFile& file, const std::string& path, const std::string& wanted);

}  // namespace crescent::inline comparison
