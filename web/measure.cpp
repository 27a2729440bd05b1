// What lessons ask: an arm over a region at one N on several seeds, the largest sample, furnaces. Every number with its
// seeds; conclude.cpp says what they come to.
#include <fmt/format.h>

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

double rms_of(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

/// {arm, n, region, box, seeds, as} -> {name, n, rmse: [one a seed], median, q05, q95}; `as`: its name where that is
/// not the arm's.
CRESCENT_EXPORT(measure)()->void {
    const ordered_json asked = request();
    const Box box = box_of(asked.at("box"));
    const TileBox tile{box.x0, box.y0, box.x1 + 1, box.y1 + 1};
    const std::string sampler = arm_of(asked.at("arm").get<std::string>()).sampler;
    const std::vector<double> reference = reference_over(tile);
    Experiment series = bench().experiment;
    series.seeds = asked.at("seeds").get<int>();
    std::vector<double> rmse;
    const auto arm = asked.at("arm").get<std::string>();
    const auto n = asked.at("n").get<std::uint64_t>();
    for (int k = 0; k < series.seeds; ++k) {
        const std::uint32_t seed = k == 0 ? series.seed : seed_of(series.seed, static_cast<std::uint32_t>(k));
        const std::vector<double> y = means_over(tile, sampler, n, seed);
        rmse.push_back(rms_of(y, reference));
    }
    ordered_json out = {
        {"name",
            fmt::format("{}, N = {}: RMSE of {}", asked.value("as", arm), n, asked.at("region").get<std::string>())},
        {"n", n}, {"median", told(quantile(rmse, 0.5))}, {"q05", told(quantile(rmse, 0.05))},
        {"q95", told(quantile(rmse, 0.95))}, {"rmse", ordered_json::array()}};
    for (const double x : rmse) out["rmse"].push_back(told(x));
    say(out);
}

/// {arm, n, box} -> the largest sample of a box: X = f L cos / p taken apart, which factor is the largest, its pixel.
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
    if (!(film.largest[static_cast<std::size_t>(at)] > 0))
        return say(ordered_json{{"answer", "none"}, {"kind", "none"}, {"lines", {"no sample met any light"}}});
    const std::vector<PixelSample> all = OpenPixel(scene, i, j).samples(sampler, n, bench().experiment.seed);
    const PixelSample& s = *std::ranges::max_element(all, {}, &PixelSample::x);
    const std::vector<std::pair<std::string, double>> factors = {
        {"f", s.f}, {"L", s.light}, {"cos", s.cos}, {"1/p", 1 / double(s.pdf)}};
    const auto& most = *std::ranges::max_element(factors, {}, &std::pair<std::string, double>::second);
    const std::string line = fmt::format("pixel ({}, {}): X = {} of f = {}/sr, L = {}, cos = {}, 1/p = {} sr", i, j,
        figures(s.x), figures(s.f), figures(s.light), figures(s.cos), figures(1 / double(s.pdf)));
    say(ordered_json{{"answer", most.first}, {"kind", most.first}, {"lines", {line}}, {"pixel", {i, j}}});
}

/// {n, name} -> what that furnace of the experiment reads at n samples and why; a line for each furnace.
/// tail: it is off and k-hat says that the variance is infinite; bug: it is off by more than four standard errors
/// though it is not; precision: float sums of n terms may be that far off, n 2^-24; none: it is not off.
CRESCENT_EXPORT(furnaces_of)()->void {
    Experiment e = bench().experiment;
    const auto n = request().at("n").get<std::uint64_t>();
    for (FurnacePlan& plan : e.furnaces) plan.n = n;
    ProgressMonitor watch;
    ordered_json lines = ordered_json::array();
    std::string why = "none";
    for (const FurnaceMeter& f : furnaces(e, e.figures ? &*e.figures : nullptr, "", watch)) {
        const double off = std::fabs(f.measured - f.expected), rounding = std::ldexp(f.expected * double(n), -24);
        std::string name = f.name;
        std::ranges::replace(name, '_', ' ');
        lines.push_back(fmt::format("{}: reads {} ± {}, expected {}{}", name, figures(f.measured), figures(f.se, 2),
            figures(f.expected),
            f.tail ? fmt::format(", tail k\u0302 {} ± {}", figures(f.tail->k, 2), figures(f.tail->se, 1)) : ""));
        if (f.name != request().at("name").get<std::string>()) continue;
        if (off <= rounding) why = "precision";
        else if (f.tail && f.tail->heavy()) why = "tail";
        else if (off > 4 * f.se) why = "bug";
    }
    say(ordered_json{{"answer", why}, {"kind", why}, {"lines", lines}});
}

}  // namespace crescent::web
