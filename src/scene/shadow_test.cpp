// Random bodies between random points and disks: none of 200 segments crosses a body that is reported to hide nothing.
#include "scene/shadow.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "math/simd/frame.h"
#include "math/simd/random.h"

namespace crescent {
namespace shadow_test {

/// Numbers in [-1, 1], one after another.
class PrimarySample {
public:
    explicit PrimarySample(std::uint32_t seed) : seed_(seed) {}
    double operator()() { return 2.0 * static_cast<double>(draw(seed_, 0, 2 * k_++).x) - 1; }
    Vec3d vec(double scale = 1) { return {scale * (*this)(), scale * (*this)(), scale * (*this)()}; }

private:
    std::uint32_t seed_;
    std::uint64_t k_ = 0;
};

enum class Kind { sphere, box, quad, disk, plane };

Occluder some_body(Kind kind, Vec3d about, PrimarySample& next) {
    const Vec3d a = about + next.vec(0.8);
    const double radius = 0.3 * std::fabs(next());
    const Vec3d size = next.vec(0.5);
    switch (kind) {
        case Kind::sphere: return {shapes::Sphere{a, radius}};
        case Kind::box: return {shapes::Box{a, a + Vec3d{std::fabs(size.x), std::fabs(size.y), std::fabs(size.z)}}};
        case Kind::quad: return {shapes::Quad{a, size, next.vec(0.5)}};
        case Kind::disk: return {shapes::Disk{a, normalize(next.vec()), radius}};
        case Kind::plane: return {shapes::Plane{a, normalize(next.vec())}};
    }
    return {};
}

struct Obstacle {
    Occluder body;
    Extent from;
    DiskLight disk;
};

Obstacle some_obstacle(Kind kind, PrimarySample& next) {
    Obstacle s;
    const Vec3d half = next.vec(0.2);
    s.from = {next.vec(1.5), {std::fabs(half.x), std::fabs(half.y), std::fabs(half.z)}};
    s.disk.center = next.vec(1.5);
    s.disk.normal = normalize(next.vec());
    s.disk.radius = 0.3 * std::fabs(next());
    s.body = some_body(kind, 0.5 * (s.from.middle + s.disk.center), next);
    return s;
}

/// Returns the number of random segments from the points to the disk that the body crosses.
int hidden_segments(const Obstacle& s, PrimarySample& next, int segments) {
    const Frame<double> frame = frame_about(s.disk.normal);
    int hidden_ones = 0;
    for (int k = 0; k < segments; ++k) {
        const Vec3d x = s.from.middle + Vec3d{next() * s.from.half.x, next() * s.from.half.y, next() * s.from.half.z};
        const double r = s.disk.radius * std::sqrt(0.5 + 0.5 * next()), phi = pi * next();
        const Vec3d y = s.disk.center + frame.t * (r * std::cos(phi)) + frame.b * (r * std::sin(phi));
        const auto parts = hidden(s.body, x, y, y + 1e-9 * frame.t);
        hidden_ones += !parts[0].empty() || !parts[1].empty();
    }
    return hidden_ones;
}

TEST(IsSeparated, NeverPartsABodyFromSegmentsThatItCrosses) {
    for (const Kind kind : {Kind::sphere, Kind::box, Kind::quad, Kind::disk, Kind::plane}) {
        PrimarySample next(7 + static_cast<std::uint32_t>(kind));
        int clear = 0, unclear = 0, in_the_way = 0;
        for (int check_case = 0; check_case < 1000; ++check_case) {
            const Obstacle s = some_obstacle(kind, next);
            const bool parted = is_separated(s.body, s.from, s.disk.light().body());
            const int hidden_ones = hidden_segments(s, next, 200);
            EXPECT_FALSE(parted && hidden_ones > 0) << "body " << static_cast<int>(kind) << ", trial " << check_case;
            in_the_way += hidden_ones > 0;
            clear += parted;
            unclear += !parted && hidden_ones == 0;
        }
        // The test is useful: most bodies that hide nothing are recognised.
        EXPECT_GT(in_the_way, 20) << static_cast<int>(kind);
        EXPECT_GT(clear, 4 * unclear) << static_cast<int>(kind);
    }
}

TEST(PassesBy, IsNeverSaidOfABodyThatHidesSome) {
    for (const Kind kind : {Kind::sphere, Kind::box, Kind::quad, Kind::disk, Kind::plane}) {
        PrimarySample next(17 + static_cast<std::uint32_t>(kind));
        int clear = 0, in_the_way = 0;
        for (int check_case = 0; check_case < 1000; ++check_case) {
            Obstacle s = some_obstacle(kind, next);
            s.from.half = {};
            const bool passes = passes_by(ball_around(s.body), s.from.middle, {s.disk.center, s.disk.radius});
            const int hidden_ones = hidden_segments(s, next, 200);
            EXPECT_FALSE(passes && hidden_ones > 0) << "body " << static_cast<int>(kind) << ", trial " << check_case;
            in_the_way += hidden_ones > 0;
            clear += passes;
        }
        EXPECT_GT(in_the_way, 20) << static_cast<int>(kind);
        EXPECT_EQ(clear > 200, kind != Kind::plane) << static_cast<int>(kind);  // no ball contains a plane
    }
}

TEST(EachOpenPart, IsTheRestOfTheChord) {
    const auto parts_of = [](std::vector<Interval> hidden_parts) {
        std::vector<double> ends;
        each_open_part(hidden_parts, [&](Interval part) { ends.insert(ends.end(), {part.lo, part.hi}); });
        return ends;
    };
    EXPECT_EQ(parts_of({}), (std::vector<double>{0, 1}));
    EXPECT_EQ(parts_of({{0.5, 0.75}, {0.25, 0.5}, {0.9, 0.8}}), (std::vector<double>{0, 0.25, 0.75, 1}));
    EXPECT_EQ(parts_of({{0, 0.5}, {0.25, 1}}), (std::vector<double>{}));
}

}  // namespace shadow_test
}  // namespace crescent
