// The article's reference: the lobe under the fill by the lobe's own sampler, each light by area, both by the kernels,
// added. Its error is the standard error, plus all of a lobe's light if so few samples would meet it that there may be
// none.
#include "metrics/monte_carlo_reference.h"

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "render/estimator.h"
#include "render/reference/paired.h"
#include "render/reference/reference.h"

namespace crescent {

namespace {

/// Returns the same shading points with lights that turn X into the requested part: light k alone, or the fill on the
/// lobe alone. The other lights still hide what is behind them, but have radiance 0 and are never aimed at.
ShadingPoints only_light(const Scene& scene, const ShadingPoints& points, std::size_t k) {
    ShadingPoints shading_points = points;
    const auto tinted = [&](const Rgb& light, std::size_t i) {
        const Rgb& tint = points.tint[i];
        return luminance(Rgb{light[0] * tint[0], light[1] * tint[1], light[2] * tint[2]});
    };
    const auto isolate = [&](auto& light, const auto& original, bool is_chosen) {
        light.power = is_chosen ? 1 : 0;
        for (auto* array : {&light.d, &light.s}) std::fill(array->begin(), array->end(), 0.0f);
        for (std::size_t i = 0; is_chosen && i < shading_points.pixel.size(); ++i) {
            light.d[i] =
                original.d[i] - shading_points.fill_d[i];  // L_key - L_fill: the light replaces the fill behind it
            const double full = tinted(scene.lights()[k].radiance, i), difference = full - tinted(scene.fill(), i);
            light.s[i] = full > 0 ? static_cast<float>(static_cast<double>(original.s[i]) * difference / full)
                                  : -shading_points.fill_s[i];
        }
    };
    for (std::size_t j = 0; j < shading_points.disks.size(); ++j)
        isolate(shading_points.disks[j], points.disks[j], j == k);
    for (std::size_t j = 0; j < shading_points.others.size(); ++j)
        isolate(shading_points.others[j], points.others[j], shading_points.disks.size() + j == k);
    for (auto* array : {&shading_points.fill_d, &shading_points.fill_s}) std::fill(array->begin(), array->end(), 0.0f);
    return shading_points;
}

ShadingPoints only_lobe(const ShadingPoints& points) {
    ShadingPoints shading_points = points;
    shading_points.disks.clear();
    shading_points.others.clear();
    std::fill(shading_points.fill_d.begin(), shading_points.fill_d.end(), 0.0f);
    return shading_points;
}

double variance_of_mean(double spread, double n) { return n > 1 && spread > 0 ? spread / (n * (n - 1)) : 0; }

/// Returns the centre of light k from shading point i, in its local frame, and the radius of a ball that contains it.
std::pair<Vec3d, double> ball_of(const ShadingPoints& shading_points, std::size_t i, std::size_t k) {
    if (k < shading_points.disks.size()) {
        const DiskArrays& disk = shading_points.disks[k];
        return {{disk.cx[i], disk.cy[i], disk.cz[i]}, static_cast<double>(disk.radius)};
    }
    const LightArrays& from = shading_points.others[k - shading_points.disks.size()];
    LocalLight<double> light;
    light.a = {from.numbers[0][i], from.numbers[1][i], from.numbers[2][i]};
    for (std::size_t n = 0; n < light.number.size(); ++n) light.number[n] = static_cast<double>(from.numbers[9 + n][i]);
    double radius = 0;
    with_light_kind(from.kind, [&]<class Kind>() { radius = std::sqrt(Kind::radius2(light)); });
    return {light.a, radius};
}

/// Returns whether the lobe of shading point i may peak in light k, and be so narrow that fewer than ten of n samples
/// would meet it.
bool may_be_missed(const ShadingPoints& shading_points, std::size_t i, std::size_t k, double n) {
    const auto [c, radius] = ball_of(shading_points, i, k);
    const Vec3d wo = {shading_points.wox[i], shading_points.woy[i], shading_points.woz[i]};
    const LobeInfo& lobe = lobe_info(static_cast<LobeKind>(shading_points.lobe));
    const double s =
        lobe.exponent(static_cast<double>(shading_points.s[i]), static_cast<double>(shading_points.alpha[i]));
    const double foreshortening = lobe.about_mirror ? 1 : wo.z, distance = std::sqrt(dot(c, c));
    const double angle = math::acos(std::clamp(dot(c, mirror(wo)) / distance, -1.0, 1.0));
    const bool peak_is_near = angle < math::atan2(radius, distance) + 8 / std::sqrt(s);
    return peak_is_near &&
        n * 2 * foreshortening / (s + 1) < 10 * sqr(radius / distance);  // solid angles 2 pi / (s + 1) and pi (r / d)^2
}

/// Computes the article's reference over one group of shading points.
class MonteCarloPixels {
public:
    MonteCarloPixels(const Scene& scene, const Experiment& experiment, const ShadingPoints& shading_points,
        const std::vector<std::uint32_t>& seeds, const std::string& isa, ProgressMonitor& monitor)
        : scene_(scene), shading_points_(shading_points) {
        const ReferencePlan& plan = experiment.reference;
        if (shading_points.lobe >= 0)
            lobe_ = estimate_points(only_lobe(shading_points),
                lobe_info(static_cast<LobeKind>(shading_points.lobe)).own_arm, plan.lobe_spp, seeds[0], isa,
                &monitor.stop);
        lobe_n_ = static_cast<double>(plan.lobe_spp);
        light_n_ = static_cast<double>(plan.disk_spp);
        for (std::size_t k = 0; k < scene.lights().size(); ++k)
            lights_.push_back(estimate_points(
                only_light(scene, shading_points, k), "light-area", plan.disk_spp, seeds[k + 1], isa, &monitor.stop));
    }

