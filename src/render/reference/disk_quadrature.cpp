// Tests with balls and planes first exclude bodies that cannot hide the light. Then the cheapest valid method is used:
// the light is hidden completely, the whole disk by polar rules, or fan by fan. Parts are those of Lambert and of the
// lobe, per unit of radiance; the errors of parts are added.
#include "render/reference/disk_quadrature.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "math/functions.h"
#include "math/quadrature.h"
#include "render/reference/fans.h"

namespace crescent {

namespace {

/// Returns whether one body hides the whole figure. Its shadow on the figure's plane is convex: if it contains two
/// opposite sides of a parallelogram around the figure, it contains everything between them. From within a body the
/// shadow is not convex.
bool hides_all(const Blocker& blocker, Vec3d x, const Figure& figure) {
    if (holds(blocker.body, x)) return false;
    const auto hides_side = [&](Vec3d from, Vec3d to) {
        const Interval part = hidden(blocker.body, x, from, to, blocker.limits)[0];
        return part.lo <= 0 && part.hi >= 1;
    };
    const std::array<Vec3d, 4> corners = corners_about(figure);
    return hides_side(corners[0], corners[1]) && hides_side(corners[3], corners[2]);
}

/// Returns whether the lobe is wide compared with the disk as seen from the point, so that rules that do not know its
/// peak resolve it.
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

/// Returns whether the body may reach into the ball around c. Never false if it does.
bool may_reach_into(const Occluder& body, Vec3d c, double radius) {
    return std::visit(
        [&](const auto& b) {
            const Vec3d d = b.middle() - c;
            const auto is_beyond = [&](Vec3d axis) {
                return dot(axis, d) - b.half_extent(axis) > radius * std::sqrt(dot(axis, axis));  // never along 0
            };
            if (is_beyond(d)) return false;
            for (const Vec3d& axis : b.faces())
                if (is_beyond(axis) || is_beyond(-axis)) return false;
            return true;
        },
        body.body);
}

/// The directions of a figure from a point, and the bodies before it; lobes of other exponents share everything except
/// the integral.
class FigureSeen {
public:
    FigureSeen(const DiskPoint& point, const Figure& figure, Vec3d normal, const std::vector<const Blocker*>& blockers)
        : figure_(figure),
          blockers_(blockers),
          height_(dot(middle_of(figure) - point.x, normal)),
          at_horizon_(!(height_ - half_extent_of(figure, normal) > 0)),
          is_hidden_(std::any_of(
              blockers.begin(), blockers.end(), [&](const Blocker* b) { return hides_all(*b, point.x, figure); })) {}

