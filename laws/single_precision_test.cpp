// Right samplers that compute in single precision, where that shows: half vectors by their cosine, which rounds to 1
// over the middle of a sharp lobe and moves in steps around it; values of f that have few digits left. A fault is found
// in them all the same.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <utility>
#include <vector>

#include "judgements/summary.h"
#include "laws/judged.h"
#include "laws/right/law.h"
#include "math/spherical.h"

namespace crescent {
namespace {

struct V {
    float x, y, z;
};
V narrow(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
float inner(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// GGX by D cos, all in float: the half vector by its cosine, its sine by sqrt(1 - cos^2).
struct FloatGgx {
    float alpha;
    float drawn_alpha;   // right where it is alpha
    float mirrored = 0;  // a share of the draws that goes to the mirror direction; right where it is 0

    Draw sample(Vec3d wo, const Numbers& u) const {
        const V o = narrow(wo);
        const float v = static_cast<float>(u[0]), phi = 6.2831853f * static_cast<float>(u[1]);
        float c = 1 / std::sqrt(1 + drawn_alpha * drawn_alpha * v / (1 - v));
        if (static_cast<float>(u[1]) < mirrored) c = 1;
        const float s = std::sqrt(std::max(0.0f, 1 - c * c));
        const V m = {s * std::cos(phi), s * std::sin(phi), c};
        const float d = 2 * inner(o, m);
        const V i = {d * m.x - o.x, d * m.y - o.y, d * m.z - o.z};
        if (!(d > 0) || !(i.z > 0)) return {{0, 0, 1}, 0};
        const Vec3d wi = {i.x, i.y, i.z};
        return {wi, pdf(wo, wi)};
    }
    double pdf(Vec3d wo, Vec3d wi) const {
        const V o = narrow(wo), i = narrow(wi);
        V m = {o.x + i.x, o.y + i.y, o.z + i.z};
        const float size = std::sqrt(inner(m, m));
        m = {m.x / size, m.y / size, m.z / size};
        if (!(o.z > 0) || !(i.z > 0) || !(inner(o, m) > 0)) return 0;
        const float sin2 = m.x * m.x + m.y * m.y, k = m.z * m.z * alpha * alpha + sin2;
        return static_cast<double>(alpha * alpha * m.z / (3.14159265f * k * k) / (4 * inner(o, m)));
    }
};

Recipe recipe_of(const FloatGgx& ggx) {
    Recipe r{"GGX in float", "", {}, {}, {}};
    r.sample = [ggx](Vec3d wo, const Numbers& u) { return ggx.sample(wo, u); };
    r.pdf = [ggx](Vec3d wo, Vec3d wi) { return ggx.pdf(wo, wi); };
    return r;
}

Judgement judged(const Recipe& r, double theta) { return judged_at(subject_of(r), theta, of_draws(32768)); }

TEST(SinglePrecision, OfASharpLobeIsNotAccused) {
    for (const float alpha : {0.003f, 0.005f, 0.008f, 0.01f, 0.03f})
        for (double theta : {0.0, 30.0, 60.0}) {
            const Judgement j = judged(recipe_of({alpha, alpha}), theta);
            EXPECT_NE(j.state, State::wrong) << alpha << " " << theta << "\n" << what_is_wrong(j);
            EXPECT_EQ(named(j, "density").state, State::right) << alpha << " " << theta << "\n" << what_is_wrong(j);
        }
}

TEST(SinglePrecision, OfASharpLobeHidesNoFault) {
    for (double theta : {0.0, 60.0}) {
        const Judgement wide = judged(recipe_of({0.01f, 0.011f}), theta);
        EXPECT_EQ(named(wide, "density").state, State::wrong) << theta << "\n" << what_is_wrong(wide);
        const Judgement atom = judged(recipe_of({0.01f, 0.01f, 0.05f}), theta);
        EXPECT_EQ(named(atom, "identity").state, State::wrong) << theta << "\n" << what_is_wrong(atom);
    }
}

/// An even sphere whose draws crowd below by `tilt` (1 + tilt cos theta over 4 pi), which pdf does not have.
Recipe tilted_sphere(float tilt) {
    Recipe r{"a sphere in float", "", {}, {}, {}};
    r.sample = [tilt](Vec3d, const Numbers& u) {
        const float x = static_cast<float>(u[0]), phi = 6.2831853f * static_cast<float>(u[1]), from = 1 - tilt;
        const float t = tilt > 0 ? (std::sqrt(from * from + 4 * tilt * x) - from) / (2 * tilt) : x;
        const float z = 2 * t - 1, sin = std::sqrt(std::max(0.0f, 1 - z * z));
        return Draw{{sin * std::cos(phi), sin * std::sin(phi), z}, 0.25 / pi};
    };
    r.pdf = [](Vec3d, Vec3d) { return 0.25 / pi; };
    r.traits.wo = Traits::Asked::none;
    return r;
}

TEST(SinglePrecision, HidesNoSmoothFaultThatNeighboursShowTogether) {
    const Judgement right = judged(tilted_sphere(0), 0);
    EXPECT_EQ(right.state, State::right) << what_is_wrong(right);
    for (const float tilt : {0.01f, 0.04f}) {
        const Judgement wrong = judged(tilted_sphere(tilt), 0);
        EXPECT_EQ(named(wrong, "identity").state, State::wrong) << tilt << "\n" << what_is_wrong(wrong);
    }
}

/// A sky of texels in theta x phi with a sun, drawn by cumulative sums in float.
class FloatSky {
public:
    FloatSky(std::size_t width, std::size_t height, bool lines)
        : width_(width),
          height_(height),
          lines_(lines),
          value_(width * height),
          columns_((width + 1) * height),
          rows_(height + 1) {
        double total = 0;
        for (std::size_t j = 0; j < height; ++j) {
            double sum = 0;
            for (std::size_t i = 0; i < width; ++i) {
                const double x = (i + 0.5) / width - 0.3, y = (j + 0.5) / height - 0.3;
                const double sky = 0.3 + std::exp(-3 * std::fabs(y)) + 60 * std::exp(-(x * x + y * y) / 6e-4);
                value_[j * width + i] = static_cast<float>(sky * std::sin(pi * (j + 0.5) / height));
                sum += value_[j * width + i];
                columns_[j * (width + 1) + i + 1] = static_cast<float>(sum);
            }
            for (std::size_t i = 0; i <= width; ++i) columns_[j * (width + 1) + i] /= static_cast<float>(sum);
            rows_[j + 1] = static_cast<float>(total += sum);
        }
        for (float& row : rows_) row /= static_cast<float>(total);
        mean_ = static_cast<float>(total / static_cast<double>(width * height));
    }
    Draw sample(const Numbers& u) const {
        const auto [j, y] = place(rows_.data(), height_, static_cast<float>(u[1]));
        const auto [i, x] = place(&columns_[j * (width_ + 1)], width_, static_cast<float>(u[0]));
        const float theta = 3.14159265f * y / height_, phi = 6.2831853f * (lines_ ? i + 0.5f : x) / width_;
        const float sin = std::sin(theta);
        const Vec3d wi = {sin * std::cos(phi), sin * std::sin(phi), std::cos(theta)};
        return {wi, pdf(wi)};
    }
    double pdf(Vec3d w) const {
        const float theta = std::acos(static_cast<float>(w.z)),
                    turn = std::atan2(static_cast<float>(w.y), static_cast<float>(w.x)) / 6.2831853f;
        const auto j = std::min(static_cast<std::size_t>(theta / 3.14159265f * height_), height_ - 1),
                   i = std::min(static_cast<std::size_t>((turn < 0 ? turn + 1 : turn) * width_), width_ - 1);
        const float sin = std::sin(theta);
        return sin > 0 ? static_cast<double>(value_[j * width_ + i] / (mean_ * 2 * 9.8696044f * sin)) : 0;
    }

private:
    static std::pair<std::size_t, float> place(const float* sums, std::size_t cells, float u) {
        const std::size_t k = std::min<std::size_t>(std::upper_bound(sums, sums + cells + 1, u) - sums - 1, cells - 1);
        return {k, k + std::min((u - sums[k]) / (sums[k + 1] - sums[k]), 0.999999f)};
    }
    std::size_t width_, height_;
    bool lines_;
    std::vector<float> value_, columns_, rows_;
    float mean_ = 1;
};

Judgement judged_sky(std::size_t width, std::size_t height, bool lines) {
    const auto sky = std::make_shared<const FloatSky>(width, height, lines);
    Recipe r{"a sky in float", "", {}, {}, {}};
    r.sample = [sky](Vec3d, const Numbers& u) { return sky->sample(u); };
    r.pdf = [sky](Vec3d, Vec3d w) { return sky->pdf(w); };
    r.traits.wo = Traits::Asked::none;
    return judged(r, 0);
}

/// The sums round the share of a dim texel by a few in a thousand: p |J| is off by that, to either side.
TEST(SinglePrecision, OfATablesSumsIsNotAccused) {
    for (const auto& [width, height] : {std::pair{64, 32}, {512, 256}, {2048, 1024}}) {
        const Judgement j = judged_sky(width, height, false);
        EXPECT_EQ(j.state, State::right) << width << "\n" << what_is_wrong(j);
    }
}

/// Every texel of a row is drawn along its middle, whatever the first number is.
TEST(SinglePrecision, DrawsNoLinesOfASky) {
    const Judgement j = judged_sky(256, 128, true);
    EXPECT_EQ(named(j, "identity").state, State::wrong) << what_is_wrong(j);
}

/// f falls to 1e-43 and further, weights with it: one in float, the other not.
TEST(SinglePrecision, OfNumbersBelowItsRangeIsNoDifference) {
    Recipe r{"a velvet", "", {}, {}, {}};
    const auto f = [](Vec3d, Vec3d wi) {
        return static_cast<double>(static_cast<float>(0.1 * std::exp(-100 * (1 - wi.z))));
    };
    r.sample = [f](Vec3d wo, const Numbers& u) {
        Draw d{math::spherical(std::sqrt(1 - u[0] * u[0]), u[0], 2 * pi * u[1]), 1 / (2 * pi)};
        d.weight = static_cast<double>(static_cast<float>(f(wo, d.wi)) * static_cast<float>(d.wi.z / d.pdf));
        return d;
    };
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 1 / (2 * pi) : 0; };
    r.f = [f](Vec3d wo, Vec3d wi) { return wi.z > 0 ? f(wo, wi) : 0; };
    r.traits.reciprocal = false;
    const Judgement j = judged(r, 45);
    EXPECT_EQ(named(j, "identity").state, State::right) << what_is_wrong(j);
}

}  // namespace
}  // namespace crescent
