// FLIP (Andersson et al. 2020) and HDR-FLIP (Andersson et al. 2021), with their constants: contrast sensitivities as
// Gaussians, HyAB after Hunt's adjustment, edges and points of lightness. Distances in degrees of view are converted to
// pixels by ppd, pixels per degree. ColourPlanes are float, sums double.
#include "compare/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "math/functions.h"
#include "math/statistics.h"

namespace crescent::inline comparison {

namespace {

using Plane = std::vector<float>;
using ColourPlanes = std::array<Plane, 3>;
using Triple = std::array<double, 3>;

constexpr double pi = std::numbers::pi;

// --- colour spaces: linear Rec.709 -> XYZ (IEC 61966-2-1) -> YyCxCz and CIELAB, white (1, 1, 1) ---------------------

constexpr double to_xyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double rgb_of_xyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
    {-0.969224334, 1.875930071, 0.041554224}, {0.055639423, -0.204011202, 1.057148933}};

Triple times(const double (&m)[3][3], const Triple& v) {
    Triple out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
}

const Triple& white() {
    static const Triple w = times(to_xyz, {1, 1, 1});
    return w;
}

Triple relative(const Triple& rgb) {
    Triple xyz = times(to_xyz, rgb);
    for (std::size_t i = 0; i < 3; ++i) xyz[i] /= white()[i];
    return xyz;
}

Triple ycxcz(const Triple& rgb) {
    const auto [x, y, z] = relative(rgb);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Triple rgb_of(const Triple& c) {
    const double y = (c[0] + 16) / 116;
    return times(rgb_of_xyz, {(y + c[1] / 500) * white()[0], y * white()[1], (y - c[2] / 200) * white()[2]});
}

/// CIELAB with a and b scaled by lightness: colour differences are smaller in the dark (Hunt).
Triple hunt_lab(const Triple& rgb) {
    Triple t = relative(rgb);
    constexpr double delta = 6.0 / 29;
    for (double& v : t) v = v > delta * delta * delta ? math::pow(v, 1.0 / 3) : v / (3 * delta * delta) + 4.0 / 29;
    const double lightness = 116 * t[1] - 16;
    return {lightness, 0.01 * lightness * 500 * (t[0] - t[1]), 0.01 * lightness * 200 * (t[1] - t[2])};
}

/// HyAB: city-block distance in lightness, Euclidean distance in colour.
double hyab(const Triple& a, const Triple& b) { return std::fabs(a[0] - b[0]) + math::hypot(a[1] - b[1], a[2] - b[2]); }

// --- separable filters, edges repeated -------------------------------------------------------------------------------

using Kernel = std::vector<double>;  // odd length

struct Size {
    int w, h;
    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
    }
};

Plane filtered(const Plane& in, Size size, const Kernel& across, const Kernel& down) {
    Plane rows(in.size()), out(in.size());
    const auto run = [&](const Plane& from, Plane& to, const Kernel& kernel, int dx, int dy) {
        const int radius = static_cast<int>(kernel.size() / 2);
        for (int y = 0; y < size.h; ++y)
            for (int x = 0; x < size.w; ++x) {
                double sum = 0;
                for (int k = -radius; k <= radius; ++k)
                    sum += kernel[static_cast<std::size_t>(k + radius)] *
                        static_cast<double>(from[size.at(
                            std::clamp(x + k * dx, 0, size.w - 1), std::clamp(y + k * dy, 0, size.h - 1))]);
                to[size.at(x, y)] = static_cast<float>(sum);
            }
    };
    run(in, rows, across, 1, 0);
    run(rows, out, down, 0, 1);
    return out;
}

template <class Of> Kernel kernel_of(int radius, Of of) {
    Kernel out;
    for (int k = -radius; k <= radius; ++k) out.push_back(of(static_cast<double>(k)));
    return out;
}

void scale(Kernel& kernel, double by) {
    for (double& v : kernel) v *= by;
}

double sum_of(const Kernel& kernel) {
    double sum = 0;
    for (const double v : kernel) sum += v;
    return sum;
}

/// One Gaussian of a contrast sensitivity function, a sqrt(pi/b) exp(-(pi x)^2 / b), x in degrees.
struct Sensitivity {
    double a, b;
};
constexpr Sensitivity achromatic{1, 0.0047}, red_green{1, 0.0053}, blue_yellow[] = {{34.1, 0.04}, {13.5, 0.025}};

Plane blurred(const Plane& in, Size size, std::span<const Sensitivity> parts, double ppd) {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    Plane out(in.size());
    double total = 0;
    std::vector<Kernel> kernels;
    for (const Sensitivity& part : parts) {
        kernels.push_back(
            kernel_of(radius, [&](double k) { return math::exp(-(pi * k / ppd) * (pi * k / ppd) / part.b); }));
        total += part.a * std::sqrt(pi / part.b) * sum_of(kernels.back()) * sum_of(kernels.back());
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Plane one = filtered(in, size, kernels[i], kernels[i]);
        const auto share = static_cast<float>(parts[i].a * std::sqrt(pi / parts[i].b) / total);
        for (std::size_t p = 0; p < out.size(); ++p) out[p] += share * one[p];
    }
    return out;
}

/// First or second derivative of a Gaussian; its positive values sum to one, its negative values to minus one.
Plane feature(const Plane& lightness, Size size, double ppd, bool edge, bool across) {
    const double sd = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * sd));
    const auto gauss = [&](double k) { return math::exp(-k * k / (2 * sd * sd)); };
    Kernel smooth = kernel_of(radius, gauss);
    scale(smooth, 1 / sum_of(smooth));
    Kernel change = kernel_of(radius, [&](double k) { return (edge ? -k : k * k / (sd * sd) - 1) * gauss(k); });
    double positive = 0, negative = 0;
    for (const double v : change) (v > 0 ? positive : negative) += v;
    for (double& v : change) v /= v > 0 ? positive : -negative;
    return across ? filtered(lightness, size, change, smooth) : filtered(lightness, size, smooth, change);
}

