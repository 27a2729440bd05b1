// Each kind of body answers for itself.
#include "scene/shadow.h"

namespace crescent::inline scene {

std::array<Interval, 2> hidden(const Occluder& o, Vec3d x, Vec3d y0, Vec3d y1, Between between) {
    const Sight sight = {x, y0 - x, y1 - y0, between};
    return std::visit([&](const auto& body) { return body.hidden(sight); }, o.body);
}

bool holds(const Occluder& o, Vec3d x) {
    return std::visit([&](const auto& body) { return body.holds(x); }, o.body);
}

}  // namespace crescent::inline scene
