// Which channels of an OpenEXR file are a picture, by the names that renderers give them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "compare/exr_file.h"

namespace crescent::inline comparing {

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

}  // namespace crescent::inline comparing
