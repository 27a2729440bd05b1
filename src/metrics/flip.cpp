// FLIP (Andersson et al. 2020) and HDR-FLIP (Andersson et al. 2021), with their constants. What is done per pixel is
// compiled for each instruction set (render/flip_kernel_body.h); here are the filters, which are contrast sensitivities
// as Gaussians and derivatives of lightness, the exposures, and the parts of the pictures that are computed at a time.
// Distances in degrees of view are converted to pixels by ppd, pixels per degree.
#include "metrics/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "math/functions.h"
#include "math/simd/scalar.h"
#include "math/statistics.h"
#include "render/flip_kernel.h"

namespace crescent {

namespace {

// --- filters ---------------------------------------------------------------------------------------------------------

using Weights = std::vector<double>;  // 2 reach + 1

template <class Of> Weights weights(int reach, Of formula) {
    Weights out;
    for (int k = -reach; k <= reach; ++k) out.push_back(formula(static_cast<double>(k)));
    return out;
}

double sum_of(const Weights& weights) {
    double sum = 0;
    for (const double v : weights) sum += v;
    return sum;
}

std::vector<float> scaled(const Weights& weights, double factor) {
    std::vector<float> out;
    for (const double v : weights) out.push_back(static_cast<float>(v * factor));
    return out;
}

/// One Gaussian of a contrast sensitivity function, a sqrt(pi/b) exp(-(pi x)^2 / b), x in degrees.
struct Sensitivity {
    double a, b;
};
constexpr Sensitivity achromatic{1, 0.0047}, red_green{1, 0.0053}, blue_yellow[] = {{34.1, 0.04}, {13.5, 0.025}};

int blur_radius(double ppd) { return static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd)); }
double feature_deviation(double ppd) { return 0.5 * 0.082 * ppd; }
int feature_radius(double ppd) { return static_cast<int>(std::ceil(3 * feature_deviation(ppd))); }

/// All filters for one viewer, with weights of 0 beyond their radius.
class FilterSet {
public:
    explicit FilterSet(double ppd) : ppd_(ppd), reach_(std::max(blur_radius(ppd), feature_radius(ppd))) {
        for (const Sensitivity& sensitivity : {achromatic, red_green}) {
            const Weights gauss = blur(sensitivity);
            add(scaled(gauss, 1 / sum_of(gauss)));
        }
        double total = 0;
        for (const Sensitivity& part : blue_yellow) total += volume(part);
        for (const Sensitivity& part : blue_yellow) {
            const Weights gauss = blur(part);
            const double sum = sum_of(gauss);
            add(scaled(gauss, 1 / sum));
            add(scaled(gauss, volume(part) / total / sum));
        }
        const double sd = feature_deviation(ppd);
        const auto smooth = [&](double k) { return math::exp(-k * k / (2 * sd * sd)); };
        const Weights gauss = feature(smooth);
        add(scaled(gauss, 1 / sum_of(gauss)));
        add(balanced(feature([&](double k) { return -k * smooth(k); })));
        add(balanced(feature([&](double k) { return (k * k / (sd * sd) - 1) * smooth(k); })));
    }

    FlipFilters filters() const {
        const auto data = [&](std::size_t k) { return filters_[k].data(); };
        return {.reach = reach_,
            .achromatic = data(0),
            .red_green = data(1),
            .blue_yellow = {data(2), data(4)},
            .blue_yellow_down = {data(3), data(5)},
            .smooth = data(6),
            .edge = data(7),
            .point = data(8)};
    }
    int reach() const { return reach_; }

private:
    Weights blur(const Sensitivity& part) const {
        return within(
            blur_radius(ppd_), [&](double k) { return math::exp(-(pi * k / ppd_) * (pi * k / ppd_) / part.b); });
    }
    /// The sum over the plane.
    double volume(const Sensitivity& part) const {
        const double sum = sum_of(blur(part));
        return part.a * std::sqrt(pi / part.b) * sum * sum;
    }
    template <class Of> Weights feature(Of formula) const { return within(feature_radius(ppd_), formula); }
    template <class Of> Weights within(int radius, Of formula) const {
        return weights(reach_, [&](double k) { return std::fabs(k) <= radius ? formula(k) : 0.0; });
    }
    /// Positive values sum to one, negative ones to minus one.
    static std::vector<float> balanced(Weights weights) {
        double positive = 0, negative = 0;
        for (const double v : weights) (v > 0 ? positive : negative) += v;
        for (double& v : weights) v /= v > 0 ? positive : -negative;
        return scaled(weights, 1);
    }
    void add(std::vector<float> weights) { filters_.push_back(std::move(weights)); }

