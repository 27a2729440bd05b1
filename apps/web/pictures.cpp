// Converts films to pixels for a canvas: tone-mapped photographs, maps in turbo or in two hues. Rows run from the top,
// four bytes per pixel: R, G, B, 255.
#include <algorithm>
#include <cmath>

#include "disk.h"

namespace crescent::web {

namespace {

enum class Picture { photograph, heat, signed_map, variance };

const Srgb8 background{20, 21, 23};     // where a map has no value
constexpr double variance_decades = 6;  // of the map of variances, below its top

/// Two hues for two arms, each fading to the ground: t in [-1, 1].
Srgb8 two_hues(double t) {
    if (std::isnan(t)) return not_a_number_colour;
    const double k = std::sqrt(std::min(std::fabs(t), 1.0));
    const Srgb8& hue = t < 0 ? Srgb8{100, 184, 242} : Srgb8{243, 154, 77};
    Srgb8 out;
    for (std::size_t c = 0; c < 3; ++c)
        out[c] = static_cast<unsigned char>(std::lround(background[c] + k * (hue[c] - background[c])));
    return out;
}

double residual(const Film& film, std::size_t pixel) {
    return std::fabs(static_cast<double>(film.y[pixel]) - static_cast<double>(bench().reference.y[pixel]));
}

void put(std::byte* to, const Srgb8& colour) {
    for (std::size_t c = 0; c < 3; ++c) to[c] = static_cast<std::byte>(colour[c]);
    to[3] = std::byte{255};
}

/// colour(at) for every pixel of a box, row by row from the top.
template <class Colour> void each_pixel(const TileBox& box, std::byte* to, const Colour& colour) {
    for (int j = box.y1 - 1; j >= box.y0; --j) {
        const std::size_t row = static_cast<std::size_t>(j) * bench().width();
        for (int i = box.x0; i < box.x1; ++i, to += 4) put(to, colour(row + static_cast<std::size_t>(i)));
    }
}

template <class F> void photographed(const F& film, double times, const TileBox& box, std::byte* to) {
    const double exposure = bench().experiment.exposure * times;
    each_pixel(box, to,
        [&](std::size_t pixel) { return photograph(Rgb{film.r[pixel], film.g[pixel], film.b[pixel]}, exposure); });
}

void mapped(Picture picture, int index, int other, double top, const TileBox& box, std::byte* to) {
    const Film &film = slot(index).film, &second_film = slot(picture == Picture::heat ? index : other).film;
    each_pixel(box, to, [&](std::size_t pixel) {
        const double a = residual(film, pixel);
        return picture == Picture::heat ? turbo(a / top) : two_hues((residual(second_film, pixel) - a) / top);
    });
}

/// The variance of one sample of a pixel, (W/(sr m^2))^2.
double sample_variance(const Slot& slot, std::size_t pixel) {
    return static_cast<double>(slot.film.var[pixel]) * static_cast<double>(slot.film.n);
}

void variances(int index, double top, const TileBox& box, std::byte* to) {
    const Slot& film_slot = slot(index);
    each_pixel(box, to, [&](std::size_t pixel) {
        const double v = sample_variance(film_slot, pixel);
        return v > 0 ? turbo(std::clamp(1 + math::log10(v / top) / variance_decades, 0.0, 1.0)) : background;
    });
}

std::vector<std::byte> disk_pixels;

/// The 98th percentile of values over the geometry pixels of some films; 1 if there is none above 0.
template <class Value> double end_of_scale(int films, const Value& value) {
    std::vector<double> values;
    for (int film = 0; film < films; ++film)
        for (std::size_t pixel = 0; pixel < bench().pixels(); ++pixel)
            if (bench().shapes.shape[pixel] >= 0)
                if (const double v = value(slot(film), pixel); std::isfinite(v)) values.push_back(v);
    if (values.empty()) return 1;
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, place);
    return *place > 0 ? *place : 1;
}

}  // namespace

void paint_disk(const Disk& disk, int size, const std::function<double(Vec3d)>& value) {
    const auto side = static_cast<std::size_t>(size);
    std::vector<double> values(side * side, -1);  // -1: outside the disk
    double largest = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double x = (2 * double(k % side) + 1) / size - 1, y = 1 - (2 * double(k / side) + 1) / size;
        if (const auto wi = disk.direction(x, y)) values[k] = value(*wi);
        if (std::isfinite(values[k])) largest = std::max(largest, values[k]);
    }
    disk_pixels.assign(values.size() * 4, std::byte{0});
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (values[k] < 0) continue;
        const double t = values[k] > 0 && largest > 0 ? 1 + math::log10(values[k] / largest) / 4 : 0;
        put(&disk_pixels[4 * k], turbo(std::clamp(t, 0.0, 1.0)));
    }
    respond(ordered_json::object());
}

