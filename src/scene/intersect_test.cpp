// The first intersection of a ray with a shape, against its definition: the point lies on the surface, the normal is
// unit and points outwards, and no part of the shape lies before the point. Random rays at random shapes of every kind.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "math/simd/frame.h"
#include "math/simd/random.h"
#include "scene/scene_data.h"

namespace crescent {
namespace intersect_test {

/// Numbers in [-1, 1], one after another.
class PrimarySample {
public:
    explicit PrimarySample(std::uint32_t seed) : seed_(seed) {}
    double operator()() { return 2.0 * static_cast<double>(draw(seed_, 0, k_++).x) - 1; }
    Vec3d vec(double scale = 1) { return {scale * (*this)(), scale * (*this)(), scale * (*this)()}; }

private:
    std::uint32_t seed_;
    std::uint64_t k_ = 0;
};

enum class ShapeKind { sphere, box, quad, disk, plane, panel };

/// The parameters of every kind, one of which is tested.
struct Sample {
    ShapeKind kind = ShapeKind::sphere;
    Vec3d center{}, min{}, max{}, corner{}, edge_u{}, edge_v{}, point{}, normal{};
    double radius = 0, depth = 0;

    Shapes::Any form() const {
        switch (kind) {
            case ShapeKind::sphere: return shapes::Sphere{center, radius};
            case ShapeKind::box: return shapes::Box{min, max};
            case ShapeKind::quad: return shapes::Quad{corner, edge_u, edge_v};
            case ShapeKind::disk: return shapes::Disk{center, normal, radius};
            case ShapeKind::plane: return shapes::Plane{point, normal};
            case ShapeKind::panel: return shapes::Panel{corner, edge_u, edge_v, depth, {}};
        }
        return {};
    }
};

Intersection intersect(const Sample& q, Vec3d x, Vec3d d) {
    return crescent::intersect({"", q.form(), {}, false, {}}, x, d);
}
Vec3d quad_normal(const Sample& q) { return normalize(cross(q.edge_u, q.edge_v)); }

constexpr std::array kinds = {
    ShapeKind::sphere, ShapeKind::box, ShapeKind::quad, ShapeKind::disk, ShapeKind::plane, ShapeKind::panel};

Sample some_shape(ShapeKind kind, PrimarySample& next) {
    Sample q;
    q.kind = kind;
    q.center = next.vec();
    q.point = next.vec();
    q.corner = next.vec();
    q.min = next.vec();
    q.radius = 0.2 + 0.6 * std::fabs(next());
    const Vec3d size = next.vec();
    q.max = q.min + Vec3d{0.1 + std::fabs(size.x), 0.1 + std::fabs(size.y), 0.1 + std::fabs(size.z)};
    q.normal = normalize(next.vec());
    q.edge_u = next.vec();
    const Vec3d across = cross(q.edge_u, next.vec());  // a panel is a rectangle
    q.edge_v = (0.3 + std::fabs(next())) * normalize(across);
    q.depth = 0.05 + 0.3 * std::fabs(next());
    return q;
}

/// Returns the distance of p from the plane, and whether its coordinates in the parallelogram u, v are within [0, 1] up
/// to `slack`.
bool on_parallelogram(Vec3d p, Vec3d corner, Vec3d u, Vec3d v, double slack) {
    const Vec3d n = normalize(cross(u, v)), w = cross(u, v), d = p - corner;
    const double a = dot(cross(d, v), w) / dot(w, w), b = dot(cross(u, d), w) / dot(w, w);
    return std::fabs(dot(d, n)) <= slack && a >= -slack && a <= 1 + slack && b >= -slack && b <= 1 + slack;
}

bool on_panel(const Sample& q, Vec3d p, bool reveal, double slack) {
    const Vec3d down = -q.depth * quad_normal(q);
    if (!reveal) return on_parallelogram(p, q.corner + down, q.edge_u, q.edge_v, slack);
    return on_parallelogram(p, q.corner, q.edge_u, down, slack) ||
        on_parallelogram(p, q.corner, q.edge_v, down, slack) ||
        on_parallelogram(p, q.corner + q.edge_v, q.edge_u, down, slack) ||
        on_parallelogram(p, q.corner + q.edge_u, q.edge_v, down, slack);
}

/// Returns whether the point lies on the shape's surface.
bool on_surface(const Sample& q, Vec3d p, bool reveal) {
    constexpr double slack = 1e-9;
    switch (q.kind) {
        case ShapeKind::sphere: return std::fabs(length(p - q.center) - q.radius) <= slack;
        case ShapeKind::box: {
            const double out =
                std::max({q.min.x - p.x, p.x - q.max.x, q.min.y - p.y, p.y - q.max.y, q.min.z - p.z, p.z - q.max.z});
            return std::fabs(out) <= slack;
        }
        case ShapeKind::quad: return on_parallelogram(p, q.corner, q.edge_u, q.edge_v, slack);
        case ShapeKind::disk:
            return std::fabs(dot(p - q.center, q.normal)) <= slack && length(p - q.center) <= q.radius + slack;
        case ShapeKind::plane: return std::fabs(dot(p - q.point, q.normal)) <= slack;
        case ShapeKind::panel: return on_panel(q, p, reveal, slack);
    }
    return false;
}

/// Returns the normal of the surface there by the shape's definition, up to its sign.
bool normal_fits(const Sample& q, Vec3d p, const Intersection& c) {
    const auto along = [&](Vec3d n) { return std::fabs(std::fabs(dot(c.n, n)) - 1) < 1e-9; };
    switch (q.kind) {
        case ShapeKind::sphere: return along(normalize(p - q.center)) && dot(c.n, p - q.center) > 0;
        case ShapeKind::box: {
            const Vec3d nearest = {std::min(std::fabs(p.x - q.min.x), std::fabs(p.x - q.max.x)),
                std::min(std::fabs(p.y - q.min.y), std::fabs(p.y - q.max.y)),
                std::min(std::fabs(p.z - q.min.z), std::fabs(p.z - q.max.z))};
            return (nearest.x < 1e-9 && along({1, 0, 0})) || (nearest.y < 1e-9 && along({0, 1, 0})) ||
                (nearest.z < 1e-9 && along({0, 0, 1}));
        }
        case ShapeKind::quad: return along(quad_normal(q));
        case ShapeKind::panel: return c.reveal ? std::fabs(dot(c.n, quad_normal(q))) < 1e-9 : along(quad_normal(q));
        default: return along(q.normal);
    }
}

template <class Visit> void for_each_ray(ShapeKind kind, Visit&& visit) {
    PrimarySample next(7 + static_cast<std::uint32_t>(kind));
    for (int k = 0; k < 20'000; ++k) {
        const Sample q = some_shape(kind, next);
        const Vec3d x = next.vec(3), towards = next.vec(1.2) - x;
        visit(q, x, normalize(towards));
    }
}

TEST(IntersectConformance, NearestPointIsOnTheSurfaceWithItsNormal) {
    for (const ShapeKind kind : kinds) {
        int hits = 0;
        for_each_ray(kind, [&](const Sample& q, Vec3d x, Vec3d d) {
            const Intersection c = intersect(q, x, d);
            if (!std::isfinite(c.t)) return;
            ++hits;
            const Vec3d p = x + c.t * d;
            ASSERT_GT(c.t, 0);
            ASSERT_LE(c.order, c.t);
            ASSERT_NEAR(length(c.n), 1, 1e-12);
            ASSERT_TRUE(on_surface(q, p, c.reveal)) << static_cast<int>(kind);
            ASSERT_TRUE(normal_fits(q, p, c)) << static_cast<int>(kind);
        });
        EXPECT_GT(hits, 400) << static_cast<int>(kind);
    }
}

/// Steps along the ray and returns whether it changes sides of a closed body, or crosses a flat one, before t.
bool crosses_before(const Sample& q, Vec3d x, Vec3d d, double t) {
    constexpr int steps = 400;
    const auto inside = [&](Vec3d p) {
        if (q.kind == ShapeKind::sphere) return length(p - q.center) < q.radius;
        return p.x > q.min.x && p.x < q.max.x && p.y > q.min.y && p.y < q.max.y && p.z > q.min.z && p.z < q.max.z;
    };
    const bool at_start = inside(x);
    for (int k = 1; k < steps; ++k)
        if (inside(x + (t * (k / double{steps}) * (1 - 1e-9)) * d) != at_start) return true;
    return false;
}

TEST(IntersectConformance, NothingOfAClosedBodyStandsBeforeIt) {
    for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::box})
        for_each_ray(kind, [&, k = 0](const Sample& q, Vec3d x, Vec3d d) mutable {
            if (k++ % 10 != 0) return;
            const Intersection c = intersect(q, x, d);
            ASSERT_FALSE(crosses_before(q, x, d, std::isfinite(c.t) ? c.t : 8)) << static_cast<int>(kind);
        });
}

