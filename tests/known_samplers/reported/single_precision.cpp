// Samplers that compute in single precision, with visible effects: half vectors by their cosine, which rounds to 1 in
// the middle of a sharp lobe and has steps around it; cumulative sums in float; values of f with few digits left.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "math/functions.h"
#include "math/simd/random.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/known_samplers/reported/known.h"

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
    float drawn_alpha;   // correct if it equals alpha
    float mirrored = 0;  // a share of the draws that goes to the mirror direction; correct if 0

    Draw sample(Vec3d wo, const PrimarySample& u) const {
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

SyntheticSampler of_ggx(const FloatGgx& ggx) {
    SyntheticSampler r{"GGX in float", "", {}, {}, {}};
    r.sample = [ggx](Vec3d wo, const PrimarySample& u) { return ggx.sample(wo, u); };
    r.pdf = [ggx](Vec3d wo, Vec3d wi) { return ggx.pdf(wo, wi); };
    return r;
}

/// A uniform sphere whose draws are denser below by `tilt` (1 + tilt cos theta over 4 pi), which the pdf omits.
SyntheticSampler tilted_sphere(float tilt) {
    SyntheticSampler r{"a sphere in float", "", {}, {}, {}};
    r.sample = [tilt](Vec3d, const PrimarySample& u) {
        const float x = static_cast<float>(u[0]), phi = 6.2831853f * static_cast<float>(u[1]), from = 1 - tilt;
        const float t = tilt > 0 ? (std::sqrt(from * from + 4 * tilt * x) - from) / (2 * tilt) : x;
        const float z = 2 * t - 1, sin = std::sqrt(std::max(0.0f, 1 - z * z));
        return Draw{{sin * std::cos(phi), sin * std::sin(phi), z}, 0.25 / pi};
    };
    r.pdf = [](Vec3d, Vec3d) { return 0.25 / pi; };
    r.traits.wo = Traits::WoDomain::none;
    return r;
}

/// A sky of texels in theta x phi with a sun, drawn by cumulative sums in
/// float.
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
    Draw sample(const PrimarySample& u) const {
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

/// lines: every texel of a row is drawn along its middle, for any first number.
SyntheticSampler float_sky(std::size_t width, std::size_t height, bool lines = false) {
    const auto sky = std::make_shared<const FloatSky>(width, height, lines);
    SyntheticSampler r{"a sky in float", "", {}, {}, {}};
    r.sample = [sky](Vec3d, const PrimarySample& u) { return sky->sample(u); };
    r.pdf = [sky](Vec3d, Vec3d w) { return sky->pdf(w); };
    r.traits.wo = Traits::WoDomain::none;
    return r;
}

/// A lobe cos^s about n whose cosine is rounded to float, with its sine by sqrt(1 - cos^2).
SyntheticSampler float_lobe(float s) {
    const auto p = [s](double cos) { return cos > 0 ? (s + 1) / (2 * pi) * math::pow(cos, double(s)) : 0.0; };
    SyntheticSampler r{"Phong lobe in floats", std::to_string(s), {}, {}, {}};
    r.sample = [p, s](Vec3d, const PrimarySample& u) {
        const float c = std::pow(static_cast<float>(u[0]), 1 / (s + 1)), si = std::sqrt(1 - c * c);
        const float turn = 6.2831853f * static_cast<float>(u[1]);
        return Draw{{si * std::cos(turn), si * std::sin(turn), c}, p(c)};
    };
    r.pdf = [p](Vec3d, Vec3d w) { return p(w.z); };
    return r;
}

/// f falls to 1e-43 and below, and so do weights.
SyntheticSampler velvet() {
    SyntheticSampler r{"a velvet", "", {}, {}, {}};
    const auto f = [](Vec3d wi) { return static_cast<double>(static_cast<float>(0.1 * std::exp(-100 * (1 - wi.z)))); };
    r.sample = [f](Vec3d, const PrimarySample& u) {
        Draw d{math::spherical(std::sqrt(1 - u[0] * u[0]), u[0], 2 * pi * u[1]), 1 / (2 * pi)};
        d.weight = static_cast<double>(static_cast<float>(f(d.wi)) * static_cast<float>(d.wi.z / d.pdf));
        return d;
    };
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 1 / (2 * pi) : 0; };
    r.f = [f](Vec3d, Vec3d wi) { return wi.z > 0 ? f(wi) : 0; };
    r.traits.reciprocal = false;
    return r;
}

/// The sampler draws numbers of its own, of 24 bits each.
SyntheticSampler with_own_numbers(SyntheticSampler r) {
    r.traits.own_random = true;
    r.sample = [right = r.sample](Vec3d wo, const PrimarySample& u) {
        const auto bits = [](double x) { return static_cast<std::uint32_t>(x * 0x1p24); };
        const auto h = pcg4d<std::uint32_t>({bits(u[0]), bits(u[1]), 7, 77});
        return right(wo, Vec2d{(h.x >> 8) * 0x1p-24, (h.y >> 8) * 0x1p-24});
    };
    return r;
}

}  // namespace

std::vector<KnownSampler> single_precision_samplers() {
    KnownList list;
    // Sharp lobes have their half vectors on rings, at the cosines that float can represent: 3e-4 apart next to the
    // axis.
    for (float alpha : {0.002f, 0.003f, 0.005f, 0.01f, 0.02f, 0.03f, 0.1f})
        list.right("GGX in float, alpha = " + std::to_string(alpha), of_ggx({alpha, alpha}), {0, 30, 60});
    list.wrong("GGX in float drawn 10 % too wide", "density", of_ggx({0.01f, 0.011f}), {0, 60});
    list.wrong("GGX in float with an atom", "identity", of_ggx({0.01f, 0.01f, 0.05f}), {0, 60});
    list.right("sphere in float", tilted_sphere(0), {0});
    list.wrong("sphere in float tilted by 1 %", "", tilted_sphere(0.01f), {0});
    list.wrong("sphere in float tilted by 4 %", "", tilted_sphere(0.04f), {0});
    list.right("sky in float, 64 x 32", float_sky(64, 32), {0});
    list.right("sky in float, 512 x 256", float_sky(512, 256), {0});
    list.right("sky in float, 2048 x 1024", float_sky(2048, 1024), {0});
    list.wrong("sky of lines", "", float_sky(256, 128, true), {0});
    for (float s : {500.0f, 5000.0f}) list.right("lobe in float, s = " + std::to_string(s), float_lobe(s), {0, 60});
    list.right("lobe in float with its own numbers", with_own_numbers(float_lobe(1e4f)), {0});
    for (const auto& [cells, sun] : {std::pair{16, 5.0}, {8, 0.5}, {32, 40.0}})
        list.right("bilinear sky in float", smooth_sky(cells, sun), {0});
    list.right("velvet", velvet());
    return list.take();
}

}  // namespace crescent