    void write(std::size_t i, ReferenceFilm& film) const {
        const Rgb& fill = scene_.fill();
        const double lobe = shading_points_.lobe >= 0 ? lobe_.g_lobe[i] / lobe_n_ : 0;
        const double rho_s = shading_points_.rho_s_exact[i];
        const Rgb& tint = shading_points_.tint[i];
        const auto tinted = [&](const Rgb& light) {
            return luminance(Rgb{light[0] * tint[0], light[1] * tint[1], light[2] * tint[2]});
        };
        Rgb out{};
        double variance = shading_points_.lobe >= 0 ? variance_of_mean(lobe_.spread[i], lobe_n_) : 0;
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = fill[c] * (pi * shading_points_.lambert[i][c] + rho_s * tint[c] * lobe);
        for (std::size_t k = 0; k < lights_.size(); ++k) {
            Rgb part{};
            for (std::size_t c = 0; c < 3; ++c) {
                part[c] = (scene_.lights()[k].radiance[c] - fill[c]) *
                    (shading_points_.lambert[i][c] * lights_[k].light_g[k][i] +
                        rho_s * tint[c] * lights_[k].light_g_lobe[k][i]);
                out[c] += part[c] / light_n_;
            }
            variance += variance_of_mean(lights_[k].spread[i], light_n_);
            if (shading_points_.lobe >= 0 && may_be_missed(shading_points_, i, k, light_n_))
                variance += sqr(rho_s * (tinted(scene_.lights()[k].radiance) - tinted(fill)));
        }
        store_pixel(film, shading_points_.pixel[i], out, std::sqrt(variance));
    }

private:
    const Scene& scene_;
    const ShadingPoints& shading_points_;
    Moments lobe_;
    std::vector<Moments> lights_;
    double lobe_n_ = 1, light_n_ = 1;
};

}  // namespace

std::uint32_t reference_seed(const Experiment& experiment, std::uint32_t k) {
    constexpr std::uint32_t salt = 0x4ef1ce;
    constexpr std::uint32_t longest_series = 4096;  // the largest value of an experiment's `seeds`
    const auto is_in_series = [&](std::uint32_t seed) {
        for (std::uint32_t a = 0; a < longest_series; ++a)
            if (seed_of(experiment.seed, a) == seed) return true;
        return false;
    };
    std::uint32_t seed = pcg4d(Vec4u<std::uint32_t>{experiment.reference.seed, k, salt, 0u}).x;
    while (is_in_series(seed)) ++seed;
    return seed;
}

PairedPlan paired_plan(const Experiment& experiment) {
    const std::uint64_t n = experiment.reference.n > 0 ? experiment.reference.n : paired_samples;
    return {n, {reference_seed(experiment, 0x10000), reference_seed(experiment, 0x10001)}};
}

std::vector<ReferenceFilm> monte_carlo_reference(const std::vector<TiledScene>& views, const Experiment& experiment,
    const std::string& isa, ProgressMonitor& monitor) {
    std::vector<double> exponents;
    for (const TiledScene& view : views) exponents.push_back(view.scene().s());
    std::vector<std::uint32_t> seeds;  // of the lobe, then of each light
    for (std::size_t k = 0; k <= views.at(0).scene().lights().size(); ++k)
        seeds.push_back(reference_seed(experiment, static_cast<std::uint32_t>(k)));
    const auto estimate = [&](const Scene& scene, const ShadingPoints& points, ReferenceFilm& film) {
        const MonteCarloPixels pixels(scene, experiment, points, seeds, isa, monitor);
        for (std::size_t i = 0; i < points.count; ++i) pixels.write(i, film);
    };
    return by_tiles(
        experiment.image, exponents, monitor, [&](std::size_t k, const TileBox&, std::vector<ReferenceFilm>& films) {
            const std::shared_ptr<const TiledScene::Points> groups = views[0].points(k);
            for (const ShadingPoints& group : *groups) {
                estimate(views[0].scene(), group, films[0]);
                if (group.lobe >= 0 && views.size() > 1) {
                    ShadingPoints points = group;
                    for (std::size_t e = 1; e < views.size(); ++e) {
                        points.take_s(views[e].scene());
                        estimate(views[e].scene(), points, films[e]);
                    }
                } else {
                    for (std::size_t e = 1; e < views.size(); ++e)
                        for (std::size_t i = 0; i < group.count; ++i) copy_pixel(films[0], films[e], group.pixel[i]);
                }
            }
        });
}

}  // namespace crescent
