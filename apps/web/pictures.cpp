// Converts films to pixels for a canvas: tone-mapped photographs, maps in turbo or in two hues. Rows run from the top,
// four bytes per pixel: R, G, B, 255.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "disk.h"

namespace crescent::web {

namespace {

enum class Picture { photograph, heat, signed_map };

const Srgb8 background{20, 21, 23};  // where a map has no value

/// Two hues for two arms, each fading to the ground: t in [-1, 1].
Srgb8 two_hues(double t) {
    if (std::isnan(t)) return not_a_number_colour;
    const double k = std::sqrt(std::min(std::fabs(t), 1.0));
    const Srgb8& far = t < 0 ? Srgb8{100, 184, 242} : Srgb8{243, 154, 77};
    Srgb8 out;
    for (std::size_t c = 0; c < 3; ++c)
        out[c] = static_cast<unsigned char>(std::lround(background[c] + k * (far[c] - background[c])));
    return out;
}

double residual(const Film& film, std::size_t at) {
    return std::fabs(static_cast<double>(film.y[at]) - static_cast<double>(bench().reference.y[at]));
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

template <class F> void photographed(const F& film, const TileBox& box, std::byte* to) {
    const double exposure = bench().experiment.exposure;
    each_pixel(box, to, [&](std::size_t at) { return photograph(Rgb{film.r[at], film.g[at], film.b[at]}, exposure); });
}

void mapped(Picture picture, int index, int other, double top, const TileBox& box, std::byte* to) {
    const Film &film = slot(index).film, &beside = slot(picture == Picture::heat ? index : other).film;
    each_pixel(box, to, [&](std::size_t at) {
        const double a = residual(film, at);
        return picture == Picture::heat ? turbo(a / top) : two_hues((residual(beside, at) - a) / top);
    });
}

std::vector<std::byte> disk_pixels;
constexpr std::uint64_t direction_cost = 20;  // of a density or of f L, in samples of a pixel

/// A disk and its values row by row from the top, -1 outside.
struct Shade {
    Disk disk;
    std::size_t side;
    std::function<double(Vec3d)> value;
    std::vector<double> values;
    double largest = 0;

    void look(std::size_t from, std::size_t to) {
        count_work((to - from) * side * direction_cost);
        const auto size = static_cast<double>(side);
        for (std::size_t k = from * side; k < to * side; ++k) {
            const double x = (2 * double(k % side) + 1) / size - 1, y = 1 - (2 * double(k / side) + 1) / size;
            if (const auto wi = disk.direction(x, y)) values[k] = value(*wi);
            if (std::isfinite(values[k])) largest = std::max(largest, values[k]);
        }
    }
    void colour(std::size_t from, std::size_t to) const {
        count_work((to - from) * side * colour_cost);
        if (from == 0) disk_pixels.assign(values.size() * 4, std::byte{0});
        for (std::size_t k = from * side; k < to * side; ++k) {
            if (values[k] < 0) continue;
            const double t = values[k] > 0 && largest > 0 ? 1 + math::log10(values[k] / largest) / 4 : 0;
            put(&disk_pixels[4 * k], turbo(std::clamp(t, 0.0, 1.0)));
        }
        if (to == side) respond(ordered_json::object());
    }
};

/// The 98th percentile of |Y - Y_ref| over the geometry pixels of some films, in parts: values by the first 16 bits of
/// a double, which order non-negative numbers as their values do; then those of the bin of the percentile.
class Percentile {
public:
    void count(int film, std::size_t from, std::size_t to) {
        each(film, from, to, [&](double v) { ++sizes_[bin_of(v)]; });
    }
    void keep(int film, std::size_t from, std::size_t to) {
        if (!found_) find();
        each(film, from, to, [&](double v) {
            if (bin_of(v) == bin_) kept_.push_back(v);
        });
    }
    double value() {
        if (kept_.empty()) return 1;
        const auto place = kept_.begin() + static_cast<std::ptrdiff_t>(place_);
        std::nth_element(kept_.begin(), place, kept_.end());
        return *place > 0 ? *place : 1;
    }

private:
    static std::size_t bin_of(double v) { return std::bit_cast<std::uint64_t>(v) >> 48; }
    template <class Take> void each(int film, std::size_t from, std::size_t to, const Take& take) const {
        count_work((to - from) * scale_cost);
        for (std::size_t at = from; at < to; ++at) {
            if (bench().shapes.shape[at] < 0) continue;
            if (const double v = residual(slot(film).film, at); std::isfinite(v)) take(v);
        }
    }
    /// Finds the bin of the percentile, and the rank within it.
    void find() {
        found_ = true;
        const std::size_t all = std::accumulate(sizes_.begin(), sizes_.end(), std::size_t{0});
        if (all == 0) return;
        place_ = static_cast<std::size_t>(0.98 * static_cast<double>(all - 1));
        while (place_ >= sizes_[bin_]) place_ -= sizes_[bin_++];
    }
    std::vector<std::size_t> sizes_ = std::vector<std::size_t>(1 << 16);
    std::vector<double> kept_;
    std::size_t bin_ = 0, place_ = 0;
    bool found_ = false;
};

}  // namespace

Parts painted(const Disk& disk, int size, const std::function<double(Vec3d)>& value) {
    const auto side = static_cast<std::size_t>(size);
    const auto of = std::make_shared<Shade>(Shade{disk, side, value, std::vector<double>(side * side, -1)});
    Parts parts;
    const std::size_t rows = std::max<std::size_t>(1, most_of_part / direction_cost / side);
    for (std::size_t from = 0; from < side; from += rows)
        parts.emplace_back([=] { of->look(from, std::min(side, from + rows)); });
    for (std::size_t from = 0; from < side; from += rows)
        parts.emplace_back([=] { of->colour(from, std::min(side, from + rows)); });
    return parts;
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

/// Paints the pixels of a box: of film `index`, or of the reference for -1. picture 0: its photograph; 1: |Y - Y_ref|,
/// turbo from 0 to `top`; 2: |Y_other - Y_ref| - |Y - Y_ref| over `top`, in the first hue if `other` is nearer.
CRESCENT_EXPORT(paint)
(int picture, int index, int other, double top, int x0, int y0, int x1, int y1)->const void* {
    const TileBox box{x0, y0, x1, y1};
    std::vector<std::byte>& out = scratch<std::byte>();
    out.resize(pixels_of(box) * 4);
    count_work(pixels_of(box) * colour_cost);
    const bool needs_reference = picture != 0 || index < 0;
    if (needs_reference && bench().reference.size() == 0) {
        std::fill(out.begin(), out.end(), std::byte{0});
        return out.data();
    }
    if (picture != 0) mapped(static_cast<Picture>(picture), index, other, top, box, out.data());
    else if (index < 0) photographed(bench().reference, box, out.data());
    else photographed(slot(index).film, box, out.data());
    return out.data();
}

/// Returns the end of the scale of maps, {"top": ...}: the 98th percentile of |Y - Y_ref| over the geometry pixels of
/// the first `count` films.
CRESCENT_EXPORT(scale)(int count)->void {
    const auto of = std::make_shared<Percentile>();
    const std::size_t pixels = bench().pixels(), most = most_of_part / scale_cost;
    Parts parts;
    for (const auto step : {&Percentile::count, &Percentile::keep})
        for (int film = 0; film < count; ++film)
            for (std::size_t from = 0; from < pixels; from += most)
                parts.emplace_back([=] { ((*of).*step)(film, from, std::min(pixels, from + most)); });
    parts.emplace_back([=] { respond(ordered_json{{"top", of->value()}}); });
    begin(std::move(parts));
}

}  // namespace crescent::web
