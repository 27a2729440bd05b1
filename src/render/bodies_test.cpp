// Bodies of every size that the schema permits, tested by the kernels in single precision against long double: rays
// that begin near a surface or an edge of a large body, and rays to small bodies far away. Lengths in m. Kinds without
// a form here (`Crosses`, `Draw::body`) are tested in every_body_test.cpp, at sizes of about 1 m.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "render/disk_hit.h"

namespace crescent {
namespace bodies_test {

using Long = long double;

struct Vec3l {
    Long x = 0, y = 0, z = 0;
    friend Vec3l operator+(Vec3l a, Vec3l b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3l operator-(Vec3l a, Vec3l b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3l operator*(Long k, Vec3l a) { return {k * a.x, k * a.y, k * a.z}; }
};
Long dot_of(Vec3l a, Vec3l b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3l cross_of(Vec3l a, Vec3l b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec3l long_of(Vec3d v) { return {v.x, v.y, v.z}; }

/// Returns whether the body's surface crosses x + t d, d unit, for some t in (lo, hi).
struct Crosses {
    Vec3l x, d;
    Long lo, hi;

    bool in(Long t) const { return t > lo && t < hi; }
    Long on_plane(Vec3l p, Vec3l n) const {
        const Long v = dot_of(n, d);
        return v == 0 ? -1 : dot_of(n, p - x) / v;
    }
    bool operator()(const shapes::Sphere& o) const {
        const Vec3l c = long_of(o.center) - x;
        const Long foot = dot_of(c, d);
        const Vec3l off = c - foot * d;
        const Long half2 = static_cast<Long>(o.radius) * o.radius - dot_of(off, off);
        return half2 > 0 && (in(foot - std::sqrt(half2)) || in(foot + std::sqrt(half2)));
    }
    bool operator()(const shapes::Box& o) const {
        Long near = -1e300L, far = 1e300L;
        const auto slab = [&](Long a, Long b, Long from, Long v) {
            const Long t0 = (a - from) / v, t1 = (b - from) / v;
            near = std::max(near, std::min(t0, t1));
            far = std::min(far, std::max(t0, t1));
        };
        slab(o.min.x, o.max.x, x.x, d.x);
        slab(o.min.y, o.max.y, x.y, d.y);
        slab(o.min.z, o.max.z, x.z, d.z);
        return near < far && (in(near) || in(far));
    }
    bool operator()(const shapes::Quad& o) const {
        const Vec3l u = long_of(o.edge_u), v = long_of(o.edge_v), n = cross_of(u, v);
        const Long t = on_plane(long_of(o.corner), n), nn = dot_of(n, n);
        const Vec3l p = x + t * d - long_of(o.corner);
        const Long a = dot_of(cross_of(p, v), n) / nn, b = dot_of(cross_of(u, p), n) / nn;
        return in(t) && a >= 0 && a <= 1 && b >= 0 && b <= 1;
    }
    bool operator()(const shapes::Disk& o) const {
        const Long t = on_plane(long_of(o.center), long_of(o.normal));
        const Vec3l p = x + t * d - long_of(o.center);
        return in(t) && dot_of(p, p) <= static_cast<Long>(o.radius) * o.radius;
    }
    bool operator()(const shapes::Plane& o) const { return in(on_plane(long_of(o.point), long_of(o.normal))); }
};

/// Returns the indices among Bodies of the kinds that have a form here.
std::vector<std::size_t> known_bodies() {
    std::vector<std::size_t> out;
    for (std::size_t kind = 0; kind < Bodies::count; ++kind)
        std::visit(
            [&](const auto& body) {
                if constexpr (std::is_invocable_v<const Crosses&, decltype(body)>) out.push_back(kind);
            },
            Bodies::make(kind));
    return out;
}

class Draw {
public:
    explicit Draw(unsigned seed) : next_(seed) {}
    double between(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(next_); }
    Vec3d direction() {
        const double y = between(-1, 1), phi = between(-pi, pi), r = std::sqrt(1 - y * y);
        return {r * std::cos(phi), y, r * std::sin(phi)};
    }
    Vec3d near(Vec3d p, double far) { return p + between(0, far) * direction(); }
    /// Returns an inner point of an edge of length 1, one of its ends, or its middle.
    double along() {
        const int kind = static_cast<int>(between(0, 4));
        return kind == 0 ? 0 : kind == 1 ? 1 : kind == 2 ? 0.5 : between(0, 1);
    }
    /// Returns a body of a kind and size with p on it; in half of the cases p lies on its edge, if it has one.
    Bodies::Any body(std::size_t kind, double size, Vec3d p) {
        Bodies::Any out = Bodies::make(kind);
        const Vec3d n = direction();
        const Frame<double> frame = frame_about(n);
        if (auto* sphere = std::get_if<shapes::Sphere>(&out)) *sphere = {p - size * n, size};
        if (auto* box = std::get_if<shapes::Box>(&out)) {
            const Vec3d at = {along() * size, along() * 0.5 * size, along() * 2 * size};
            *box = {p - at, p - at + size * Vec3d{1, 0.5, 2}};
        }
        if (auto* quad = std::get_if<shapes::Quad>(&out)) {
            const Vec3d u = size * frame.t, v = 0.3 * size * frame.t + 0.7 * size * frame.b;
            *quad = {p - along() * u - along() * v, u, v};
        }
        if (auto* disk = std::get_if<shapes::Disk>(&out))
            *disk = {p - (between(0, 2) < 1 ? 1 : between(0, 1)) * size * frame.t, n, size};
        if (auto* plane = std::get_if<shapes::Plane>(&out)) *plane = {p + size * frame.t, n};
        return out;
    }

private:
    std::mt19937 next_;
};

Vec3<float> single(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
Vec3d exact(Vec3<float> v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }

/// Counts the rays from o = origin + offset along d to a light at `distance` on which a kernel and long double differ.
/// Only rays with the same result from all points within `tolerance` of o count.
struct Count {
    int rays = 0, hidden = 0, off = 0;

    void take(
        const Bodies::Any& body, Vec3d origin, Vec3<float> offset, Vec3<float> d, float distance, Long tolerance) {
        const Long size = std::sqrt(dot_of(long_of(exact(d)), long_of(exact(d))));
        const Vec3l way = (1 / size) * long_of(exact(d)), from = long_of(origin) + long_of(exact(offset));
        const auto truth = [&](Vec3l by, Long end) {
            const Long far = static_cast<Long>(distance);
            const Crosses crosses{from + by, way, 1e-5L * far + end, (1 - 1e-5L) * far - end};
            return std::visit(
                [&](const auto& form) {
                    if constexpr (std::is_invocable_v<const Crosses&, decltype(form)>) return crosses(form);
                    else return false;
                },
                body);
        };
        const bool is = truth({}, 0);
        for (const Vec3l by : {Vec3l{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
            for (const Long sign : {-1.0L, 1.0L})
                if (truth(sign * tolerance * by, 0) != is || truth({}, sign * tolerance) != is) return;
        ++rays;
        hidden += is;
        off += is != blocked_by<float>(occluder_about({body, -1}, origin), offset, d, distance);
    }
};

std::string called(std::size_t kind, double size) {
    return std::string(Bodies::names[kind]) + " of " + std::to_string(size) + " m";
}

TEST(BodiesInKernels, OfAnySizeHideWhatTheyHide) {
    Draw draw(5);
    for (const Vec3d origin : {Vec3d{0, 0, 0}, {-4e5, 3e5, 1e5}})
        for (const std::size_t kind : known_bodies())
            for (const double size : {1e-2, 1.0, 30.0, 1e3, 1e4, 1e6}) {
                Count count;
                for (int k = 0; k < 3000; ++k) {
                    const double far = std::min(size, 1.0);  // scenes are as large as their small bodies
                    const Bodies::Any body = draw.body(kind, size, draw.near(origin, far));
                    const float distance = static_cast<float>(draw.between(0.1, 3) * far);
                    count.take(body, origin, single(draw.near({}, far)), single(draw.direction()), distance,
                        3e-6L * (static_cast<Long>(far) + static_cast<Long>(distance)));
                }
                EXPECT_EQ(count.off, 0) << called(kind, size) << ", " << count.rays << " rays";
                EXPECT_GT(count.hidden, 30) << called(kind, size);
                EXPECT_GT(count.rays - count.hidden, 300) << called(kind, size);
            }
}

TEST(BodiesInKernels, ThatAreSmallAndFarHideWhatTheyHide) {
    Draw draw(6);
    for (const double far : {1e2, 1e4, 3e5})
        for (const std::size_t kind : known_bodies()) {
            Count count;
            const double size = 1e-3 * far;
            for (int k = 0; k < 3000; ++k) {
                const Vec3d at = far * draw.direction();
                const Bodies::Any body = draw.body(kind, size, at);
                const Vec3d o = draw.near({}, 1), way = draw.near(at, 2 * size) - o;
                const Vec3d d = (1 / std::sqrt(dot(way, way))) * way;
                count.take(body, {}, single(o), single(d), static_cast<float>(2 * far), 1e-6L * static_cast<Long>(far));
            }
            EXPECT_EQ(count.off, 0) << called(kind, size) << ", " << far << " m away, " << count.rays << " rays";
            EXPECT_GT(count.hidden, 30) << called(kind, size);
        }
}

}  // namespace bodies_test
}  // namespace crescent
