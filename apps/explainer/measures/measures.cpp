// The pixel's N samples are those of the film, its share of hits is that of 2^18 draws; f and the light of the fill are
// summed over 256 x 512 equal solid angles. Disks' solid angles: Van Oosterom & Strackee 1983. The tail is that of 2^20
// weights, the lost part is counted over 100 000 cosine draws.
#include "measures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace crescent::explainer {

namespace {

constexpr std::uint64_t long_series = 1 << 18;  // draws of one pixel: a share of 1/400 to 4 %
constexpr std::uint64_t tail_draws = 1 << 20;   // 3072 of them are the tail
constexpr std::uint64_t shown_directions = 1500, lost_draws = 100'000;

double sine(double turns) { return math::sin(2 * pi * turns); }
double cosine(double turns) { return math::cos(2 * pi * turns); }

/// Calls visit(w) with the middles of equal solid angles over the upper hemisphere, 2 pi / count each.
template <class Visit> std::size_t over_hemisphere(Visit&& visit) {
    constexpr int rings = 256, sectors = 512;
    for (int j = 0; j < rings; ++j) {
        const double z = (j + 0.5) / rings, r = std::sqrt(1 - z * z);
        for (int i = 0; i < sectors; ++i)
            visit(Vec3d{r * cosine((i + 0.5) / sectors), r * sine((i + 0.5) / sectors), z});
    }
    return std::size_t{rings} * sectors;
}

/// Returns the solid angle of a triangle of unit vectors: Van Oosterom & Strackee 1983, "The Solid Angle of a Plane
/// Triangle".
double solid_angle(Vec3d a, Vec3d b, Vec3d c) {
    const double volume = dot(a, cross(b, c));
    return 2 * math::atan2(std::fabs(volume), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

double solid_angle(const PixelLight& disk) {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < disk.rim.size(); ++k)
        sum += solid_angle(disk.towards, disk.rim[k], disk.rim[k + 1]);
    return sum;
}

ArmAtPixel arm_at(const Data& data, const OpenPixel& pixel, const std::string& arm) {
    ArmAtPixel out;
    out.arm = arm;
    out.sampler = data.experiment.find_arm(arm)->sampler;
    const RunKey key = data.key(arm);
    out.samples = pixel.samples(out.sampler, key.n, key.seed);
    out.mean = running_mean(out.samples);
    const Film& film = *data.film(key);
    out.film = static_cast<double>(film.y[std::size_t(pixel.j()) * std::size_t(film.width) + std::size_t(pixel.i())]);
    for (std::size_t k = 0; k < out.samples.size(); ++k) {
        const PixelSample& sample = out.samples[k];
        if (sample.x > out.largest_sample().x) out.largest = k;
        out.hits += sample.meets_light();
        out.below_horizon += sample.cos <= 0;
    }
    out.long_series = long_series;
    std::uint64_t hits = 0;
    for (const PixelSample& sample : pixel.samples(out.sampler, long_series, key.seed)) hits += sample.meets_light();
    out.hit_share = static_cast<double>(hits) / static_cast<double>(long_series);
    return out;
}

/// Returns the same direction with another sampler's density.
PixelSample with_density_of(const OpenPixel& pixel, PixelSample sample, const std::string& sampler) {
    const double p = pixel.pdf(sampler, {double(sample.wi.x), double(sample.wi.y), double(sample.wi.z)});
    sample.pdf = static_cast<float>(p);
    sample.x = p > 0 ? static_cast<float>(double(sample.f) * double(sample.light) * double(sample.cos) / p)
                     : std::numeric_limits<float>::infinity();
    return sample;
}

PixelStory pixel_story(const Data& data) {
    PixelStory out;
    const RunKey key = data.key(data.cast.cosine);
    const ReferenceFilm& reference = data.reference();
    const auto [i, j] = worst_pixel(*data.film(key), reference, data.shapes, data.box(data.cast.highlight));
    out.pixel = std::make_shared<const OpenPixel>(Scene(data.experiment), i, j);
    out.reference = static_cast<double>(reference.y[std::size_t(j) * std::size_t(reference.width) + std::size_t(i)]);
    out.cosine = arm_at(data, *out.pixel, data.cast.cosine);
    out.phong = arm_at(data, *out.pixel, data.cast.phong);
    out.disk = out.cosine.largest_sample().disk >= 0 ? out.cosine.largest_sample().disk
        : out.pixel->lights().empty()                ? -1
                                                     : 0;
    for (const PixelLight& disk : out.pixel->lights()) out.solid_angle += disk.faces ? solid_angle(disk) : 0;
    out.by_phong = with_density_of(*out.pixel, out.cosine.largest_sample(), out.phong.sampler);
    double under_fill = 0;
    const std::size_t parts = over_hemisphere([&](Vec3d w) {
        const double f = out.pixel->f(w);
        if (!out.pixel->meets_light(w)) under_fill += f * w.z;
        out.top_f = std::max(out.top_f, f);
    });
    under_fill *= 2 * pi / static_cast<double>(parts) * out.pixel->fill();
    out.disk_share = out.reference > 0 ? std::clamp(1 - under_fill / out.reference, 0.0, 1.0) : 0;
    return out;
}

/// Drawn as in metrics/article_checks.cpp.
std::vector<Vec3d> cosine_directions(std::uint32_t seed, std::uint64_t n) {
    std::vector<Vec3d> out;
    const Cosine<double> arm(ShadingPoint<double>{});
    for (std::uint64_t k = 0; k < n; ++k) {
        const Vec2<float> u = draw(seed, 0, k);
        out.push_back(arm.sample({0, 0, 1}, {static_cast<double>(u.x), static_cast<double>(u.y)}).wi);
    }
    return out;
}

/// Returns what the lobe's sampler cannot reach if R is tilted as in the middle of a region.
LostSupport lost_in(const Data& data, const Box& box) {
    const Scene scene(data.experiment);
    std::vector<double> cosines;
    for (int j = box.y0; j <= box.y1; ++j)
        for (int i = box.x0; i <= box.x1; ++i)
            if (const std::optional<Hit> hit = scene.primary(i, j)) cosines.push_back(dot(hit->n, hit->wo));
    if (cosines.empty()) return {};
    std::nth_element(cosines.begin(), cosines.begin() + std::ptrdiff_t(cosines.size() / 2), cosines.end());
    const double c = cosines[cosines.size() / 2];
    const Vec3d R = {-std::sqrt(std::max(0.0, 1 - c * c)), 0, c};
    std::uint64_t lost_count = 0;
    for (const Vec3d& w : cosine_directions(data.cast.seed, lost_draws)) lost_count += dot(w, R) <= 0;
    const double p = static_cast<double>(lost_count) / lost_draws;
    return {.theta_R_deg = math::acos(c) * 180 / pi,
        .measured = p,
        .se = std::sqrt(p * (1 - p) / lost_draws),
        .theory = (1 - c) / 2};
}

}  // namespace

std::pair<int, int> worst_pixel(
    const Film& film, const ReferenceFilm& reference, const ShapeMap& shapes, const Box& box) {
    std::pair<int, int> worst{box.x0, box.y0};
    double largest_error = -1;
    for (int j = box.y0; j <= box.y1; ++j) {
        for (int i = box.x0; i <= box.x1; ++i) {
            const std::size_t index = std::size_t(j) * std::size_t(film.width) + std::size_t(i);
            const double error =
                std::fabs(static_cast<double>(film.y[index]) - static_cast<double>(reference.y[index]));
            if (shapes.shape[index] >= 0 && error > largest_error) {
                largest_error = error;
                worst = {i, j};
            }
        }
    }
    return worst;
}

double WeightTail::edge(std::size_t bin) const {
    return math::pow(10.0, first_log10 + static_cast<double>(bin) / decade_parts);
}

double WeightTail::expected(std::size_t bin) const {
    const auto survival_of = [&](double x) {  // P(u^-k > x / smallest), u uniform in (0, 1)
        if (k > 0) return x <= smallest ? 1 : math::pow(x / smallest, -1 / k);
        return x >= smallest ? 0 : k < 0 ? 1 - math::pow(x / smallest, -1 / k) : 1;
    };
    return static_cast<double>(n) * (survival_of(edge(bin)) - survival_of(edge(bin + 1)));
}

WeightTail weight_tail(double s, std::uint64_t n, std::uint32_t seed) {
    WeightTail out;
    out.s = s;
    out.k = (s - 1) / (s + 1);
    out.smallest = 2 / (s + 1);
    out.n = n;
    ShadingPoint<float> shading_point{};
    shading_point.wo = {0, 0, 1};
    shading_point.s = static_cast<float>(s);
    const Phong<float> arm(shading_point);
    std::vector<double> weights;
    for (std::uint64_t k = 0; k < n; ++k) {
        const Drawn<float> sample = arm.sample(shading_point.wo, draw(seed, 0, k));
        const double p = static_cast<double>(sample.pdf.v);
        weights.push_back(sample.wi.z > 0 && p > 0 ? static_cast<double>(sample.wi.z) / (pi * p) : 0);
    }
    double lowest = out.smallest;
    for (const double w : weights) lowest = w > 0 ? std::min(lowest, w) : lowest;
    out.first_log10 = std::floor(math::log10(lowest) * out.decade_parts) / out.decade_parts;
    for (const double w : weights) {
        if (!(w > 0)) continue;
        const double position = (math::log10(w) - out.first_log10) * out.decade_parts;
        const std::size_t bin = static_cast<std::size_t>(std::max(position, 0.0));
        if (bin >= out.bins.size()) out.bins.resize(bin + 1);
        ++out.bins[bin];
    }
    const std::size_t length = tail_length(n);
    std::sort(weights.begin(), weights.end(), std::greater<>());
    out.largest = weights.front();
    out.median = weights[weights.size() / 2];
    if (length > 0) out.fit = fit_tail(std::span<const double>(weights.data(), length + 1));
    return out;
}

Measures take_measures(const Data& data, const std::string&, ProgressMonitor& monitor) {
    Measures out;
    out.story = pixel_story(data);
    monitor.check();
    out.tail = weight_tail(data.cast.s, tail_draws, data.cast.seed);
    out.cosine_directions = cosine_directions(data.cast.seed, shown_directions);
    out.surround_lost = lost_in(data, data.box(data.cast.surround));
    monitor.check();
    return out;
}

}  // namespace crescent::explainer