Plane magnitude(const Plane& lightness, Size size, double ppd, bool edge) {
    Plane x = feature(lightness, size, ppd, edge, true);
    const Plane y = feature(lightness, size, ppd, edge, false);
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = static_cast<float>(math::hypot(static_cast<double>(x[i]), static_cast<double>(y[i])));
    return x;
}

// --- the two halves of FLIP -----------------------------------------------------------------------------------------

ColourPlanes opponent(const FlipImage& image) {
    ColourPlanes out;
    for (Plane& p : out) p.resize(image.r.size());
    for (std::size_t i = 0; i < image.r.size(); ++i) {
        const auto in = [](float v) { return std::clamp(static_cast<double>(v), 0.0, 1.0); };
        const Triple c = ycxcz({in(image.r[i]), in(image.g[i]), in(image.b[i])});
        for (std::size_t k = 0; k < 3; ++k) out[k][i] = static_cast<float>(c[k]);
    }
    return out;
}

/// Filters the picture with the eye's contrast sensitivities and returns Hunt-adjusted CIELAB.
ColourPlanes perceived(const ColourPlanes& c, Size size, double ppd) {
    ColourPlanes out{blurred(c[0], size, {&achromatic, 1}, ppd), blurred(c[1], size, {&red_green, 1}, ppd),
        blurred(c[2], size, blue_yellow, ppd)};
    for (std::size_t i = 0; i < out[0].size(); ++i) {
        Triple rgb =
            rgb_of({static_cast<double>(out[0][i]), static_cast<double>(out[1][i]), static_cast<double>(out[2][i])});
        for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
        const Triple lab = hunt_lab(rgb);
        for (std::size_t k = 0; k < 3; ++k) out[k][i] = static_cast<float>(lab[k]);
    }
    return out;
}

Triple at(const ColourPlanes& p, std::size_t i) {
    return {static_cast<double>(p[0][i]), static_cast<double>(p[1][i]), static_cast<double>(p[2][i])};
}

/// Maps a colour difference to [0, 1]: compressed, the largest differences most.
double remapped(double difference) {
    static const double most = math::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
    constexpr double pc = 0.4, pt = 0.95;
    const double d = math::pow(difference, 0.7), knee = pc * most;
    return d < knee ? pt / knee * d : pt + (d - knee) / (most - knee) * (1 - pt);
}

