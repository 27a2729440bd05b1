// Finds the channels of an OpenEXR file that form a picture, by the names that renderers use.
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compare/exr_file.h"
#include "compare/renders.h"

namespace crescent {

// ---- Data of OpenEXR files next to radiance: variances, samples, times.

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

std::string lower(std::string text);
/// "ViewLayer.Variance" -> variance.
std::string last_name(const std::string& layer);

/// layer -> colour -> channel. "RenderLayer.Combined.R" is under RenderLayer.Combined and r; similarly "rgba.red",
/// "Name.[red]", "C/r" and "diffuse_R" are under their layers. Colours are in lower case: r, g, b, y, ry, by, x, z;
/// other names are kept.
using ColourChannels = std::map<std::string, std::string>;
std::map<std::string, ColourChannels> exr_channels(const ExrPart& part);

/// The channels of one picture.
struct ExrLayer {
    enum class Kind { rgb, grey, xyz, luminance_chroma } kind = Kind::rgb;
    int part = 0;
    std::string name;                   // "part/layer", as --layer accepts it
    std::string alone;                  // the same for a file with one part, which may be omitted
    std::string prefix;                 // the layer in its part
    std::vector<std::string> channels;  // R, G, B; Y; X, Y, Z; Y, RY, BY
    bool radiance = true;               // false: read only if --layer names it
};

/// Returns the requested layer ("": the beauty). Throws InputError, with the channels found, if there is none or it is
/// ambiguous.
ExrLayer chosen_layer(const ExrFile& file, const std::string& path, const std::string& wanted);
/// Returns one channel, by its whole name in the file, as a grey layer. Throws InputError with the channels found.
ExrLayer layer_of_channel(const ExrFile& file, const std::string& path, const std::string& channel);
/// Returns the alpha channel of a layer; "" if it has none.
std::string alpha_of(const ExrPart& part, const ExrLayer& layer);

}  // namespace crescent
