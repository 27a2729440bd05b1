// Separating planes between a convex body and the hull of some points and a disk light.
#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/shadow.h"

namespace crescent {

namespace {

Vec3d middle(const Occluder& o) {
    switch (o.kind) {
        case Occluder::Kind::box: return 0.5 * (o.a + o.b);
        case Occluder::Kind::quad: return o.a + 0.5 * (o.b + o.c);
        default: return o.a;
    }
}

/// How far a disk of unit normal n reaches along `axis` from its centre, for radius 1.
double reach(Vec3d axis, Vec3d n) { return std::sqrt(std::max(0.0, dot(axis, axis) - sqr(dot(axis, n)))); }

double half_extent(Vec3d half, Vec3d axis) {
    return std::fabs(axis.x) * half.x + std::fabs(axis.y) * half.y + std::fabs(axis.z) * half.z;
}

/// Half of the body's extent along `axis`.
double half_extent(const Occluder& o, Vec3d axis) {
    switch (o.kind) {
        case Occluder::Kind::sphere: return o.radius * std::sqrt(dot(axis, axis));
        case Occluder::Kind::box: return half_extent(0.5 * (o.b - o.a), axis);
        case Occluder::Kind::quad: return 0.5 * (std::fabs(dot(axis, o.b)) + std::fabs(dot(axis, o.c)));
        case Occluder::Kind::disk: return o.radius * reach(axis, o.b);
        case Occluder::Kind::plane:
            return reach(axis, o.b) > 1e-6 * std::sqrt(dot(axis, axis)) ? std::numeric_limits<double>::infinity() : 0;
    }
    return std::numeric_limits<double>::infinity();
}

/// The hull of the points and the disk, relative to the middle of the points.
class Hull {
public:
    Hull(const Extent& from, const DiskLight& disk)
        : from_(from), d_(disk.center - from.middle), n_(disk.normal), radius_(disk.radius) {}

    /// The body lies beyond all of the hull along `axis`.
    bool is_short_of(const Occluder& body, Vec3d axis) const {
        const double hull = std::max(half_extent(from_.half, axis), dot(axis, d_) + radius_ * reach(axis, n_));
        return dot(axis, middle(body) - from_.middle) - half_extent(body, axis) >= hull;
    }
    bool is_parted_across(const Occluder& body, Vec3d axis) const {
        return is_short_of(body, axis) || is_short_of(body, -axis);
    }

    /// The plane that grazes the points and the disk on the side towards which `aside` points.
    bool is_parted_by_graze(const Occluder& body, Vec3d aside) const {
        const double d2 = dot(d_, d_);
        const Vec3d p = aside - (dot(aside, d_) / d2) * d_;
        const double size = std::sqrt(dot(p, p));
        if (!(size > 1e-12)) return false;
        const Vec3d unit = (1 / size) * p;
        return is_short_of(body, unit - ((radius_ * reach(unit, n_) - half_extent(from_.half, unit)) / d2) * d_);
    }

private:
    Extent from_;
    Vec3d d_, n_;
    double radius_;
};

}  // namespace

bool stands_clear(const Occluder& body, const Extent& from, const DiskLight& disk) {
    const Hull hull(from, disk);
    if (body.kind == Occluder::Kind::plane) return hull.is_parted_across(body, body.b);
    if (hull.is_parted_by_graze(body, middle(body) - from.middle)) return true;
    if (body.kind == Occluder::Kind::sphere) return hull.is_parted_across(body, disk.center - from.middle);
    const auto parted = [&](Vec3d axis) {
        return hull.is_parted_across(body, axis) || hull.is_parted_by_graze(body, axis) ||
            hull.is_parted_by_graze(body, -axis);
    };
    switch (body.kind) {
        case Occluder::Kind::quad: return parted(cross(body.b, body.c)) || parted(body.b) || parted(body.c);
        case Occluder::Kind::disk: return parted(body.b);
        default: return parted({1, 0, 0}) || parted({0, 1, 0}) || parted({0, 0, 1});
    }
}

}  // namespace crescent