struct Features {
    Plane edges, points;
};
Features features(const ColourPlanes& c, Size size, double ppd) {
    Plane y = c[0];
    for (float& v : y) v = (v + 16) / 116;
    return {magnitude(y, size, ppd, true), magnitude(y, size, ppd, false)};
}

/// x (a x + b) / (x (c x + d) + e): Narkowicz's fit of ACES, including its exposure of 0.6.
constexpr double aces[6] = {0.6 * 0.6 * 2.51, 0.6 * 0.03, 0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};

float tone_mapped(float radiance, double exposure) {
    const double x = std::max(0.0, static_cast<double>(radiance)) * exposure;
    if (std::isinf(x)) return 1;
    return static_cast<float>(
        std::clamp((aces[0] * x * x + aces[1] * x + aces[2]) / (aces[3] * x * x + aces[4] * x + aces[5]), 0.0, 1.0));
}

ColourPlanes tone_mapped(const FlipImage& image, double exposure) {
    ColourPlanes out;
    const std::span<const float> in[3] = {image.r, image.g, image.b};
    for (std::size_t k = 0; k < 3; ++k) {
        out[k].reserve(in[k].size());
        for (const float v : in[k]) out[k].push_back(std::isfinite(v) ? tone_mapped(v, exposure) : 0.0f);
    }
    return out;
}

}  // namespace

std::vector<float> ldr_flip(const FlipImage& reference, const FlipImage& test, double ppd) {
    const Size size{reference.width, reference.height};
    const ColourPlanes a = opponent(reference), b = opponent(test);
    const Features fa = features(a, size, ppd), fb = features(b, size, ppd);
    const ColourPlanes pa = perceived(a, size, ppd), pb = perceived(b, size, ppd);
    std::vector<float> out(a[0].size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double colour = remapped(hyab(at(pa, i), at(pb, i)));
        const double edges = std::fabs(static_cast<double>(fa.edges[i]) - static_cast<double>(fb.edges[i]));
        const double points = std::fabs(static_cast<double>(fa.points[i]) - static_cast<double>(fb.points[i]));
        const double shape = std::sqrt(std::max(edges, points) / std::numbers::sqrt2);
        out[i] = static_cast<float>(math::pow(colour, 1 - std::min(shape, 1.0)));
    }
    return out;
}

FlipExposures flip_exposures(const FlipImage& reference) {
    std::vector<double> y;
    for (std::size_t i = 0; i < reference.r.size(); ++i) {
        const double v = times(to_xyz,
            {static_cast<double>(reference.r[i]), static_cast<double>(reference.g[i]),
                static_cast<double>(reference.b[i])})[1];
        if (std::isfinite(v)) y.push_back(std::max(0.0, v));
    }
    if (y.empty()) return {};
    constexpr double t = 0.85;  // of the tone map's range: its output for the largest and for the median luminance
    const double a = aces[0] - t * aces[3], b = aces[1] - t * aces[4], c = aces[2] - t * aces[5];
    const double x = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
    const double median = std::max(order_statistic(y, (y.size() - 1) / 2), 1e-7),
                 largest = std::max(*std::max_element(y.begin(), y.end()), 1e-7);
    FlipExposures out{math::log(x / largest) / std::numbers::ln2, math::log(x / median) / std::numbers::ln2, 2};
    out.count = std::max(2, static_cast<int>(std::ceil(out.stop - out.start)));
    return out;
}

std::vector<float> hdr_flip(const FlipImage& reference, const FlipImage& test, double ppd) {
    const FlipExposures e = flip_exposures(reference);
    std::vector<float> out(reference.r.size());
    for (int k = 0; k < e.count; ++k) {
        const double exposure = math::exp2(e.start + k * (e.stop - e.start) / (e.count - 1));
        const ColourPlanes a = tone_mapped(reference, exposure), b = tone_mapped(test, exposure);
        const std::vector<float> one = ldr_flip(
            {reference.width, reference.height, a[0], a[1], a[2]}, {test.width, test.height, b[0], b[1], b[2]}, ppd);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::max(out[i], one[i]);
    }
    return out;
}

}  // namespace crescent::inline comparison
