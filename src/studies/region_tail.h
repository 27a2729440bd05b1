// The tail of one arm's samples in a box of the image.
#pragma once

#include <optional>
#include <string>

#include "arms/outside.h"
#include "base/progress_monitor.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "stats/tail.h"

namespace crescent::inline studies {

/// How a box is read: n samples a pixel, about four million in all, of which the `kept` largest tell; kept is 0 where
/// too few spread.
struct TailPlan {
    std::uint64_t n = 0;
    std::size_t kept = 0;
};
TailPlan tail_plan(const Box& box);

/// The tail index of one arm's samples X in a box, read off as tail_plan() says; none where too few spread. May throw
/// Interrupted.
std::optional<Tail> region_tail(const Scene& scene, const ArmInUse& arm, std::uint32_t seed, const Box& box,
    const std::string& isa, ProgressMonitor& monitor);

}  // namespace crescent::inline studies
