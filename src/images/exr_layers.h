// Finds the channels of an OpenEXR file that form a picture, by the names that renderers use.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "images/exr_file.h"

namespace crescent {

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
    std::string name;                   // "part/layer", as a user names it
    std::string full_name;              // the same for a file with one part, which may be omitted
    std::string prefix;                 // the layer in its part
    std::vector<std::string> channels;  // R, G, B; Y; X, Y, Z; Y, RY, BY
    bool radiance = true;               // false: read only if it is named
};

/// Returns the requested layer ("": the beauty). Throws LayerError, with the channels found, if there is none or it is
/// ambiguous.
ExrLayer chosen_layer(const ExrFile& file, const std::string& path, const std::string& name);
/// Returns one channel, by its whole name in the file, as a grey layer. Throws InputError with the channels found.
ExrLayer layer_of_channel(const ExrFile& file, const std::string& path, const std::string& channel);
/// Returns the names of the layers of radiance, quoted: "'sky', 'sun'".
std::string layers_found(const ExrFile& file);
/// Returns the alpha channel of a layer; "" if it has none.
std::string alpha_of(const ExrPart& part, const ExrLayer& layer);

}  // namespace crescent