    /// At the same point, with another lobe.
    DiskIntegral operator()(const DiskPoint& point) {
        if (is_hidden_) return {};
        const bool soft = is_soft(point, figure_, height_);
        const shapes::Disk* disk = std::get_if<shapes::Disk>(&figure_);
        if (disk && blockers_.empty() && soft && !at_horizon_)
            return whole_disk(point, *disk, frame_about(disk->normal));
        std::optional<AllFans>& fans = soft ? about_light_ : about_lobe_;
        if (!fans) fans.emplace(point, figure_, blockers_, !soft, at_horizon_);
        return fan_by_fan(point, *fans);
    }

private:
    const Figure& figure_;
    const std::vector<const Blocker*>& blockers_;
    double height_;
    bool at_horizon_, is_hidden_;
    std::optional<AllFans> about_light_, about_lobe_;
};

DiskIntegral operator+(const DiskIntegral& a, const DiskIntegral& b) {
    return {.diffuse = a.diffuse + b.diffuse,
        .lobe = a.lobe + b.lobe,
        .diffuse_error = a.diffuse_error + b.diffuse_error,
        .lobe_error = a.lobe_error + b.lobe_error};
}
/// Returns a without b.
DiskIntegral operator-(const DiskIntegral& a, const DiskIntegral& b) {
    return {.diffuse = a.diffuse - b.diffuse,
        .lobe = a.lobe - b.lobe,
        .diffuse_error = a.diffuse_error + b.diffuse_error,
        .lobe_error = a.lobe_error + b.lobe_error};
}
/// Returns an estimate of a value between a and b.
DiskIntegral enclosed(const DiskIntegral& a, const DiskIntegral& b) {
    const auto estimate = [](double p, double q, double error, double other) {
        return 0.5 * std::fabs(p - q) + std::max(error, other);
    };
    return {.diffuse = 0.5 * (a.diffuse + b.diffuse),
        .lobe = 0.5 * (a.lobe + b.lobe),
        .diffuse_error = estimate(a.diffuse, b.diffuse, a.diffuse_error, b.diffuse_error),
        .lobe_error = estimate(a.lobe, b.lobe, a.lobe_error, b.lobe_error)};
}

/// Returns the distance of the ball's nearest point, as a fraction of the distance to the middle of its figure.
double nearest_of(const lights::Sphere& ball, Vec3d x) {
    const Vec3d d = ball.center - x;
    const double distance = std::sqrt(dot(d, d));
    return distance / (distance + ball.radius);
}

/// A ball that bodies or other lights reach into. Its surface lies before the figure, and a body behind that surface
/// hides nothing. The integral is taken in rings around the middle, each at the distance of its inner edge and at that
/// of its outer edge: the true value is between the two.
DiskIntegral ring_by_ring(
    const DiskPoint& point, Vec3d normal, const lights::Sphere& ball, const std::vector<const Blocker*>& blockers) {
    const shapes::Disk disk = std::get<shapes::Disk>(ball.seen_from(point.x));
    const Vec3d d = disk.center - point.x, c = ball.center - point.x;
    const double plane = std::sqrt(dot(d, d)), distance = std::sqrt(dot(c, c));
    // The fraction of the way at which the ball is met, on the way to a point of the figure at `offset` from its
    // middle.
    const auto met_at = [&](double offset) {
        const double way = std::sqrt(sqr(plane) + sqr(offset)), projection = distance * plane / way;
        const double half2 = sqr(ball.radius) - sqr(distance * offset / way);
        return std::min(1.0, (projection - std::sqrt(std::max(half2, 0.0))) / way);
    };
    constexpr int rings = 8;
    DiskIntegral sum;
    for (int k = 0; k < rings; ++k) {
        // About evenly spaced in the distance between surface and figure, which falls like a root at the edge.
        const auto edge = [&](int number) {
            return disk.radius * std::sqrt(1 - sqr(1 - static_cast<double>(number) / rings));
        };
        const auto up_to = [&](double radius, double way) {
            const Figure part = moved(shapes::Disk{disk.center, disk.normal, radius}, point.x, way);
            return radius > 0 ? FigureSeen(point, part, normal, blockers)(point) : DiskIntegral{};
        };
        const double from = edge(k), to = edge(k + 1);
        const auto ring = [&](double way) { return up_to(to, way) - up_to(from, way); };
        sum = sum + enclosed(ring(met_at(from)), ring(met_at(to)));
    }
    return sum;
}

/// The result for a ball whose figure gives `out`, for cases in which a body may lie between the ball's surface and the
/// figure.
DiskIntegral before_bulge(const DiskPoint& point, Vec3d normal, const lights::Sphere& ball,
    const std::vector<const Blocker*>& blockers, const DiskIntegral& out) {
    const Figure nearest = moved(ball.seen_from(point.x), point.x, nearest_of(ball, point.x));
    const DiskIntegral nearest_integral = FigureSeen(point, nearest, normal, blockers)(point);
    if (std::fabs(nearest_integral.diffuse - out.diffuse) <= nearest_integral.diffuse_error + out.diffuse_error &&
        std::fabs(nearest_integral.lobe - out.lobe) <= nearest_integral.lobe_error + out.lobe_error)
        return enclosed(out, nearest_integral);
    return ring_by_ring(point, normal, ball, blockers);
}

}  // namespace

DiskQuadrature::DiskQuadrature(const Scene& scene, std::size_t k) : light_(scene.lights()[k]) {
    for (const Occluder& body : scene.occluders()) blockers_.push_back({body});
    for (std::size_t other = 0; other < scene.lights().size(); ++other) {
        if (other == k) continue;
        const Light& light = scene.lights()[other];  // of two at the same place the first is met
        blockers_.push_back({{light.body(), -1}, {0, other < k ? 1 + at_an_end : 1 - at_an_end}, &light});
    }
}

std::vector<const Blocker*> DiskQuadrature::in_the_way(const Hit& hit, const Figure& figure) const {
    std::vector<const Blocker*> out;
    const Bodies::Any light = body_of(figure);
    const Ball ball = {middle_of(figure), radius_of(figure)};
    for (const Blocker& b : blockers_) {
        if (b.body.shape == hit.shape || (b.light && !b.light->shines_on(hit.x))) continue;
        if (passes_by(b.ball, hit.x, ball)) continue;
        // A light in the plane of this one lies before it at the end of the way, or not at all.
        const bool is_apart = b.light ? is_separated(b.body, {hit.x}, body_of(moved(figure, hit.x, b.limits.to)))
                                      : is_separated(b.body, {hit.x}, light);
        if (!is_apart) out.push_back(&b);
    }
    return out;
}

DiskIntegral DiskQuadrature::operator()(const Hit& hit, const Surface& surface) const {
    DiskIntegral out;
    (*this)(hit, {&surface, 1}, {&out, 1});
    return out;
}

void DiskQuadrature::operator()(const Hit& hit, std::span<const Surface> surfaces, std::span<DiskIntegral> out) const {
    std::fill(out.begin(), out.end(), DiskIntegral{});
    if (!light_.shines_on(hit.x)) return;
    const Figure figure = light_.seen_from(hit.x);
    if (dot(middle_of(figure) - hit.x, hit.n) + half_extent_of(figure, hit.n) <= 0) return;
    const Frame<double> local = frame_about(hit.n);
    DiskPoint point = {.x = hit.x,
        .wo = local.to_local(hit.wo),
        .frame = local,
        .surface = surfaces[0],
        .light_normal = normal_of(figure)};
    const std::vector<const Blocker*> blockers = in_the_way(hit, figure);
    const lights::Sphere* ball = std::get_if<lights::Sphere>(&light_.form);
    const bool bulges = ball && std::any_of(blockers.begin(), blockers.end(), [&](const Blocker* b) {
        return may_reach_into(b->body, ball->center, ball->radius);
    });
    FigureSeen integral(point, figure, hit.n, blockers);
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        point.surface = surfaces[k];
        out[k] = integral(point);
        if (bulges) out[k] = before_bulge(point, hit.n, *ball, blockers, out[k]);
    }
}

