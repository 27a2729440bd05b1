// Materials of a model as those of an experiment: the same for one mesh and for a folder.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "commands.h"

namespace crescent::cli {

/// How often something of a kind occurs: the kinds as counted() takes them.
using Counts = std::map<std::string, std::size_t>;

/// The keys of a mesh of an experiment.
struct ImportedMaterial {
    Rgb rho_d{}, rho_s{}, emission{};
    double alpha = 0.5;
};

/// Of metal and roughness: rho_d = (1 - metal) colour, rho_s = (1 - metal) rho_s + metal colour, and alpha =
/// roughness^2 (glTF 2.0, appendix B). from: of the importer's description; mean_colour: of the image that multiplies
/// the colour; mean_metal: of the one that multiplies the metal. What an experiment does not take is cut to what it
/// takes, and counted in `cuts`.
ImportedMaterial material_of(const Json& from, const Rgb& mean_colour, double mean_metal, Counts& cuts);

/// "cut: 2 materials with colours above 1, to 1", a comment line for each.
std::string cut_lines(const Counts& cuts);

/// The least alpha of an experiment that is imported.
double least_imported_alpha();

/// Decodes an image; is_linear: its numbers as they are. A temporary file in `scratch` has it meanwhile. Nothing if its
/// format is not read.
std::optional<RgbImage> decoded_image(
    std::string_view bytes, const std::string& name, bool is_linear, const std::string& scratch);

/// Comment lines on the images without which an experiment is.
std::string left_out_images(
    const std::map<std::size_t, std::string>& missing_images, const std::map<std::size_t, std::string>& unread_images);

/// Whether an image of colours states another encoding than sRGB, as which it is read (glTF 2.0, section 3.9.2: what an
/// image states is not used).
bool states_other_encoding(std::string_view bytes);
inline constexpr const char* stated_encoding =
    "image[s] of colours [is|are] sRGB, although [it states|they state] a gamma or a profile";

Rgb mean_of(const RgbImage& image);

}  // namespace crescent::cli
