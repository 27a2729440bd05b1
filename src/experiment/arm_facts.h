// What the arms of an experiment are in its scene, by their own manuals (arms/info.h): for plates and reports.
#pragma once

#include <string>

#include "experiment/experiment.h"

namespace crescent::inline experiment {

/// Directions that an arm draws a sample: 2 where it joins two techniques and N counts pairs.
int techniques_of(const ArmPlan& arm);

/// The light of this scene that an arm cannot reach ("the fill"), so that it is biased here and
/// its error stops falling with N; "" where it reaches all.
std::string missed_light(const ArmPlan& arm, const Experiment& experiment);

/// Whether an exponent says something of an arm's run at s: the arm aims by it, or it is not the experiment's own.
bool tells_s(const std::string& arm, double s, const Experiment& experiment);
/// The same of any arm at the experiment's own s.
bool any_tells_s(const Experiment& experiment);

}  // namespace crescent::inline experiment
