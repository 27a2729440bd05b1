// Calls the functions of each kind of body.
#include "scene/shadow.h"

#include <algorithm>
#include <cmath>

namespace crescent {

// ---- Separating planes between a convex body and the hull of some points and a light.

double disk_reach(Vec3d axis, Vec3d n) { return std::sqrt(std::max(0.0, dot(axis, axis) - sqr(dot(axis, n)))); }

namespace {

double half_extent(Vec3d half, Vec3d axis) {
    return std::fabs(axis.x) * half.x + std::fabs(axis.y) * half.y + std::fabs(axis.z) * half.z;
}

/// A body, and the hull of the points and the light, relative to the middle of the points.
template <class Body, class Light> class Apart {
public:
    Apart(const Body& body, const Extent& from, const Light& light)
        : body_(body), from_(from), light_(light), d_(light.middle() - from.middle) {}

    /// Returns whether a plane across `axis` separates them.
    bool across(Vec3d axis) const { return is_beyond(axis) || is_beyond(-axis); }

    /// Returns whether the plane that touches the points and the light on their side `side` separates them.
    bool by_graze(Vec3d side) const {
        const double d2 = dot(d_, d_);
        const Vec3d p = side - (dot(side, d_) / d2) * d_;
        const double size = std::sqrt(dot(p, p));
        if (!(size > 1e-12)) return false;
        const Vec3d unit = (1 / size) * p;
        return is_beyond(unit - ((light_.half_extent(unit) - half_extent(from_.half, unit)) / d2) * d_);
    }

    bool by_any_plane() const {
        if (by_graze(body_.middle() - from_.middle)) return true;
        if (body_.faces().empty()) return across(d_);
        for (const Vec3d& axis : body_.faces())
            if (across(axis) || by_graze(axis) || by_graze(-axis)) return true;
        return false;
    }

private:
    /// Returns whether the body lies beyond all of the hull along `axis`.
    bool is_beyond(Vec3d axis) const {
        const double hull = std::max(half_extent(from_.half, axis), dot(axis, d_) + light_.half_extent(axis));
        return dot(axis, body_.middle() - from_.middle) - body_.half_extent(axis) >= hull;
    }

    const Body& body_;
    const Extent& from_;
    const Light& light_;
    Vec3d d_;
};

}  // namespace

bool is_separated(const Occluder& body, const Extent& from, const Bodies::Any& light) {
    return std::visit([&](const auto& b, const auto& l) { return Apart(b, from, l).by_any_plane(); }, body.body, light);
}

Ball ball_around(const Occluder& body) {
    return std::visit(
        [](const auto& b) {
            if (b.faces().empty()) return Ball{b.middle(), b.half_extent({1, 0, 0})};
            const Vec3d half = {b.half_extent({1, 0, 0}), b.half_extent({0, 1, 0}), b.half_extent({0, 0, 1})};
            return Ball{b.middle(), std::sqrt(dot(half, half))};
        },
        body.body);
}

std::array<Interval, 2> hidden(const Occluder& o, Vec3d x, Vec3d y0, Vec3d y1, Between limits) {
    const Sight sight = {.x = x, .d0 = y0 - x, .step = y1 - y0, .limits = limits};
    return std::visit([&](const auto& body) { return body.hidden(sight); }, o.body);
}

bool holds(const Occluder& o, Vec3d x) {
    return std::visit([&](const auto& body) { return body.holds(x); }, o.body);
}

}  // namespace crescent