void paint_ratio(const Disk& disk, int size, const std::function<double(double, double)>& ratio) {
    const auto side = static_cast<std::size_t>(size);
    disk_pixels.assign(side * side * 4, std::byte{0});
    for (std::size_t k = 0; k < side * side; ++k) {
        const double x = (2 * double(k % side) + 1) / size - 1, y = 1 - (2 * double(k / side) + 1) / size;
        if (!disk.direction(x, y)) continue;
        const double r = ratio(x, y);
        put(&disk_pixels[4 * k], two_hues(r > 0 ? std::clamp(math::log10(r) / math::log10(2.0), -1.0, 1.0) : -1));
    }
    respond(ordered_json::object());
}

/// Returns the disk that was painted last.
CRESCENT_EXPORT(disk)()->const void* { return disk_pixels.data(); }

/// Returns the scale of maps as a row of `size` pixels: turbo; for 2, the two hues with neither in the middle.
CRESCENT_EXPORT(scale_bar)(int picture, int size)->const void* {
    std::vector<std::byte>& out = scratch<std::byte>();
    out.resize(static_cast<std::size_t>(size) * 4);
    for (int k = 0; k < size; ++k) {
        const double t = (k + 0.5) / size;
        put(&out[4 * static_cast<std::size_t>(k)], picture == 2 ? two_hues(2 * t - 1) : turbo(t));
    }
    return out.data();
}

/// Paints the pixels of a box: of film `index`, or of the reference for -1. picture 0: its photograph, at `times` the
/// exposure of the experiment; 1: |Y - Y_ref|, turbo from 0 to `top`; 2: |Y_other - Y_ref| - |Y - Y_ref| over `top`, in
/// the first hue if `other` is nearer; 3: the variance of one sample, six decades up to `top`.
CRESCENT_EXPORT(paint)
(int picture, int index, int other, double top, double times, int x0, int y0, int x1, int y1)->const void* {
    const TileBox box{x0, y0, x1, y1};
    std::vector<std::byte>& out = scratch<std::byte>();
    out.resize(pixels_of(box) * 4);
    const auto what = static_cast<Picture>(picture);
    const bool needs_reference = what == Picture::heat || what == Picture::signed_map || index < 0;
    if (needs_reference && bench().reference.size() == 0) {
        std::fill(out.begin(), out.end(), std::byte{0});
        return out.data();
    }
    if (what == Picture::variance) variances(index, top, box, out.data());
    else if (what != Picture::photograph) mapped(what, index, other, top, box, out.data());
    else if (index < 0) photographed(bench().reference, times, box, out.data());
    else photographed(slot(index).film, times, box, out.data());
    return out.data();
}

/// Returns the ends of the scales of maps of the first `count` films, {"top": |Y - Y_ref|, "variance": ...}: 98th
/// percentiles over the geometry pixels.
CRESCENT_EXPORT(scale)(int count)->void {
    const auto error = [](const Slot& s, std::size_t pixel) { return residual(s.film, pixel); };
    respond(ordered_json{{"top", end_of_scale(count, error)}, {"variance", end_of_scale(count, sample_variance)}});
}

/// {i, j, count, reference: whether it is computed} -> {shape, reference, films: [{y, error, se, n, zero, met}]} of the
/// first `count` films at a pixel; se: the standard error of Y; zero, met: shares of the directions that fell below the
/// horizon, and that met a light.
CRESCENT_EXPORT(pixel_values)()->void {
    const ordered_json query = request();
    const Bench& b = bench();
    const std::size_t pixel = query.at("j").get<std::size_t>() * b.width() + query.at("i").get<std::size_t>();
    const bool has_reference = query.at("reference").get<bool>() && pixel < b.reference.size();
    const int shape = pixel < b.shapes.shape.size() ? b.shapes.shape[pixel] : -1;
    ordered_json out = {{"shape", shape < 0 ? "" : b.experiment.surface_name(static_cast<std::size_t>(shape))},
        {"films", ordered_json::array()}};
    if (has_reference) out["reference"] = figures(double(b.reference.y[pixel]));
    for (int k = 0; k < query.at("count").get<int>(); ++k) {
        const Film& film = slot(k).film;
        if (film.y.size() != b.pixels() || pixel >= film.y.size()) continue;  // not begun yet; outside
        const double directions = static_cast<double>(film.n * film.directions);
        ordered_json entry = {{"y", figures(double(film.y.at(pixel)))}, {"n", film.n},
            {"se", figures(std::sqrt(double(film.var.at(pixel))), 2)},
            {"zero", figures(100 * double(film.horizon.at(pixel)) / directions, 3)},
            {"met", figures(100 * double(film.light_hits.at(pixel)) / directions, 3)}};
        if (has_reference) entry["error"] = figures(double(film.y[pixel]) - double(b.reference.y[pixel]), 3);
        out["films"].push_back(std::move(entry));
    }
    respond(out);
}

}  // namespace crescent::web
