// Boxes are cut into parts at most 64 pixels across. Shading points are kept by box for as many pixels as the page
// permits, else for one.
#include "parts.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace crescent::web {

namespace {

std::size_t most_points = 0;  // kept for one experiment; about 200 bytes each

std::uint64_t bad_of(const Moments& m, std::size_t count) {
    return std::accumulate(m.bad.begin(), m.bad.begin() + static_cast<std::ptrdiff_t>(count), std::uint64_t{0});
}

/// Returns the index of an image pixel in a box.
std::uint32_t within(std::uint32_t pixel, const TileBox& box) {
    const auto width = static_cast<std::uint32_t>(bench().width());
    const auto i = static_cast<int>(pixel % width), j = static_cast<int>(pixel / width);
    return static_cast<std::uint32_t>((j - box.y0) * (box.x1 - box.x0) + i - box.x0);
}

/// Returns the hits of the primary rays of a box; they are traced once for all samplers and sample counts.
std::vector<ShadingPoints>& points_seen(const TileBox& box) {
    Bench& b = bench();
    const std::array key = {box.x0, box.y0, box.x1, box.y1};
    if (const auto entry = b.shading_points.find(key); entry != b.shading_points.end()) return entry->second;
    if (b.points_last == key) return b.last;
    b.shapes.width = b.experiment.image.width;
    b.shapes.height = b.experiment.image.height;
    b.shapes.shape.resize(b.pixels());
    std::vector<ShadingPoints> points = shading_points_of(b.scene, box, b.shapes.shape.data());
    if (b.points_kept + pixels_of(box) > most_points) return b.points_last = key, b.last = std::move(points);
    b.points_kept += pixels_of(box);
    return b.shading_points[key] = std::move(points);
}

}  // namespace

std::uint64_t pixels_of(const TileBox& b) {
    return static_cast<std::uint64_t>(b.x1 - b.x0) * static_cast<std::uint64_t>(b.y1 - b.y0);
}

Box requested_box(const ordered_json& query) {
    const ordered_json& v = query.at("box");
    return {v.at(0).get<int>(), v.at(1).get<int>(), v.at(2).get<int>(), v.at(3).get<int>()};
}

Area requested_area(const ordered_json& query) {
    const Region* region = bench().experiment.find_region(query.value("region", ""));
    return {requested_box(query), region ? region->surface : any_surface};
}

const ShapeMap& all_shapes() {
    Bench& b = bench();
    if (!b.all_shapes) b.all_shapes = shape_map(b.scene);
    return *b.all_shapes;
}

TileBox tile_of(const Box& box) { return {box.x0, box.y0, box.x1 + 1, box.y1 + 1}; }

std::vector<TileBox> parts_of(const TileBox& box, std::uint64_t cost_of_pixel) {
    const auto most_pixels = static_cast<int>(std::clamp<std::uint64_t>(most_of_part / cost_of_pixel, 1, 4096));
    const int width = std::min({64, most_pixels, box.x1 - box.x0}), height = std::max(1, most_pixels / width);
    std::vector<TileBox> parts;
    for (int y0 = box.y0; y0 < box.y1; y0 += height)
        for (int x0 = box.x0; x0 < box.x1; x0 += width)
            parts.push_back({x0, y0, std::min(x0 + width, box.x1), std::min(y0 + height, box.y1)});
    return parts;
}

std::uint64_t cost_of(const SamplerRef& sampler, std::uint64_t n) {
    return n * cost_of_sample(sampler).directions + film_cost;
}

std::uint64_t reference_cost(const Experiment& experiment) {
    constexpr std::uint64_t by_quadrature = 2000, estimates = 2, samplers = 5, scalar = 4;
    if (experiment.reference.kind != ReferenceKind::paired) return by_quadrature;
    return estimates * samplers * scalar * experiment.reference.n;
}

Film film_over(const TileBox& box, const SamplerRef& sampler, std::uint64_t n, std::uint32_t seed) {
    Film film(box.x1 - box.x0, box.y1 - box.y0, n);
    for (ShadingPoints& shading_points : points_seen(box)) {
        const Moments moments = estimate_points(shading_points, sampler, n, seed, "", nullptr);
        const std::vector<std::uint32_t> of_image = shading_points.pixel;
        for (std::uint32_t& pixel : shading_points.pixel) pixel = within(pixel, box);
        resolve_film(bench().scene, shading_points, moments, film);
        shading_points.pixel = of_image;
        film.invalid += bad_of(moments, shading_points.count);
    }
    for_each_background(bench().scene, box,
        [&](std::uint32_t pixel, const Rgb& radiance) { store_background(film, within(pixel, box), radiance); });
    return film;
}

void prepare_reference() {
    Bench& b = bench();
    if (b.quadrature || b.experiment.reference.kind == ReferenceKind::paired) return;
    b.quadrature = std::make_unique<PixelQuadrature>(b.scene, std::vector{b.scene.s()});
}

void reference_over(const TileBox& box, ReferenceFilm& film) {
    Bench& b = bench();
    if (b.experiment.reference.kind == ReferenceKind::paired) {
        for (const ShadingPoints& points : points_seen(box))
            write_paired(b.scene, points, paired_plan(b.experiment), nullptr, film);
        write_background(b.scene, box, film);
        return;
    }
    ensure(b.quadrature != nullptr, "the reference was prepared");
    b.quadrature->write(box, {&film, 1});
}

/// Must be called before reference_tile(); returns {} once it is done.
CRESCENT_EXPORT(prepare_reference)()->void {
    prepare_reference();
    respond(ordered_json::object());
}
/// Keeps the hits of primary rays for this many pixels of an experiment, for tiles that are requested again.
CRESCENT_EXPORT(keep_points)(double pixels)->void { most_points = static_cast<std::size_t>(pixels); }
/// The cost of a pixel of a film without its samples, in samples.
CRESCENT_EXPORT(film_cost)()->double { return static_cast<double>(film_cost); }

}  // namespace crescent::web
