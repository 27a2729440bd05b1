// FLIP (Andersson et al. 2020) and HDR-FLIP (Andersson et al. 2021), with their constants: contrast sensitivities as
// Gaussians, HyAB after Hunt's adjustment, edges and points of lightness. Distances in degrees of view are converted to
// pixels by ppd, pixels per degree. ColourPlanes are float, sums double.
#include "metrics/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "math/functions.h"
#include "math/simd/scalar.h"
#include "math/statistics.h"

namespace crescent::inline metrics {

namespace {

using Plane = std::vector<float>;
using ColourPlanes = std::array<Plane, 3>;
using Triple = std::array<double, 3>;

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

/// Sums kernel[k] * in[k] over the pixels around each one, in the order of k.
Plane filtered(const Plane& in, Size size, const Kernel& across, const Kernel& down) {
    const auto width = static_cast<std::size_t>(size.w);
    const int radius = static_cast<int>(across.size() / 2);
    Plane rows(in.size()), out(in.size());
    std::vector<float> padded(width + 2 * static_cast<std::size_t>(radius));
    std::vector<double> sums(width);
    const auto add = [&](double weight, const float* values) {
        for (std::size_t x = 0; x < width; ++x) sums[x] += weight * static_cast<double>(values[x]);
    };
    const auto store = [&](float* to) {
        for (std::size_t x = 0; x < width; ++x) to[x] = static_cast<float>(sums[x]);
        std::ranges::fill(sums, 0);
    };
    for (int y = 0; y < size.h; ++y) {
        const float* row = &in[size.at(0, y)];
        for (int x = -radius; x < size.w + radius; ++x)
            padded[static_cast<std::size_t>(x + radius)] = row[std::clamp(x, 0, size.w - 1)];
        for (std::size_t k = 0; k < across.size(); ++k) add(across[k], &padded[k]);
        store(&rows[size.at(0, y)]);
    }
    for (int y = 0; y < size.h; ++y) {
        for (std::size_t k = 0; k < down.size(); ++k)
            add(down[k], &rows[size.at(0, std::clamp(y + static_cast<int>(k) - radius, 0, size.h - 1))]);
        store(&out[size.at(0, y)]);
    }
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

int blur_radius(double ppd) { return static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd)); }

Plane blurred(const Plane& in, Size size, std::span<const Sensitivity> parts, double ppd) {
    const int radius = blur_radius(ppd);
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

double feature_deviation(double ppd) { return 0.5 * 0.082 * ppd; }
int feature_radius(double ppd) { return static_cast<int>(std::ceil(3 * feature_deviation(ppd))); }

/// First or second derivative of a Gaussian; its positive values sum to one, its negative values to minus one.
Plane feature(const Plane& lightness, Size size, double ppd, bool edge, bool across) {
    const double sd = feature_deviation(ppd);
    const int radius = feature_radius(ppd);
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

/// What of one picture is compared.
struct Seen {
    ColourPlanes perceived;
    Features features;
};
Seen seen(const FlipImage& image, double ppd) {
    const Size size{image.width, image.height};
    const ColourPlanes c = opponent(image);
    return {perceived(c, size, ppd), features(c, size, ppd)};
}
Seen seen(const FlipImage& image, double exposure, double ppd) {
    const ColourPlanes c = tone_mapped(image, exposure);
    return seen(FlipImage{image.width, image.height, c[0], c[1], c[2]}, ppd);
}

float difference(const Seen& a, const Seen& b, std::size_t i) {
    const double colour = remapped(hyab(at(a.perceived, i), at(b.perceived, i)));
    const auto off = [&](const Plane& x, const Plane& y) {
        return std::fabs(static_cast<double>(x[i]) - static_cast<double>(y[i]));
    };
    const double edges = off(a.features.edges, b.features.edges), points = off(a.features.points, b.features.points);
    const double shape = std::sqrt(std::max(edges, points) / std::numbers::sqrt2);
    return static_cast<float>(math::pow(colour, 1 - std::min(shape, 1.0)));
}

double exposure_of(const FlipExposures& e, int k) {
    return math::exp2(e.start + k * (e.stop - e.start) / (e.count - 1));
}

/// HDR-FLIP of each pixel, for each test picture.
std::vector<std::vector<float>> hdr_flips(
    const FlipImage& reference, std::span<const FlipImage> tests, const FlipExposures& e, double ppd) {
    std::vector<std::vector<float>> out(tests.size(), std::vector<float>(reference.r.size()));
    for (int k = 0; k < e.count; ++k) {
        std::vector<Seen> all(1 + tests.size());
        parallel_for(std::size_t{0}, all.size(),
            [&](std::size_t p) { all[p] = seen(p == 0 ? reference : tests[p - 1], exposure_of(e, k), ppd); });
        parallel_for(std::size_t{0}, tests.size(), [&](std::size_t t) {
            for (std::size_t i = 0; i < out[t].size(); ++i)
                out[t][i] = std::max(out[t][i], difference(all[0], all[t + 1], i));
        });
    }
    return out;
}

/// A box of a picture, as a picture of its own.
class Crop {
public:
    Crop(const FlipImage& whole, const Box& box) : width_(box.width()), height_(box.height()) {
        const std::span<const float> from[3] = {whole.r, whole.g, whole.b};
        const Size size{whole.width, whole.height};
        for (std::size_t c = 0; c < 3; ++c)
            for (int y = box.y0; y <= box.y1; ++y) {
                const auto row = from[c].subspan(size.at(box.x0, y), static_cast<std::size_t>(width_));
                planes_[c].insert(planes_[c].end(), row.begin(), row.end());
            }
    }
    FlipImage image() const { return {width_, height_, planes_[0], planes_[1], planes_[2]}; }

private:
    int width_, height_;
    ColourPlanes planes_;
};

double mean_over(const std::vector<float>& map, Size size, const Box& box) {
    double sum = 0;
    for (int y = box.y0; y <= box.y1; ++y)
        for (int x = box.x0; x <= box.x1; ++x) sum += static_cast<double>(map[size.at(x, y)]);
    return sum / (static_cast<double>(box.width()) * box.height());
}

}  // namespace

std::vector<float> ldr_flip(const FlipImage& reference, const FlipImage& test, double ppd) {
    const Seen a = seen(reference, ppd), b = seen(test, ppd);
    std::vector<float> out(reference.r.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = difference(a, b, i);
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
    return std::move(hdr_flips(reference, {&test, 1}, flip_exposures(reference), ppd).front());
}

std::vector<std::vector<double>> mean_hdr_flips(
    const FlipImage& reference, std::span<const FlipImage> tests, std::span<const Box> boxes, double ppd) {
    const FlipExposures exposures = flip_exposures(reference);
    const int reach = std::max(blur_radius(ppd), feature_radius(ppd));
    std::vector<std::vector<double>> out(tests.size());
    for (const Box& box : boxes) {
        const Box around{std::max(box.x0 - reach, 0), std::max(box.y0 - reach, 0),
            std::min(box.x1 + reach, reference.width - 1), std::min(box.y1 + reach, reference.height - 1)};
        const Crop crop(reference, around);
        std::vector<Crop> crops;
        std::vector<FlipImage> images;
        for (const FlipImage& test : tests) crops.emplace_back(test, around);
        for (const Crop& test : crops) images.push_back(test.image());
        const auto maps = hdr_flips(crop.image(), images, exposures, ppd);
        const Box inside{box.x0 - around.x0, box.y0 - around.y0, box.x1 - around.x0, box.y1 - around.y0};
        for (std::size_t t = 0; t < tests.size(); ++t)
            out[t].push_back(mean_over(maps[t], {around.width(), around.height()}, inside));
    }
    return out;
}

}  // namespace crescent::inline metrics