    double ppd_;
    int reach_;
    std::vector<std::vector<float>> filters_;
};

// --- parts of pictures -----------------------------------------------------------------------------------------------

/// Of a tile, in pixels: its filtered rows stay in a cache of 1 MB, and most of them belong to the tile itself.
constexpr int tile_width = 128, tile_height = 64;

struct Size {
    int w, h;
    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
    }
};

/// What FLIP is computed of, and where the results are written: rows of the box's width.
struct FlipJob {
    const FlipImage& reference;
    const FlipImage& test;
    Box box;
    float* out;
};

/// Copies the pixels of `box` and those within `reach`; the picture's edges are repeated.
void copy_around(std::span<const float> plane, Size size, const Box& box, int reach, float* to) {
    const std::size_t stride = flip_stride(box.width() + 2 * reach);
    for (int y = box.y0 - reach; y <= box.y1 + reach; ++y, to += stride) {
        const float* row = &plane[size.at(0, std::clamp(y, 0, size.h - 1))];
        for (int x = box.x0 - reach, k = 0; x <= box.x1 + reach; ++x, ++k) to[k] = row[std::clamp(x, 0, size.w - 1)];
    }
}

/// Computes one tile of a job.
void compute_tile(
    const FlipJob& job, const Box& box, const FilterSet& filters, std::span<const float> exposures, FlipKernel kernel) {
    const int reach = filters.reach();
    const std::size_t plane = flip_stride(box.width() + 2 * reach) * static_cast<std::size_t>(box.height() + 2 * reach);
    const std::size_t stride = flip_stride(box.width());
    std::vector<float> pixels(6 * plane), memory(flip_memory(box.width(), box.height(), reach)),
        out(stride * static_cast<std::size_t>(box.height()));
    FlipTile tile{.width = box.width(),
        .height = box.height(),
        .exposures = exposures,
        .filters = filters.filters(),
        .memory = memory.data(),
        .out = out.data()};
    float* next = pixels.data();
    for (std::size_t p = 0; p < 2; ++p) {
        const FlipImage& image = p == 0 ? job.reference : job.test;
        const std::span<const float> channels[3] = {image.r, image.g, image.b};
        for (std::size_t c = 0; c < 3; ++c, next += plane) {
            copy_around(channels[c], {image.width, image.height}, box, reach, next);
            tile.pixels[p][c] = next;
        }
    }
    kernel(tile);
    const Size size{job.box.width(), job.box.height()};
    for (int y = box.y0; y <= box.y1; ++y)
        std::copy_n(&out[static_cast<std::size_t>(y - box.y0) * stride], box.width(),
            job.out + size.at(box.x0 - job.box.x0, y - job.box.y0));
}

/// No exposures: LDR.
void compute_flips(
    const std::vector<FlipJob>& jobs, double ppd, std::span<const float> exposures, const std::string& isa) {
    const FilterSet filters(ppd);
    const FlipKernel kernel = flip_kernel_for(isa);
    std::vector<std::pair<const FlipJob*, Box>> tiles;
    for (const FlipJob& job : jobs)
        for (int y = job.box.y0; y <= job.box.y1; y += tile_height)
            for (int x = job.box.x0; x <= job.box.x1; x += tile_width)
                tiles.push_back({&job,
                    {x, y, std::min(x + tile_width - 1, job.box.x1), std::min(y + tile_height - 1, job.box.y1)}});
    parallel_for(std::size_t{0}, tiles.size(),
        [&](std::size_t k) { compute_tile(*tiles[k].first, tiles[k].second, filters, exposures, kernel); });
}

