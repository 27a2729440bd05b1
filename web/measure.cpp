// What lessons ask: an arm over a region at one N on several seeds, and furnaces. Every number with its seeds.
#include <algorithm>
#include <cmath>

#include "door.h"

namespace crescent::web {

namespace {

Box box_of(const ordered_json& v) {
    return {v.at(0).get<int>(), v.at(1).get<int>(), v.at(2).get<int>(), v.at(3).get<int>()};
}

/// Y of a box under one seed, and of the reference where `arm` is null.
std::vector<double> means_over(const TileBox& box, const std::string& sampler, std::uint64_t n, std::uint32_t seed) {
    const Scene& scene = bench().scene;
    Film film(scene.image().width, scene.image().height, n);
    for (const ShadingPoints& sites : sites_of(scene, box, nullptr))
        resolve_film(scene, sites, estimate_sites(sites, sampler, n, seed, "", nullptr), film);
    std::vector<double> out;
    for (int j = box.y0; j < box.y1; ++j)
        for (int i = box.x0; i < box.x1; ++i)
            out.push_back(double(film.y[static_cast<std::size_t>(j) * bench().width() + static_cast<std::size_t>(i)]));
    return out;
}

std::vector<double> reference_over(const TileBox& box) {
    Bench& b = bench();
    if (!b.quadrature) b.quadrature = std::make_unique<PixelQuadrature>(b.scene);
    ReferenceFilm film(b.experiment.image.width, b.experiment.image.height, b.scene.s());
    b.quadrature->write(box, film);
    std::vector<double> out;
    for (int j = box.y0; j < box.y1; ++j)
        for (int i = box.x0; i < box.x1; ++i)
            out.push_back(double(film.y[static_cast<std::size_t>(j) * b.width() + static_cast<std::size_t>(i)]));
    return out;
}

double mean_of(const std::vector<double>& all) {
    double sum = 0;
    for (const double x : all) sum += x;
    return sum / static_cast<double>(all.size());
}

double rms_of(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

/// {arm, n, box, seeds} -> {rmse: [one a seed], mean: [one a seed], reference: mean Y, median, q05, q95}.
CRESCENT_EXPORT(measure)()->void {
    const ordered_json asked = request();
    const Box box = box_of(asked.at("box"));
    const TileBox tile{box.x0, box.y0, box.x1 + 1, box.y1 + 1};
    const std::string sampler = arm_of(asked.at("arm").get<std::string>()).sampler;
    const std::vector<double> reference = reference_over(tile);
    Experiment series = bench().experiment;
    series.seeds = asked.at("seeds").get<int>();
    std::vector<double> rmse, mean;
    for (int k = 0; k < series.seeds; ++k) {
        const std::uint32_t seed = k == 0 ? series.seed : seed_of(series.seed, static_cast<std::uint32_t>(k));
        const std::vector<double> y = means_over(tile, sampler, asked.at("n").get<std::uint64_t>(), seed);
        rmse.push_back(rms_of(y, reference));
        mean.push_back(mean_of(y));
    }
    ordered_json out = {{"reference", told(mean_of(reference))}, {"median", told(quantile(rmse, 0.5))},
        {"q05", told(quantile(rmse, 0.05))}, {"q95", told(quantile(rmse, 0.95))},
        {"mean_median", told(quantile(mean, 0.5))}};
    for (const double x : rmse) out["rmse"].push_back(told(x));
    for (const double x : mean) out["mean"].push_back(told(x));
    say(out);
}

/// {arm, n, box} -> the largest sample of a box: its pixel, and X = f L cos / p taken apart.
CRESCENT_EXPORT(firefly)()->void {
    const ordered_json asked = request();
    const Box box = box_of(asked.at("box"));
    const std::string sampler = arm_of(asked.at("arm").get<std::string>()).sampler;
    const auto n = asked.at("n").get<std::uint64_t>();
    const Scene& scene = bench().scene;
    Film film(scene.image().width, scene.image().height, n);
    for (const ShadingPoints& sites : sites_of(scene, {box.x0, box.y0, box.x1 + 1, box.y1 + 1}, nullptr))
        resolve_film(scene, sites, estimate_sites(sites, sampler, n, bench().experiment.seed, "", nullptr), film);
    const auto at = static_cast<int>(std::ranges::max_element(film.largest) - film.largest.begin());
    const int i = at % film.width, j = at / film.width;
    if (!(film.largest[static_cast<std::size_t>(at)] > 0)) return say(ordered_json{{"i", i}, {"j", j}, {"x", "0"}});
    const std::vector<PixelSample> all = OpenPixel(scene, i, j).samples(sampler, n, bench().experiment.seed);
    const PixelSample& s = *std::ranges::max_element(all, {}, &PixelSample::x);
    say(ordered_json{{"i", std::to_string(i)}, {"j", std::to_string(j)}, {"x", figures(s.x)}, {"f", figures(s.f)},
        {"light", figures(s.light)}, {"cos", figures(s.cos)}, {"over_p", figures(1 / double(s.pdf))}});
}

/// {n} -> every furnace of the experiment at n samples: [{name, measured, expected, se, k, words}].
CRESCENT_EXPORT(furnaces_of)()->void {
    Experiment e = bench().experiment;
    for (FurnacePlan& plan : e.furnaces) plan.n = request().at("n").get<std::uint64_t>();
    ProgressMonitor watch;
    ordered_json out = ordered_json::array();
    for (const FurnaceMeter& f : furnaces(e, e.figures ? &*e.figures : nullptr, "", watch)) {
        ordered_json one = {
            {"name", f.name}, {"measured", told(f.measured)}, {"expected", told(f.expected)}, {"se", told(f.se)}};
        if (f.tail) one["k"] = told(f.tail->k);
        if (f.published) one["published"] = *f.published;
        out.push_back(one);
    }
    say(out);
}

}  // namespace crescent::web
