// Faults that users reported, each with its corrected sampler, and right samplers that were reported wrong.
#include <fmt/format.h>

#include "tests/calibration/axial.h"
#include "tests/calibration/cases.h"
#include "tests/calibration/skies.h"
#include "tests/known_samplers/correct/renderers.h"

namespace crescent::calibration {

namespace {

using Wo = Traits::WoDomain;

struct Reported {
    const char* name;
    const char* cause;  // "" if none can be named
    Sampler (*make)(bool faulty);
    bool has_fault = true;
};

Sampler sampler(int numbers, Wo wo, std::variant<Functions<double>, Functions<float>> functions) {
    Sampler s;
    s.numbers = numbers;
    s.wo = wo;
    s.functions = std::move(functions);
    return s;
}

/// A spherical light whose pdf does not test whether w intersects it.
Sampler away(bool faulty) {
    const Vec3d axis = unit(Vec3d{-0.4, 0.3, 0.6});
    const double gap = 1 - std::sqrt(1 - 0.09), density = 1 / (2 * pi_of<double> * gap);
    Functions<double> f = single<double>(fixed<double>(axis), cone_profile<double>(gap));
    if (faulty) f.pdf = [density](Vec3d, Vec3d) { return density; };
    return sampler(2, Wo::none, f);
}
/// A small spherical light with 1 - cos in single precision.
Sampler cone_in_float(bool faulty) {
    const float r = 0.002f, s2 = r * r, cos = std::sqrt(1 - s2), gap = faulty ? 1 - cos : s2 / (1 + cos);
    const float density = 1 / (2 * pi_of<float> * gap);
    const Vec3f axis = unit(Vec3f{0.3f, -0.5f, 0.81f});
    const double rim = double(s2 / (1 + cos)) * (1 + 6e-5);  // directions are rounded by 3e-5 of the angle of the cone
    Functions<float> f;
    f.pdf = [=](Vec3f, Vec3f w) { return versine(widened(axis), widened(w)) <= rim ? density : 0.0f; };
    f.sample = [=](Vec3f, const float* u) {
        const float c = (1 - u[0]) + u[0] * cos;
        return Drawn<float>{off_axis(axis, faulty ? 1 - c : gap * u[0], u[1]), density};
    };
    return sampler(2, Wo::none, f);
}
/// A frame about -w_o that divides by the sign of zero.
Sampler frame_of_zero(bool faulty) {
    Functions<double> f = single<double>(forward<double>(), greenstein_profile<double>(0.5));
    if (faulty)
        f.sample = [sample = f.sample](Vec3d o, const double* u) {
            Drawn<double> d = sample(o, u);
            if (o.z == 0) d.wi = d.wi * std::nan("");
            return d;
        };
    f.f = f.pdf;
    return sampler(2, Wo::both, f);
}
/// A textured disk light: texels whose centre is outside the disk are never drawn.
Sampler border_texels(bool faulty) {
    constexpr int n = 16;
    constexpr double h = 1.5;
    std::vector<int> in;
    for (int k = 0; k < n * n; ++k) {
        const double x0 = -1 + 2.0 * (k % n) / n, y0 = -1 + 2.0 * (k / n) / n, side = 2.0 / n;
        const double x = faulty ? x0 + side / 2 : std::clamp(0.0, x0, x0 + side);
        const double y = faulty ? y0 + side / 2 : std::clamp(0.0, y0, y0 + side);
        if (x * x + y * y < 1) in.push_back(k);
    }
    const auto texel = [](double v) { return std::clamp(static_cast<int>((v + 1) / 2 * n), 0, n - 1); };
    const auto meets = [](Vec3d w) { return w.z > 0 && sqr(w.x / w.z * h) + sqr(w.y / w.z * h) < 1; };
    Functions<double> f;
    f.pdf = [=](Vec3d, Vec3d w) {
        if (!meets(w)) return 0.0;
        const int k = texel(w.x / w.z * h) + n * texel(w.y / w.z * h);
        if (!std::ranges::binary_search(in, k)) return 0.0;
        return n * n / 4.0 / static_cast<double>(in.size()) * h * h / (w.z * w.z * w.z);
    };
    f.f = [=](Vec3d, Vec3d w) { return meets(w) ? 0.5 / w.z : 0.0; };
    f.sample = [=, pdf = f.pdf](Vec3d o, const double* u) {
        const double at = u[0] * static_cast<double>(in.size());
        const std::size_t k = std::min(std::size_t(at), in.size() - 1);
        const Vec3d w = unit(Vec3d{-1 + 2 * (in[k] % n + at - double(k)) / n, -1 + 2 * (in[k] / n + u[1]) / n, h});
        return Drawn<double>{w, pdf(o, w)};
    };
    Sampler s = sampler(2, Wo::none, f);
    s.reciprocal = false;
    return s;
}
/// A leaf: the pdf of transmitted directions does not include the probability of transmission.
Sampler leaf(bool faulty) {
    constexpr double through = 0.1;
    Functions<double> f;
    f.pdf = [=](Vec3d o, Vec3d i) {
        return std::fabs(i.z) / pi_of<double> * (i.z * o.z > 0 ? 1 - through : faulty ? 1.0 : through);
    };
    f.f = [=](Vec3d o, Vec3d i) { return 0.8 / pi_of<double> * (i.z * o.z > 0 ? 1 - through : through); };
    f.sample = [=, pdf = f.pdf](Vec3d o, const double* u) {
        Vec3d i = cosine_weighted(u[0], u[1]);
        if ((o.z < 0) != (u[2] < through)) i = -i;
        return Drawn<double>{i, pdf(o, i)};
    };
    return sampler(3, Wo::both, f);
}
/// A sky of 32 x 16 texels mirrored between draw and pdf, with almost no variation from east to west.
Sampler mirrored_sky(bool faulty) {
    std::vector<double> radiance;
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 32; ++j)
            radiance.push_back(1 + 0.03 * std::sin(2 * pi_of<double> * (j + 0.5) / 32) + 0.5 * i / 16);
    Functions<double> f = sky_by_cdf<double>(16, 32, radiance, Broken::none);
    if (faulty) {
        f.pdf = sky_by_cdf<double>(16, 32, radiance, Broken::mirrored_table).pdf;
        f.sample = [sample = f.sample, pdf = f.pdf](Vec3d o, const double* u) {
            const Vec3d w = sample(o, u).wi;
            return Drawn<double>{w, pdf(o, w)};
        };
    }
    return sampler(2, Wo::none, f);
}
/// An azimuth whose random number is not used.
Sampler azimuth(bool faulty) {
    Functions<double> f = single<double>(forward<double>(), greenstein_profile<double>(0.6));
    f.f = f.pdf;
    if (faulty)
        f.sample = [sample = f.sample](Vec3d o, const double* u) {
            const double v[PrimarySample::most_numbers] = {u[0], 0.3 / (2 * pi_of<double>)};
            return sample(o, v);
        };
    return sampler(2, Wo::both, f);
}

/// 512 x 256 texels, smooth except for a sun of one texel, 10^4 times as bright; version 0.1 gave .998 for
/// `normalised`.
Sampler sun_of_a_texel(bool alias, Real real) {
    std::vector<double> radiance;
    for (int i = 0; i < 256; ++i)
        for (int j = 0; j < 512; ++j) {
            const double x = 2 * pi_of<double> * (j + 0.5) / 512, y = pi_of<double> * (i + 0.5) / 256;
            radiance.push_back(std::exp(2 * std::cos(y) + std::sin(x)) * (i == 30 && j == 130 ? 1e4 : 1));
        }
    return sky_sampler("", 256, 512, radiance, alias, real);
}
template <bool alias, Real real> Sampler sun(bool) { return sun_of_a_texel(alias, real); }
Sampler rough_glass(bool) {
    const RoughGlass g{0.3, 1.5};
    Functions<double> f;
    f.pdf = [g](Vec3d o, Vec3d i) { return g.pdf(o, i); };
    f.f = [g](Vec3d o, Vec3d i) { return g.f(o, i); };
    f.sample = [g](Vec3d o, const double* u) {
        PrimarySample v(u[0], u[1]);
        v[2] = u[2];
        const Draw d = g.sample(o, v);
        return Drawn<double>{d.wi, d.pdf};
    };
    Sampler s = sampler(3, Wo::both, f);
    s.eta = 1.5;
    return s;
}
Sampler sphere_in_float(bool) {
    const float s2 = 0.09f, gap = s2 / (1 + std::sqrt(1 - s2)), density = 1 / (2 * pi_of<float> * gap);
    Functions<float> f = single<float>(fixed<float>(unit(Vec3d{-0.512, 0.384, 0.768})),
        {[gap](float u) { return gap * u; }, [gap, density](float t) { return t <= gap ? density : 0.0f; }});
    f.sample = [sample = f.sample, density](Vec3f o, const float* u) { return Drawn<float>{sample(o, u).wi, density}; };
    return sampler(2, Wo::none, f);
}

constexpr Reported all[] = {{"away", "", away}, {"cone32", "", cone_in_float}, {"onb", "", frame_of_zero},
    {"texels", "", border_texels}, {"leaf", "chooser", leaf}, {"mirrored", "mirrored", mirrored_sky},
    {"azimuth", "curve", azimuth}, {"sky with a sun of a texel", "", sun<false, Real::f64>, false},
    {"sky with a sun of a texel, alias table", "", sun<true, Real::f64>, false},
    {"float sky 512 x 256", "", sun<false, Real::f32>, false},
    {"float sky 512 x 256, alias table", "", sun<true, Real::f32>, false}, {"rough glass", "", rough_glass, false},
    {"float sphere light", "", sphere_in_float, false}};

/// Each fault and its corrected sampler, then the right samplers.
std::vector<std::pair<const Reported*, bool>> listed() {
    std::vector<std::pair<const Reported*, bool>> out;
    for (const Reported& r : all) {
        if (r.has_fault) out.emplace_back(&r, true);
        out.emplace_back(&r, false);
    }
    return out;
}

}  // namespace

std::uint64_t count_reported() { return listed().size(); }

Case make_reported(const CaseKey& key) {
    const auto [reported, faulty] = listed().at(key.index);
    Sampler s = reported->make(faulty);
    s.family = reported->name;
    if (s.parameters.empty()) s.parameters = "as reported";
    Case c = case_of(s, key, faulty ? State::wrong : State::right, faulty ? "reported" : "right");
    if (faulty) c.cause = reported->cause;
    return c;
}

}  // namespace crescent::calibration