TEST(IntersectConformance, ASmallSphereFarAwayIsMetWhereItIs) {
    PrimarySample next(11);
    for (const double far : {1e2, 1e4, 1e5})
        for (int k = 0; k < 300; ++k) {
            const double radius = 1e-8 * far, off = std::fabs(next());
            const Vec3d way = normalize(next.vec()), x = next.vec();
            Sample q;
            q.center = x + far * way;
            q.radius = radius;
            const Vec3d aim = q.center + 2 * off * radius * frame_about(way).t;
            if (std::fabs(2 * off - 1) < 1e-3) continue;
            EXPECT_EQ(intersect(q, x, normalize(aim - x)).t < far + 1, 2 * off < 1) << far << " m, " << 2 * off;
        }
}

TEST(IntersectConformance, FromInsideABodyTheFarWallIsMet) {
    PrimarySample next(3);
    for (int k = 0; k < 2000; ++k) {
        const Sample ball = some_shape(ShapeKind::sphere, next), box = some_shape(ShapeKind::box, next);
        const Vec3d d = normalize(next.vec());
        const Intersection c = intersect(ball, ball.center, d);
        EXPECT_NEAR(c.t, ball.radius, 1e-12);
        const Vec3d middle = 0.5 * (box.min + box.max);
        const Intersection wall = intersect(box, middle, d);
        EXPECT_TRUE(std::isfinite(wall.t) && on_surface(box, middle + wall.t * d, false));
    }
}

