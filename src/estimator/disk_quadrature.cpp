#include "estimator/disk_quadrature.h"

#include <algorithm>
#include <cmath>

#include "estimator/disk_point.h"
#include "estimator/fans.h"
#include "estimator/whole_disk.h"

namespace crescent {

namespace {

/// A light whose plane passes through the point gives it nothing; relative to how far its points are.
constexpr double in_plane = 1e-6;
bool is_in_plane(const Occluder& light, Vec3d x) {
    const Vec3d d = light.a - x;
    return std::fabs(dot(d, light.b)) <= in_plane * (std::sqrt(dot(d, d)) + light.radius);
}

Occluder body_of(const DiskLight& light) {
    return {Occluder::Kind::disk, -1, light.center, light.normal, {}, light.radius};
}

/// The disk seen from x as it is, `far` times as far away: a light in its plane stands before it there, or does not.
DiskLight end_of_way(const DiskLight& disk, Vec3d x, double far) {
    DiskLight out;
    out.center = x + far * (disk.center - x), out.normal = disk.normal, out.radius = far * disk.radius;
    return out;
}

/// Does one body hide the whole disk? Its shadow on the disk's plane is convex: if two opposite sides of the square
/// around the disk lie in it, so does all between them. From within a body the shadow is not convex.
bool hides_all(const Blocker& blocker, Vec3d x, const DiskLight& disk, const Frame<double>& frame) {
    if (holds(blocker.body, x)) return false;
    const Vec3d side = disk.radius * frame.t, up = disk.radius * frame.b;
    const auto whole = [&](Vec3d middle) {
        const Interval part = hidden(blocker.body, x, middle - side, middle + side, blocker.between)[0];
        return part.lo <= 0 && part.hi >= 1;
    };
    return whole(disk.center + up) && whole(disk.center - up);
}

/// Is the lobe wide against the disk as seen from the point, so that rules which know nothing of its peak see all of
/// it?
bool is_soft(const DiskPoint& point, const DiskLight& disk, double height) {
    if (!(point.surface.rho_s > 0)) return true;
    const Vec3d d = disk.center - point.x;
    const double nearest = std::max(std::fabs(dot(d, disk.normal)), std::sqrt(dot(d, d)) - disk.radius);
    const Vec3d r = point.frame.to_world(
        mirror(point.wo));  // a Phong lobe of a small exponent ends with a jump at 90 degrees from it
    if (point.surface.brdf == BrdfKind::phong && point.surface.s < 4 && dot(d, r) < disk.radius) return false;
    return height > 0 && disk.radius < nearest && point.sharpness(disk.radius / nearest) < 2;
}

}  // namespace

DiskQuadrature::DiskQuadrature(const Scene& scene, std::size_t k)
    : disk_(scene.disks()[k]), frame_(frame_about(disk_.normal)) {
    for (const Occluder& body : scene.occluders()) blockers_.push_back({body});
    for (std::size_t other = 0; other < scene.disks().size(); ++other) {
        if (other == k) continue;
        const DiskLight& light = scene.disks()[other];  // of two in one place the first is met
        blockers_.push_back({body_of(light), {0, other < k ? 1 + at_an_end : 1 - at_an_end}, !light.two_sided});
    }
}

bool DiskQuadrature::shines_on(const Hit& hit) const {
    return !is_in_plane(body_of(disk_), hit.x) && (disk_.two_sided || dot(disk_.center - hit.x, disk_.normal) < 0);
}

std::vector<const Blocker*> DiskQuadrature::in_the_way(const Hit& hit) const {
    std::vector<const Blocker*> out;
    for (const Blocker& b : blockers_) {
        if (b.body.shape == hit.shape) continue;
        const bool light = b.body.shape < 0;
        if (light && (is_in_plane(b.body, hit.x) || (b.from_front_only && dot(b.body.a - hit.x, b.body.b) >= 0)))
            continue;
        if (!stands_clear(b.body, {hit.x}, light ? end_of_way(disk_, hit.x, b.between.to) : disk_)) out.push_back(&b);
    }
    return out;
}

DiskIntegral DiskQuadrature::operator()(const Hit& hit, const Surface& surface) const {
    if (!shines_on(hit)) return {};
    const double height = dot(disk_.center - hit.x, hit.n), tilt = dot(hit.n, disk_.normal);
    const double reach = disk_.radius * std::sqrt(std::max(0.0, 1 - tilt * tilt));
    if (height + reach <= 0) return {};
    const Frame<double> local = frame_about(hit.n);
    const DiskPoint point = {hit.x, local.to_local(hit.wo), local, surface, disk_.normal};
    const std::vector<const Blocker*> near = in_the_way(hit);
    for (const Blocker* blocker : near)
        if (hides_all(*blocker, hit.x, disk_, frame_)) return {};
    const bool soft = is_soft(point, disk_, height);
    const bool at_horizon = !(height - reach > 0);
    if (near.empty() && soft && !at_horizon) return whole_disk(point, disk_, frame_);
    return fan_by_fan(point, disk_, near, !soft, at_horizon);
}

}  // namespace crescent
