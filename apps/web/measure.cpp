// Measurements for lessons: an arm over a region at one N on several seeds, the largest sample, furnaces. Every number
// comes with its seeds; conclude.cpp draws the conclusions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "parts.h"

namespace crescent::web {

namespace {

/// RMSE of an arm over a box on several seeds.
struct Measuring {
    explicit Measuring(const ordered_json& query)
        : area(requested_area(query)),
          box(tile_of(area.box)),
          sampler(arm_of(query.at("arm").get<std::string>()).sampler),
          n(query.at("n").get<std::uint64_t>()),
          name(fmt::format("{}, N = {}: RMSE of {}", query.value("as", query.at("arm").get<std::string>()), n,
              query.at("region").get<std::string>())),
          film(bench().experiment.image.width, bench().experiment.image.height, bench().scene.s()),
          y(query.at("seeds").get<std::size_t>(), std::vector<double>(pixels_of(box))) {}

    void add_reference(const TileBox& part) { reference_over(part, film); }
    void add_film(const TileBox& part, std::size_t seed) {
        const std::uint32_t first = bench().experiment.seed;
        const Film part_film =
            film_over(part, sampler, n, seed == 0 ? first : seed_of(first, static_cast<std::uint32_t>(seed)));
        std::size_t from = 0;
        for (int j = part.y0; j < part.y1; ++j)
            for (int i = part.x0; i < part.x1; ++i, ++from) {
                y[seed][at(i, j)] = double(part_film.y[from]);
                const std::size_t index = static_cast<std::size_t>(j) * bench().width() + std::size_t(i);
                if (area.surface == any_surface || bench().shapes.shape[index] == area.surface)
                    hits += part_film.light_hits[from];
            }
    }
    void send() const {
        const AreaPixels area_pixels(area, bench().shapes);
        const bool is_paired = bench().experiment.reference.kind == ReferenceKind::paired;
        const double error = is_paired ? rms(film.error, area_pixels) : 0;
        const auto difference = [&](const std::vector<double>& values, std::size_t index) {
            const auto i = static_cast<int>(index % bench().width()), j = static_cast<int>(index / bench().width());
            return values[at(i, j)] - double(film.y[index]);
        };
        std::vector<double> rmse;
        for (const std::vector<double>& values : y) {
            const double mse = area_pixels.mean([&](std::size_t index) {
                const double d = difference(values, index);
                return d * d;
            });
            rmse.push_back(std::sqrt(std::max(0.0, mse - error * error)));
        }
        const auto pixels = static_cast<double>(area_pixels.count());
        const double directions = pixels * double(n) * double(directions_per_sample(sampler)) * double(y.size());
        ordered_json out = {{"name", name}, {"n", n}, {"median", json_number(quantile(rmse, 0.5))},
            {"q05", json_number(quantile(rmse, 0.05))}, {"q95", json_number(quantile(rmse, 0.95))},
            {"mean", json_number(area_pixels.mean([&](std::size_t index) { return double(film.y[index]); }))},
            {"met", json_number(double(hits) / directions)}, {"rmse", ordered_json::array()}};
        for (const double x : rmse) out["rmse"].push_back(json_number(x));
        respond(out);
    }

    Area area;
    TileBox box;
    std::string sampler;
    std::uint64_t n = 0;

private:
    std::size_t at(int i, int j) const {
        return static_cast<std::size_t>(j - box.y0) * static_cast<std::size_t>(box.x1 - box.x0) +
            std::size_t(i - box.x0);
    }
    std::string name;
    ReferenceFilm film;
    std::uint64_t hits = 0;

public:
    std::vector<std::vector<double>> y;  // by seed
};

/// The largest sample of a box; among equal ones, the first from the bottom-left.
struct Largest {
    float x = 0;
    int i = 0, j = 0;