TEST(IntersectConformance, PanelsAreEnteredOnlyFromTheFront) {
    PrimarySample next(5);
    int reveals = 0;
    for (int k = 0; k < 20'000; ++k) {
        const Sample q = some_shape(ShapeKind::panel, next);
        const Vec3d n = quad_normal(q),
                    in_it = q.corner + (0.5 + 0.5 * next()) * q.edge_u + (0.5 + 0.5 * next()) * q.edge_v;
        const Vec3d x = in_it + (0.2 + std::fabs(next())) * n + next.vec(0.5) - 0.0 * n;
        if (dot(x - q.corner, n) <= 0) continue;
        const Vec3d d = normalize(in_it - x);
        const Intersection c = intersect(q, x, d);
        ASSERT_TRUE(std::isfinite(c.t));
        EXPECT_GE(c.t, length(in_it - x) - 1e-9);                     // behind the opening
        EXPECT_NEAR(c.order, length(in_it - x), 1e-6);                // but ordered by its opening
        EXPECT_LE(dot(q.corner - (x + c.t * d), n), q.depth + 1e-9);  // not deeper than the panel
        EXPECT_FALSE(std::isfinite(intersect(q, in_it - 2.0 * n, n).t));
        reveals += c.reveal;
    }
    EXPECT_GT(reveals, 1000);
}

}  // namespace intersect_test
}  // namespace crescent
