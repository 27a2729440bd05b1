// Draws the plates (figures) of an experiment from films and numbers, 1280x720, each with a label that states what it
// is.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "metrics/metrics.h"
#include "output/tone_map.h"
#include "render/film.h"
#include "samplers/sampler_adapter.h"

namespace crescent::plates {

/// The inputs of the plates. Films are looked up by key; photographs are tone mapped, other plates read the float
/// films.
struct PlateInputs {
    const Experiment& experiment;
    const Metrics& metrics;
    const ShapeMap& shapes;
    std::function<const Film*(const RunKey&)> film;           // nullptr: not run
    std::function<const ReferenceFilm*(double s)> reference;  // the one the metrics use
    std::string backend;                                      // "CPU" or the GL strings, for the back end plates
    Theme theme = Theme::dark;
    std::function<const SamplerAdapter*(const std::string& arm)> external_sampler{};  // nullptr: it is built in
};

/// A finished picture: 8-bit sRGB, 3 bytes per pixel, rows top-down.
struct Picture {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;
};

/// Draws one plate. Throws OutputError if the font Inter is missing.
Picture draw_plate(const PlatePlan& plan, const PlateInputs& in);

/// Draws the output of `run --preview`: the reference at the experiment's own s with pixel rulers, its regions and the
/// crops of its plates. Throws OutputError if the font is missing.
Picture draw_preview(const PlateInputs& in);

/// Returns the plate as an SVG document if its kind consists only of lines and text; else "".
std::string draw_plate_svg(const PlatePlan& plan, const PlateInputs& in);

/// Encodes PNG bytes with the provenance as text chunks.
std::vector<unsigned char> encode_png(
    const Picture& picture, const std::vector<std::pair<std::string, std::string>>& text);

}  // namespace crescent::plates

/// Names used by a run, compare and the front ends.
namespace crescent {
using plates::draw_plate;
using plates::draw_plate_svg;
using plates::draw_preview;
using plates::encode_png;
using plates::Picture;
using plates::PlateInputs;
}  // namespace crescent
