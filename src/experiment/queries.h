// What an experiment says of itself: names of its films, warnings, facts of its samplers, tables of its lights.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiment/experiment.h"
#include "scene/scene_data.h"

namespace crescent::inline experiment {

// ---- The names of the files that films go into.

/// Where the films of an arm at exponent s go under films/, without .exr: the arm's name, followed by an s that is not
/// the experiment's own. The references have a file beside them.
std::string film_file(std::string_view arm, double s, double own_s);
inline constexpr std::string_view reference_file = "reference";

// ---- What an experiment may say and yet hardly means: told in the summary and in the report, never refused.

/// A line each: surfaces whose rho_d + rho_s is above 1 in a channel, so that they reflect more than they receive; a
/// `note_evidence` that has nothing to measure.
std::vector<std::string> warnings_of(const Experiment& experiment);

// ---- What the measurements of `note_evidence` are taken on, or why there is nothing to take them on.

/// The exponent control's shape, else the first with a Phong lobe; null where it has no Phong lobe or there is none.
const Shape* evidence_shape(const Experiment& experiment);
/// "no arm has the sampler 'phong'", ...; "" where note_evidence has an arm and a surface to measure.
std::string why_no_evidence(const Experiment& experiment);

// ---- What the arms of an experiment are in its scene, by their own manuals (arms/info.h): for plates and reports.

/// Directions that an arm draws a sample: 2 where it joins two techniques and N counts pairs.
int techniques_of(const ArmPlan& arm);

/// The light of this scene that an arm cannot reach ("the fill"), so that it is biased here and
/// its error stops falling with N; "" where it reaches all.
std::string missed_light(const ArmPlan& arm, const Experiment& experiment);

/// Whether an exponent says something of an arm's run at s: the arm aims by it, or it is not the experiment's own.
bool tells_s(const std::string& arm, double s, const Experiment& experiment);
/// The same of any arm at the experiment's own s.
bool any_tells_s(const Experiment& experiment);

// ---- The lights of an experiment, whichever of its two tables names them, and how --set reaches them.

/// A light of [disks.NAME] or of [lights.NAME], and the path of that table for --set: "disks.key".
struct LightTable {
    std::string path;
    Light light;
};
/// All lights of a scene but the fill, in the order in which it has them: disks first.
std::vector<LightTable> all_lights(const SceneData& scene);

/// What --set takes to make a light `factor` times as wide about its centre ("disks.key.radius=0.4"); empty for a kind
/// that has neither lengths nor edges.
std::vector<std::string> widened(const LightTable& table, double factor);

}  // namespace crescent::inline experiment