// ---- Lambert's part is in closed form; the lobe uses polar rules of rising order, Gauss-Legendre in r^2 times even
// angles, from 3 points to 3840, until two of them agree to 1e-5 of the pixel.

namespace {

/// Gauss-Legendre in r^2, evenly spaced in angle: nodes on the unit disk, weights summing to pi.
struct PolarRule {
    struct Node {
        double x, y, weight;
    };
    std::vector<Node> nodes;

    template <unsigned radial> static PolarRule make(int angular) {
        PolarRule rule;
        using G = math::Gauss<radial>;
        const auto ring = [&](double abscissa, double weight) {
            const double r = std::sqrt(0.5 * (1 + abscissa));
            for (int k = 0; k < angular; ++k) {
                const double phi = 2 * pi * (k + 0.5) / angular;
                rule.nodes.push_back({r * math::cos(phi), r * math::sin(phi), 0.5 * weight * pi / angular});
            }
        };
        for (std::size_t k = 0; k < G::abscissa().size(); ++k) {
            ring(G::abscissa()[k], G::weights()[k]);
            if (G::abscissa()[k] != 0) ring(-G::abscissa()[k], G::weights()[k]);
        }
        return rule;
    }
};

const std::vector<PolarRule>& polar_rules() {
    static const std::vector<PolarRule> rules = {PolarRule::make<1>(3), PolarRule::make<2>(5), PolarRule::make<3>(7),
        PolarRule::make<5>(12), PolarRule::make<7>(17), PolarRule::make<10>(25), PolarRule::make<15>(36),
        PolarRule::make<25>(60), PolarRule::make<40>(96)};
    return rules;
}

/// Lambert's part of the whole disk, above the horizon and unoccluded: integral of cos(theta_i) dw / pi in closed form.
/// The light's vector irradiance has a part along the disk's axis and a part towards it (Howell's catalog of view
/// factors, elements parallel and perpendicular to a disk), written without cancellation.
double whole_disk_diffuse(const DiskPoint& point, const shapes::Disk& disk) {
    const Vec3d d = disk.center - point.x;
    const double height = dot(d, disk.normal), r2 = sqr(disk.radius), h = std::fabs(height);
    const Vec3d axis = height < 0 ? -disk.normal : disk.normal;
    const Vec3d offset = d - h * axis;
    const double p2 = dot(offset, offset), a = p2 + h * h + r2;
    const double root = std::sqrt(a * a - 4 * r2 * p2);
    const double parallel = r2 * (1 - 2 * p2 / (a + root)) / root;
    return dot(point.frame.n, axis) * parallel + dot(point.frame.n, offset) * (2 * h * r2 / (root * (a + root)));
}

}  // namespace

DiskIntegral whole_disk(const DiskPoint& point, const shapes::Disk& disk, const Frame<double>& frame) {
    DiskIntegral out;
    out.diffuse = whole_disk_diffuse(point, disk);
    if (!(point.surface.rho_s > 0)) return out;
    const auto apply = [&](const PolarRule& rule) {
        double sum = 0;
        for (const auto& n : rule.nodes)
            sum +=
                n.weight * point.lobe_at(disk.center + frame.t * (disk.radius * n.x) + frame.b * (disk.radius * n.y));
        return sum * sqr(disk.radius);
    };
    // Relative, between two rules; the finer rule, which is kept, is much more accurate.
    constexpr double tolerance = 1e-5;
    const auto& rules = polar_rules();
    double coarse = apply(rules[0]);
    for (std::size_t k = 1; k < rules.size(); ++k) {
        out.lobe = apply(rules[k]);
        out.lobe_error = std::fabs(out.lobe - coarse);
        if (point.weigh({0, out.lobe_error}) <= tolerance * point.weigh({out.diffuse, out.lobe})) break;
        coarse = out.lobe;
    }
    return out;
}

}  // namespace crescent
