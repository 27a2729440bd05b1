#include "estimator/disk_quadrature.h"

#include <algorithm>
#include <cmath>

#include "estimator/disk_point.h"
#include "estimator/fans.h"
#include "estimator/whole_disk.h"

namespace crescent::inline estimator {

namespace {

/// Does one body hide the whole figure? Its shadow on the figure's plane is convex: if two opposite sides of a
/// parallelogram around the figure lie in it, so does all between them. From within a body the shadow is not convex.
bool hides_all(const Blocker& blocker, Vec3d x, const Figure& figure) {
    if (holds(blocker.body, x)) return false;
    const auto whole = [&](Vec3d from, Vec3d to) {
        const Interval part = hidden(blocker.body, x, from, to, blocker.between)[0];
        return part.lo <= 0 && part.hi >= 1;
    };
    const std::array<Vec3d, 4> at = corners_about(figure);
    return whole(at[0], at[1]) && whole(at[3], at[2]);
}

/// Is the lobe wide against the disk as seen from the point, so that rules which know nothing of its peak see all of
/// it?
bool is_soft(const DiskPoint& point, const Figure& figure, double height) {
    if (!(point.surface.rho_s > 0)) return true;
    const Vec3d d = middle_of(figure) - point.x;
    const double radius = radius_of(figure);
    const double nearest = std::max(std::fabs(dot(d, point.light_normal)), std::sqrt(dot(d, d)) - radius);
    // A lobe of a small exponent about R ends with a jump at 90 degrees from it.
    const LobeInfo& lobe = lobe_info(point.surface.brdf);
    const Vec3d r = point.frame.to_world(mirror(point.wo));
    const bool ends = lobe.about_mirror && lobe.exponent(point.surface.s, point.surface.alpha) < 4;
    if (ends && dot(d, r) < radius) return false;
    return height > 0 && radius < nearest && point.sharpness(radius / nearest) < 2;
}

/// May the body reach into the ball about c? Never false where it does.
bool may_reach_into(const Occluder& body, Vec3d c, double radius) {
    return std::visit(
        [&](const auto& b) {
            const Vec3d d = b.middle() - c;
            const auto beyond = [&](Vec3d axis) {
                return dot(axis, d) - b.half_extent(axis) > radius * std::sqrt(dot(axis, axis));  // never along 0
            };
            if (beyond(d)) return false;
            for (const Vec3d& axis : b.faces())
                if (beyond(axis) || beyond(-axis)) return false;
            return true;
        },
        body.body);
}

/// May two lights meet, of which one is a ball?
bool intersects_ball(const Light& a, const Light& b) {
    const auto into = [](const Light& ball, const Light& other) {
        const lights::Sphere* s = std::get_if<lights::Sphere>(&ball.form);
        return s && may_reach_into({other.body(), -1}, s->center, s->radius);
    };
    return into(a, b) || into(b, a);
}

/// The integral over the directions of a figure, what stands before it hidden.
DiskIntegral over(const Figure& figure, const DiskPoint& point, Vec3d normal, const std::vector<const Blocker*>& near) {
    const double height = dot(middle_of(figure) - point.x, normal), reach = half_extent_of(figure, normal);
    for (const Blocker* blocker : near)
        if (hides_all(*blocker, point.x, figure)) return {};
    const bool soft = is_soft(point, figure, height);
    const bool at_horizon = !(height - reach > 0);
    const shapes::Disk* disk = std::get_if<shapes::Disk>(&figure);
    if (disk && near.empty() && soft && !at_horizon) return whole_disk(point, *disk, frame_about(disk->normal));
    return fan_by_fan(point, figure, near, !soft, at_horizon);
}

}  // namespace

DiskQuadrature::DiskQuadrature(const Scene& scene, std::size_t k) : light_(scene.lights()[k]) {
    for (const Occluder& body : scene.occluders()) blockers_.push_back({body});
    for (std::size_t other = 0; other < scene.lights().size(); ++other) {
        if (other == k) continue;
        const Light& light = scene.lights()[other];  // of two in one place the first is met
        blockers_.push_back({{light.body(), -1}, {0, other < k ? 1 + at_an_end : 1 - at_an_end}, &light});
    }
}

std::vector<const Blocker*> DiskQuadrature::in_the_way(const Hit& hit, const Figure& figure) const {
    std::vector<const Blocker*> out;
    for (const Blocker& b : blockers_) {
        if (b.body.shape == hit.shape || (b.light && !b.light->shines_on(hit.x))) continue;
        // A light in this one's plane stands before it at the end of the way, or does not.
        const Figure end = b.light ? moved(figure, hit.x, b.between.to) : figure;
        if (!is_separated(b.body, {hit.x}, body_of(end))) out.push_back(&b);
    }
    return out;
}

DiskIntegral DiskQuadrature::operator()(const Hit& hit, const Surface& surface) const {
    if (!light_.shines_on(hit.x)) return {};
    const Figure figure = light_.seen_from(hit.x);
    if (dot(middle_of(figure) - hit.x, hit.n) + half_extent_of(figure, hit.n) <= 0) return {};
    const Frame<double> local = frame_about(hit.n);
    const DiskPoint point = {hit.x, local.to_local(hit.wo), local, surface, normal_of(figure)};
    const std::vector<const Blocker*> near = in_the_way(hit, figure);
    DiskIntegral out = over(figure, point, hit.n, near);
    // Two lights of which one reaches into the other, a ball: where the ball ends is not known to the figures, and what
    // the other hides of this one is doubtful as a whole.
    for (const Blocker* b : near) {
        if (!b->light || !intersects_ball(light_, *b->light)) continue;
        std::vector<const Blocker*> others = near;
        std::erase(others, b);
        const DiskIntegral open = over(figure, point, hit.n, others);
        out.diffuse_error += std::fabs(open.diffuse - out.diffuse) + open.diffuse_error;
        out.lobe_error += std::fabs(open.lobe - out.lobe) + open.lobe_error;
    }
    const lights::Sphere* ball = std::get_if<lights::Sphere>(&light_.form);
    const auto reaches_in = [&](const Blocker* b) { return may_reach_into(b->body, ball->center, ball->radius); };
    if (!ball || std::none_of(near.begin(), near.end(), reaches_in)) return out;
    // The ball's surface bulges before the figure: what stands between them hides as much as it does of the figure, or
    // nothing, as of the same figure where it touches the ball.
    const Vec3d d = ball->center - hit.x;
    const double far = std::sqrt(dot(d, d));
    const DiskIntegral least = over(moved(figure, hit.x, far / (far + ball->radius)), point, hit.n, near);
    out.diffuse_error += std::fabs(least.diffuse - out.diffuse) + least.diffuse_error;
    out.lobe_error += std::fabs(least.lobe - out.lobe) + least.lobe_error;
    return out;
}

}  // namespace crescent::inline estimator
