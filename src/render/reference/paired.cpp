// The estimates are those of a declared combination with other random numbers.
#include "render/reference/paired.h"

#include <cmath>

#include "math/sobol.h"
#include "render/combination.h"
#include "render/estimator.h"
#include "render/reference/reference.h"
#include "scene/lobes/all.h"

namespace crescent {

namespace {

/// What draws at these points.
Combination combination_for(const ShadingPoints& points) {
    CombinationPlan plan;
    plan.kind = CombinationKind::mis;
    plan.of = {"cosine"};
    if (points.lobe >= 0) plan.of.emplace_back(lobe_info(static_cast<LobeKind>(points.lobe)).own_arm);
    if (points.light_count() > 0) plan.of.emplace_back("light-solid-angle");
    if (points.around && points.around->sky) plan.of.emplace_back("sky");
    if (points.around && points.around->triangles) plan.of.emplace_back("light-triangle");
    Techniques techniques;
    for (const std::string& name : plan.of) techniques.push_back(built_in_technique(name));
    return {"paired", plan, std::move(techniques), nullptr, {}, {}};
}

/// Estimates every point of a group once.
Moments estimate(const ShadingPoints& points, const Combination& combination, std::uint64_t n, std::uint32_t seed,
    const std::atomic<bool>* stop) {
    std::array<Moments, 1> moments;
    moments[0].resize(points);
    std::vector<std::byte> memory(points.kernel_memory());
    const std::array<std::uint64_t, 1> counts = {n};
    const KernelCall call{.shading_points = &points,
        .sample_counts = counts,
        .seed = seed,
        .out = moments,
        .stop = stop,
        .samples = nullptr,
        .memory = memory.data()};
    const PixelNumbers numbers = [&](std::uint32_t pixel, std::uint64_t sample, std::uint32_t block) {
        constexpr std::uint32_t salt = 0x50b01;  // the hashes of films have small numbers of pairs here
        const auto scramble = pcg4d(Vec4u<std::uint32_t>{pixel, block, seed, salt});
        return math::scrambled_sobol(static_cast<std::uint32_t>(sample), scramble);
    };
    estimate_combination(combination, call, "", &numbers);
    return std::move(moments[0]);
}

}  // namespace

void write_paired(const Scene& scene, const ShadingPoints& points, const PairedPlan& plan,
    const std::atomic<bool>* stop, ReferenceFilm& film) {
    const Combination combination = combination_for(points);
    const std::array estimates = {estimate(points, combination, plan.n, plan.seeds[0], stop),
        estimate(points, combination, plan.n, plan.seeds[1], stop)};
    for (std::size_t i = 0; i < points.count; ++i) {
        const Rgb first = mean_radiance(scene, points, estimates[0], plan.n, i),
                  second = mean_radiance(scene, points, estimates[1], plan.n, i);
        Rgb mean{};
        for (std::size_t c = 0; c < 3; ++c) mean[c] = 0.5 * (first[c] + second[c]);
        store_pixel(film, points.pixel[i], mean, 0.5 * std::fabs(luminance(first) - luminance(second)));
    }
}

void write_background(const Scene& scene, const TileBox& box, ReferenceFilm& film) {
    for_each_background(
        scene, box, [&](std::uint32_t pixel, const Rgb& radiance) { store_pixel(film, pixel, radiance, 0); });
}

std::vector<ReferenceFilm> paired_reference(
    const std::vector<TiledScene>& views, const PairedPlan& plan, ProgressMonitor& monitor) {
    std::vector<double> exponents;
    for (const TiledScene& view : views) exponents.push_back(view.scene().s());
    return by_tiles(views.at(0).scene().image(), exponents, monitor,
        [&](std::size_t k, const TileBox& tile, std::vector<ReferenceFilm>& films) {
            for (ReferenceFilm& film : films) write_background(views[0].scene(), tile, film);
            for (std::size_t e = 0; e < views.size(); ++e) {
                const std::shared_ptr<const TiledScene::Points> groups = views[e].points(k);
                for (const ShadingPoints& points : *groups) {
                    if (e == 0 || points.lobe >= 0)
                        write_paired(views[e].scene(), points, plan, &monitor.stop, films[e]);
                    else
                        for (std::size_t i = 0; i < points.count; ++i) copy_pixel(films[0], films[e], points.pixel[i]);
                }
            }
        });
}

}  // namespace crescent
