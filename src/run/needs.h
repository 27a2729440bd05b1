// What a run needs of the machine, told before the work begins.
#pragma once

#include <cstdint>
#include <string>

#include "experiment/experiment.h"
#include "run/plan.h"
#include "scene/scene.h"

namespace crescent::inline runs {

/// Bytes that a run holds at its largest: the films of its first seed and of one pass more, the references at each
/// exponent, what the camera sees, and what the program takes for itself.
std::uint64_t memory_needed(const Experiment& experiment);

/// "this run needs about 70 GB of memory ...", with what would need less; "" where `available` bytes are enough.
std::string why_too_large(const Experiment& experiment, std::uint64_t available);

/// Whether half of `available` bytes hold what is needed and the shading points of the image, which a run is
/// faster with.
bool can_keep_points(const RunPlan& plan, const Scene& scene, std::uint64_t available);

/// Throws OutputError where the memory is not there.
void check_memory(const Experiment& experiment);
/// Throws OutputError where the font that the experiment's plates are drawn with is not there.
void check_font(const Experiment& experiment);

}  // namespace crescent::inline runs
