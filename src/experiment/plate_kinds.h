// The one list of plates: the pictures that an experiment can ask for. A new one is a file of plates/ with its painter,
// draw_PAINTER(Sheet&), and one line here; the list feeds the keys of experiments and their schema, `crescent list
// plates`, the painters, the report and the laws.
//
// plate(name, painter, fewest runs, most runs, look, what it shows)
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

// clang-format off: one a line
#define CRESCENT_PLATES(plate) \
    plate(hero, still, 1, 1, photograph, "one run, one to one where it fits") \
    plate(gallery, still, 0, 1, photograph, "the converged reference") \
    plate(columns, strip, 1, 4, photograph, "runs side by side, each with a part enlarged") \
    plate(ladder, strip, 1, 64, photograph, "the rungs of arms side by side, each with a part enlarged") \
    plate(exponent, strip, 1, 4, photograph, "the runs of the exponent control, each with a part enlarged") \
    plate(surround, strip, 1, 4, photograph, "a part of runs enlarged, side by side") \
    plate(reference, reference, 0, 1, instrument, "the reference with the regions, and their means") \
    plate(heat, heat, 1, 4, instrument, "where runs differ from the reference, on one scale") \
    plate(rose, rose, 1, 4, instrument, "densities in the plane of the normal and R, and over the hemisphere") \
    plate(meters, meters, 0, 64, drawing, "the table of what was measured, and RMSE against N")
// clang-format on

namespace crescent::inline experiment {

#define CRESCENT_NAME(name, ...) name,
enum class PlateKind { CRESCENT_PLATES(CRESCENT_NAME) };
#undef CRESCENT_NAME

/// A photograph goes through the display chain and no number stands on it; an instrument reads the float films; a
/// drawing is an instrument of lines and text alone, which is written as SVG too.
enum class PlateLook { photograph, instrument, drawing };

struct PlateInfo {
    std::string_view name;
    std::size_t least, most;  // runs that it shows
    PlateLook look;
    std::string_view shows;
};

/// By PlateKind.
#define CRESCENT_INFO(name, painter, least, most, look, shows) PlateInfo{#name, least, most, PlateLook::look, shows},
inline constexpr std::array plate_infos = {CRESCENT_PLATES(CRESCENT_INFO)};
#undef CRESCENT_INFO
constexpr const PlateInfo& plate_info(PlateKind kind) { return plate_infos[static_cast<std::size_t>(kind)]; }

}  // namespace crescent::inline experiment