    void look(const TileBox& part, const std::string& sampler, std::uint64_t n) {
        const Film film = film_over(part, sampler, n, bench().experiment.seed);
        const auto index = static_cast<int>(std::ranges::max_element(film.largest) - film.largest.begin());
        const int column = part.x0 + index % film.width, row = part.y0 + index / film.width;
        const float largest = film.largest[static_cast<std::size_t>(index)];
        if (largest > x || (largest == x && std::pair(row, column) < std::pair(j, i))) {
            x = largest;
            i = column;
            j = row;
        }
    }
    void send(const std::string& sampler, std::uint64_t n) const {
        if (!(x > 0))
            return respond(ordered_json{{"answer", "none"}, {"kind", "none"}, {"lines", {"no sample met any light"}}});
        const std::vector<PixelSample> samples =
            OpenPixel(bench().scene, i, j).samples(sampler, n, bench().experiment.seed);
        const PixelSample& s = *std::ranges::max_element(samples, {}, &PixelSample::x);
        const std::vector<std::pair<std::string, double>> factors = {
            {"f", s.f}, {"L", s.light}, {"cos", s.cos}, {"1/p", 1 / double(s.pdf)}};
        const auto& largest_factor = *std::ranges::max_element(factors, {}, &std::pair<std::string, double>::second);
        const std::string line = fmt::format("pixel ({}, {}): X = {} of f = {}/sr, L = {}, cos = {}, 1/p = {} sr", i, j,
            figures(s.x), figures(s.f), figures(s.light), figures(s.cos), figures(1 / double(s.pdf)));
        respond(ordered_json{
            {"answer", largest_factor.first}, {"kind", largest_factor.first}, {"lines", {line}}, {"pixel", {i, j}}});
    }
};

/// The results of the furnaces, one after another, and why the requested one deviates.
struct Furnaces {
    explicit Furnaces(std::string furnace) : name(std::move(furnace)) {}

    void add(FurnacePlan plan, std::uint64_t n) {
        plan.n = n;
        ProgressMonitor monitor;
        describe(read_furnace(draw_furnace(bench().experiment, plan, "", monitor)));
    }
    void send() const { respond(ordered_json{{"answer", cause}, {"kind", cause}, {"lines", lines}}); }

private:
    void describe(const FurnaceResult& f) {
        const double deviation = std::fabs(f.measured - f.expected),
                     rounding = std::ldexp(f.expected * double(f.n), -24);
        std::string words = f.name;
        std::ranges::replace(words, '_', ' ');
        lines.push_back(fmt::format("{}: reads {} ± {}, expected {}{}", words, figures(f.measured), figures(f.se, 2),
            figures(f.expected),
            f.tail ? fmt::format(", tail k\u0302 {} ± {}", figures(f.tail->k, 2), figures(f.tail->se, 1)) : ""));
        if (f.name != name) return;
        if (deviation <= rounding) cause = "precision";
        else if (f.tail && f.tail->heavy()) cause = "tail";
        else if (deviation > 4 * f.se) cause = "bug";
    }
    std::string name, cause = "none";
    ordered_json lines = ordered_json::array();
};

}  // namespace

/// {arm, n, region, box, seeds, as} -> {name, n, rmse: [one per seed], median, q05, q95, mean, met}; `as`: its name if
/// that is not the arm's; mean: of the reference's Y; met: the share of directions that met a light.
CRESCENT_EXPORT(measure)()->void {
    const ordered_json query = request();
    Measuring m(query);
    prepare_reference();
    for (const TileBox& part : parts_of(m.box, reference_cost(bench().experiment))) m.add_reference(part);
    for (const TileBox& part : parts_of(m.box, cost_of(m.sampler, m.n)))
        for (std::size_t k = 0; k < m.y.size(); ++k) m.add_film(part, k);
    m.send();
}

/// {arm, n, box} -> the largest sample of a box: the factors of X = f L cos / p, which factor is the largest, its
/// pixel.
CRESCENT_EXPORT(firefly)()->void {
    const ordered_json query = request();
    const std::string sampler = arm_of(query.at("arm").get<std::string>()).sampler;
    const auto n = query.at("n").get<std::uint64_t>();
    Largest largest;
    for (const TileBox& part : parts_of(tile_of(requested_box(query)), cost_of(sampler, n)))
        largest.look(part, sampler, n);
    largest.send(sampler, n);
}

/// {n, name} -> the value of that furnace of the experiment at n samples and why; a line for each furnace. tail: it
/// deviates and k-hat indicates infinite variance; bug: it deviates by more than four standard errors and the variance
/// is finite; precision: the deviation is within the error of float sums of n terms, n 2^-24; none: it does not
/// deviate.
CRESCENT_EXPORT(furnaces_of)()->void {
    const ordered_json query = request();
    const auto n = query.at("n").get<std::uint64_t>();
    Furnaces furnaces(query.at("name").get<std::string>());
    for (const FurnacePlan& plan : bench().experiment.furnaces) furnaces.add(plan, n);
    furnaces.send();
}

}  // namespace crescent::web
