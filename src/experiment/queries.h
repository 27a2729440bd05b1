// Values derived from an experiment: names of its films, warnings, properties of its samplers, tables of its lights.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiment/experiment.h"
#include "scene/scene_data.h"

namespace crescent::inline experiment {

// ---- The names of film files.

/// Returns the file for the films of an arm at exponent s under films/, without .exr: the arm's name, followed by s if
/// it is not the experiment's own. The references have a file in the same folder.
std::string film_file(std::string_view arm, double s, double own_s);
inline constexpr std::string_view reference_file = "reference";

// ---- Warnings: valid but probably unintended values, shown in the summary and in the report.

/// Returns one line each for surfaces whose rho_d + rho_s is above 1 in a channel, so that they reflect more than they
/// receive, and for a `note_evidence` without anything to measure.
std::vector<std::string> warnings_of(const Experiment& experiment);

// ---- The shape and arm that `note_evidence` is measured on, or why there is none.

/// Returns the exponent control's shape, else the first with a Phong lobe; null if it has no Phong lobe or there is
/// none.
const Shape* evidence_shape(const Experiment& experiment);
/// Returns "no arm has the sampler 'phong'", ...; "" if note_evidence has an arm and a surface to measure.
std::string why_no_evidence(const Experiment& experiment);

// ---- Properties of the arms of an experiment in its scene, from SamplerInfo (samplers/info.h): for plates and
// reports.

/// Returns the directions that an arm draws per sample: 2 if it combines two techniques and N counts pairs.
int techniques_of(const ArmPlan& arm);

/// Returns what draws for an arm that is no built-in sampler: "the plugin libx.so", "the balance heuristic of sky and
/// cosine"; "" for a built-in sampler.
std::string source_of(const ArmPlan& arm);

/// Returns the light of this scene that an arm cannot reach ("the fill"), so that it is biased here and its error stops
/// falling with N; "" if it reaches all.
std::string missed_light(const ArmPlan& arm, const Experiment& experiment);

/// Returns whether the exponent identifies an arm's run at s: the arm's pdf depends on it, or it is not the
/// experiment's own.
bool tells_s(const std::string& arm, double s, const Experiment& experiment);
/// Returns whether that holds for any arm at the experiment's own s.
bool any_tells_s(const Experiment& experiment);

// ---- The lights of an experiment, from both of its tables, and their paths for --set.

/// A light of [disks.NAME] or of [lights.NAME], and the path of that table for --set: "disks.key".
struct LightTable {
    std::string path;
    Light light;
};
/// Returns all lights of a scene except the fill, in its order: disks first.
std::vector<LightTable> all_lights(const SceneData& scene);

}  // namespace crescent::inline experiment
