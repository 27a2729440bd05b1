// box: an axis-aligned box, from its lowest corner to its highest.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "scene/body.h"

namespace crescent::shapes {

/// t range of a slab; a component of 0 is changed slightly so that no 0/0 arises.
template <class F> void clip_slab(F lo, F hi, F o, F d, F& near, F& far) {
    const F safe = select(abs(d) > number<F>(1e-20), d, number<F>(1e-20));
    const F t0 = (lo - o) / safe, t1 = (hi - o) / safe;
    near = larger(near, smaller(t0, t1));
    far = smaller(far, larger(t0, t1));
}

struct Box {
    static constexpr std::string_view name = "box";
    static constexpr std::string_view summary = "an axis-aligned box";
    Vec3d min{}, max{};

    static constexpr auto parameters() {
        return std::array{parameter::place("min", &Box::min, "Lowest corner of an axis-aligned box."),
            parameter::place("max", &Box::max, "Highest corner; above min on every axis.")};
    }
    std::optional<Mistake> mistake() const {
        const Vec3d size = max - min;
        if (!(size.x > 0)) return Mistake{"max", "expected a corner above min on every axis, found x no higher on x"};
        if (!(size.y > 0)) return Mistake{"max", "expected a corner above min on every axis, found y no higher on y"};
        if (!(size.z > 0)) return Mistake{"max", "expected a corner above min on every axis, found z no higher on z"};
        return {};
    }

    Intersection intersect(Vec3d x, Vec3d d) const {
        double near = -never, far = never;
        Vec3d near_n{}, far_n{};
        const auto slab = [&](double lo, double hi, double o, double v, Vec3d axis) {
            if (v == 0) {
                if (o < lo || o > hi) near = never;
                return;
            }
            double t0 = (lo - o) / v, t1 = (hi - o) / v;
            if (t0 > t1) std::swap(t0, t1);
            if (t0 > near) {
                near = t0;
                near_n = axis;
            }
            if (t1 < far) {
                far = t1;
                far_n = axis;
            }
        };
        slab(min.x, max.x, x.x, d.x, {1, 0, 0});
        slab(min.y, max.y, x.y, d.y, {0, 1, 0});
        slab(min.z, max.z, x.z, d.z, {0, 0, 1});
        if (near > far || far <= 0) return {};
        return near > 0 ? crossing_at(near, near_n) : crossing_at(far, far_n);
    }

    /// The strip between the ways' starts and ends, cut by the box: its points x + a d(0) + b d(1), a + b in `limits`,
    /// inside the six half-spaces form a convex polygon in (a, b); each of its corners is seen at v = b / (a + b).
    std::array<Interval, 2> hidden(const Sight& s) const {
        Strip strip(s.limits);
        const Vec3d x = s.x, d0 = s.d0, d1 = s.d0 + s.step;
        strip.cut(x.x - min.x, d0.x, d1.x);
        strip.cut(max.x - x.x, -d0.x, -d1.x);
        strip.cut(x.y - min.y, d0.y, d1.y);
        strip.cut(max.y - x.y, -d0.y, -d1.y);
        strip.cut(x.z - min.z, d0.z, d1.z);
        strip.cut(max.z - x.z, -d0.z, -d1.z);
        return Met{strip.way(), strip.start, strip.end}.crossed();
    }
    bool holds(Vec3d x) const {
        return x.x >= min.x && x.x <= max.x && x.y >= min.y && x.y <= max.y && x.z >= min.z && x.z <= max.z;
    }

    Vec3d middle() const { return 0.5 * (min + max); }
    double half_extent(Vec3d axis) const {
        const Vec3d half = 0.5 * (max - min);
        return std::fabs(axis.x) * half.x + std::fabs(axis.y) * half.y + std::fabs(axis.z) * half.z;
    }
    std::array<Vec3d, 3> faces() const { return {Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; }
    std::array<Vec3d, 8> corners() const {
        std::array<Vec3d, 8> out;
        for (unsigned k = 0; k < 8; ++k) out[k] = {k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z};
        return out;
    }
    Azimuths azimuths(Vec3d x, const Frame<double>& frame) const { return azimuths_of_corners(corners(), x, frame); }

    BodyNumbers numbers(Vec3d origin) const {
        return {.a = min - origin, .b = max - origin, .c = {}, .radius = 0, .offset = 0};
    }
    template <class F> static MaskOf<F> blocks(const PackedBody<F>& body, Vec3<F> o, Vec3<F> d, F lo, F hi) {
        F near = number<F>(-1e30), far = number<F>(1e30);
        clip_slab(body.a.x, body.b.x, o.x, d.x, near, far);
        clip_slab(body.a.y, body.b.y, o.y, d.y, near, far);
        clip_slab(body.a.z, body.b.z, o.z, d.z, near, far);
        return (near < far) & (within(near, lo, hi) | within(far, lo, hi));
    }

private:
    struct Corner {
        double a, b;
    };
    struct Strip {
        double from, to;
        std::array<Corner, 16> polygon, next;  // at most one corner more a cut
        std::size_t size = 4;
        Interval start{0, 1}, end{0, 1};

        explicit Strip(Between limits)
            : from(limits.from), to(limits.to), polygon{{{from, 0}, {to, 0}, {0, to}, {0, from}}} {}
        void cut(double h, double h0, double h1) {  // keep h + a h0 + b h1 >= 0
            start = both(start, where_positive(h + from * h0, h + from * h1));
            end = both(end, where_positive(h + to * h0, h + to * h1));
            std::size_t corner_count = 0;
            for (std::size_t i = 0; i < size; ++i) {
                const Corner p = polygon[i], q = polygon[i + 1 < size ? i + 1 : 0];
                const double hp = h + p.a * h0 + p.b * h1, hq = h + q.a * h0 + q.b * h1;
                if (hp >= 0) next[corner_count++] = p;
                if ((hp >= 0) != (hq >= 0)) {
                    const double t = hp / (hp - hq);
                    next[corner_count++] = {p.a + t * (q.a - p.a), p.b + t * (q.b - p.b)};
                }
            }
            polygon = next;
            size = corner_count;
        }
        Interval way() const {
            Interval out{never, -never};
            for (std::size_t i = 0; i < size; ++i) {
                const double v = polygon[i].b / (polygon[i].a + polygon[i].b);
                out = {std::min(out.lo, v), std::max(out.hi, v)};
            }
            return out;
        }
    };
};

}  // namespace crescent::shapes
