// Films and numbers -> the pictures of an experiment, 1280x720, each saying on itself what it is.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "metrics/metrics.h"
#include "output/color_map.h"
#include "render/film.h"
#include "samplers/external_sampler.h"

namespace crescent::plates {

/// What the plates are made from. Films are looked up by key; photographs go through the display chain,
/// back ends read the float films.
struct PlateInputs {
    const Experiment& experiment;
    const Metrics& metrics;
    const ShapeMap& shapes;
    std::function<const Film*(const RunKey&)> film;           // nullptr: not run
    std::function<const ReferenceFilm*(double s)> reference;  // the one the metrics use
    std::string backend;                                      // "CPU" or the GL strings, for the back end plates
    Theme theme = Theme::dark;
    std::function<const ExternalSampler*(const std::string& arm)> outside{};  // nullptr: it is built in
};

/// A finished picture: 8-bit sRGB, 3 bytes a pixel, rows top-down.
struct Picture {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;
};

/// Draws one plate. Throws OutputError where the font Inter is missing.
Picture draw_plate(const PlatePlan& plan, const PlateInputs& in);

/// What `run --preview` writes: the reference at the experiment's own s between rulers of pixels, its regions and the
/// crops of its plates on it. Throws OutputError where the font is missing.
Picture draw_preview(const PlateInputs& in);

/// The same plate as an SVG document, of a kind that is lines and text alone; "" of the others.
std::string draw_plate_svg(const PlatePlan& plan, const PlateInputs& in);

/// PNG bytes with the provenance as text chunks.
std::vector<unsigned char> encode_png(
    const Picture& picture, const std::vector<std::pair<std::string, std::string>>& text);

}  // namespace crescent::plates

/// What a run, compare and the doors call by these names.
namespace crescent {
using plates::draw_plate;
using plates::draw_plate_svg;
using plates::draw_preview;
using plates::encode_png;
using plates::Picture;
using plates::PlateInputs;
}  // namespace crescent
