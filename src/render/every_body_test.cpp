// Tests that every kind of body agrees with itself, newly added kinds included: what it hides from a point, the
// kernels' shadow test and its extent are compared with the point where a camera ray meets it. Bodies of about 1 m with
// random parameters; m.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/disk_hit.h"

namespace crescent {
namespace every_body_test {

class Drawn {
public:
    explicit Drawn(unsigned seed) : next_(seed) {}
    double between(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(next_); }
    Vec3d place(double far) { return {between(-far, far), between(-far, far), between(-far, far)}; }
    /// Parameters that do not contradict each other.
    template <class Kind> Kind body() {
        for (;;) {
            Kind out;
            for (const Parameter<Kind>& p : Kind::parameters()) {
                if (const auto* v = std::get_if<Vec3d Kind::*>(&p.member))
                    out.*(*v) = p.unit_vector ? normalize(place(1)) : place(1);
                if (const auto* x = std::get_if<double Kind::*>(&p.member)) out.*(*x) = between(0.2, 1);
                if (const auto* b = std::get_if<bool Kind::*>(&p.member)) out.*(*b) = between(-1, 1) > 0;
            }
            if constexpr (requires { out.mistake(); })
                if (out.mistake()) continue;
            return out;
        }
    }

private:
    std::mt19937 next_;
};

/// Returns whether a camera ray meets it between the fractions lo and hi of the way d.
bool crosses(const auto& body, Vec3d x, Vec3d d, double lo, double hi) {
    return body.intersect(x + lo * d, d).t < hi - lo;
}
/// Like crosses; empty if a step of 1e-5 sideways or along the way changes the result.
std::optional<bool> surely_crosses(const auto& body, Vec3d x, Vec3d d) {
    constexpr double step = 1e-5;
    const auto [lo, hi] = before_light;
    const bool is = crosses(body, x, d, lo, hi);
    for (const Vec3d by : {Vec3d{step, 0, 0}, {0, step, 0}, {0, 0, step}})
        for (const double sign : {-1.0, 1.0})
            if (crosses(body, x + sign * by, d, lo, hi) != is || crosses(body, x, d, lo + sign * step, hi) != is ||
                crosses(body, x, d, lo, hi + sign * step) != is)
                return {};
    return is;
}

template <class Call> void for_each_body(Call&& f) {
    [&]<class... Kind>(KindList<Kind...>) { (f.template operator()<Kind>(), ...); }(Bodies{});
}

TEST(EveryBody, HiddenEdgePartsMatchCameraRays) {
    for_each_body([]<class Kind>() {
        Drawn draw(3);
        int hidden = 0, seen = 0, off = 0;
        for (int k = 0; k < 3000; ++k) {
            const Kind body = draw.body<Kind>();
            const Vec3d x = draw.place(2), y0 = draw.place(2), y1 = draw.place(2);
            const auto parts = body.hidden({x, y0 - x, y1 - y0, before_light});
            for (int j = 0; j < 8; ++j) {
                const double v = draw.between(0, 1);
                const auto is = surely_crosses(body, x, y0 + v * (y1 - y0) - x);
                if (!is) continue;
                const auto within = [&](Interval i) { return v > i.lo && v < i.hi; };
                ++(*is ? hidden : seen);
                off += (within(parts[0]) || within(parts[1])) != *is;
            }
        }
        EXPECT_EQ(off, 0) << Kind::name << "::hidden, of " << hidden + seen;
        EXPECT_GT(std::min(hidden, seen), 300) << Kind::name;
    });
}

TEST(EveryBody, KernelShadowsMatchCameraRays) {
    for_each_body([]<class Kind>() {
        Drawn draw(4);
        int hidden = 0, seen = 0, off = 0;
        const auto single = [](Vec3d v) {
            return Vec3<float>{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
        };
        for (int k = 0; k < 20000; ++k) {
            const Kind body = draw.body<Kind>();
            const Vec3d origin = draw.place(1), x = draw.place(2), way = draw.place(2) - x;
            const double far = std::sqrt(dot(way, way));
            const auto is = surely_crosses(body, x, way);
            if (!is) continue;
            const OccluderF packed = occluder_about({body, -1}, origin);
            const bool blocked =
                blocked_by<float>(packed, single(x - origin), single((1 / far) * way), static_cast<float>(far));
            ++(*is ? hidden : seen);
            off += blocked != *is;
        }
        EXPECT_EQ(off, 0) << Kind::name << "::blocks, of " << hidden + seen;
        EXPECT_GT(std::min(hidden, seen), 300) << Kind::name;
    });
}

TEST(EveryBody, PointsAreWithinExtentAndAzimuths) {
    for_each_body([]<class Kind>() {
        Drawn draw(5);
        int met = 0;
        for (int k = 0; k < 5000; ++k) {
            const Kind body = draw.body<Kind>();
            const Vec3d x = draw.place(2), d = body.middle() + draw.place(1) - x;
            const Vec3d axis = normalize(draw.place(1)), from = draw.place(2);
            const double t = body.intersect(x, d).t;
            EXPECT_TRUE(t < never || !body.holds(x)) << Kind::name << "::holds a point that a ray leaves unmet";
            if (!(t < 1e3)) continue;  // an infinite body is tested only near the camera
            ++met;
            const Vec3d p = x + t * d;
            EXPECT_LE(std::fabs(dot(axis, p - body.middle())), body.half_extent(axis) * (1 + 1e-9) + 1e-9)
                << Kind::name << "::middle, half_extent";
            const Frame<double> frame = frame_about(axis);
            const double phi = std::atan2(dot(p - from, frame.b), dot(p - from, frame.t));
            EXPECT_TRUE(body.azimuths(from, frame).meet(phi - 1e-9, phi + 1e-9)) << Kind::name << "::azimuths";
        }
        EXPECT_GT(met, 300) << Kind::name;
    });
}

}  // namespace every_body_test
}  // namespace crescent