std::vector<float> factors(const FlipExposures& e) {
    std::vector<float> out;
    for (int k = 0; k < e.count; ++k)
        out.push_back(static_cast<float>(math::exp2(e.start + k * (e.stop - e.start) / (e.count - 1))));
    return out;
}

std::vector<float> flip_of_all(const FlipImage& reference, const FlipImage& test, double ppd,
    std::span<const float> exposures, const std::string& isa) {
    std::vector<float> out(reference.r.size());
    compute_flips(
        {{reference, test, {0, 0, reference.width - 1, reference.height - 1}, out.data()}}, ppd, exposures, isa);
    return out;
}

/// The mean over these pixels of an image of that width; the map is of `box`, their bounds.
double mean_of(std::span<const float> map, const AreaPixels& pixels, const Box& box, int width) {
    const Size size{box.width(), box.height()};
    return pixels.mean([&](std::size_t index) {
        const int i = static_cast<int>(index) % width, j = static_cast<int>(index) / width;
        return static_cast<double>(map[size.at(i - box.x0, j - box.y0)]);
    });
}

double luminance_of(const FlipImage& image, std::size_t i) {
    const double(&row)[3] = xyz_of_rgb[1];
    return row[0] * static_cast<double>(image.r[i]) + row[1] * static_cast<double>(image.g[i]) +
        row[2] * static_cast<double>(image.b[i]);
}

}  // namespace

std::vector<float> ldr_flip(const FlipImage& reference, const FlipImage& test, double ppd, const std::string& isa) {
    return flip_of_all(reference, test, ppd, {}, isa);
}

FlipExposures flip_exposures(const FlipImage& reference) {
    std::vector<double> y;
    y.reserve(reference.r.size());
    for (std::size_t i = 0; i < reference.r.size(); ++i) {
        const double v = luminance_of(reference, i);
        if (std::isfinite(v)) y.push_back(std::max(0.0, v));
    }
    if (y.empty()) return {};
    constexpr double t = 0.85;  // of the tone map's range: its output for the largest and for the median luminance
    const double a = aces_fit.a - t * aces_fit.c, b = aces_fit.b - t * aces_fit.d, c = 0 - t * aces_fit.e;
    const double x = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
    const double largest = std::max(*std::max_element(y.begin(), y.end()), 1e-7);
    const std::size_t middle = (y.size() - 1) / 2;
    const double median = std::max(order_statistic(std::move(y), middle), 1e-7);
    FlipExposures out{math::log(x / largest) / std::numbers::ln2, math::log(x / median) / std::numbers::ln2, 2};
    out.count = std::max(2, static_cast<int>(std::ceil(out.stop - out.start)));
    return out;
}

std::vector<float> hdr_flip(const FlipImage& reference, const FlipImage& test, double ppd, const std::string& isa) {
    return flip_of_all(reference, test, ppd, factors(flip_exposures(reference)), isa);
}

std::vector<std::vector<double>> mean_hdr_flips(const FlipImage& reference, const FlipExposures& exposures,
    std::span<const FlipImage> tests, std::span<const AreaPixels> areas, double ppd, const std::string& isa) {
    std::vector<Box> boxes;
    for (const AreaPixels& pixels : areas) boxes.push_back(pixels.bounds());
    std::vector<std::vector<float>> maps;
    for (std::size_t t = 0; t < tests.size(); ++t)
        for (const Box& box : boxes)
            maps.emplace_back(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()));
    std::vector<FlipJob> jobs;
    for (std::size_t k = 0; k < maps.size(); ++k)
        jobs.push_back({reference, tests[k / boxes.size()], boxes[k % boxes.size()], maps[k].data()});
    compute_flips(jobs, ppd, factors(exposures), isa);
    std::vector<std::vector<double>> out(tests.size());
    for (std::size_t k = 0; k < maps.size(); ++k)
        out[k / boxes.size()].push_back(
            mean_of(maps[k], areas[k % boxes.size()], boxes[k % boxes.size()], reference.width));
    return out;
}

}  // namespace crescent
