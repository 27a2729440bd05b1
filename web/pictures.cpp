// Films -> pixels for a canvas: photographs through the display chain, instruments through turbo or through two hues.
// Rows run from the top, four bytes a pixel: R, G, B, 255.
#include <algorithm>
#include <cmath>

#include "disk.h"

namespace crescent::web {

namespace {

enum class Picture { photograph, heat, signed_map };

const Srgb8 background{20, 21, 23};  // where an instrument has nothing to say

/// Two hues that stand for two arms, each fading to the ground: t in [-1, 1].
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

template <class F> Srgb8 photographed(const F& film, std::size_t at) {
    const Rgb radiance{film.r[at], film.g[at], film.b[at]};
    return photograph(radiance, bench().experiment.exposure);
}

Srgb8 colour(Picture picture, int index, int other, double top, std::size_t at) {
    if (picture == Picture::photograph)
        return index < 0 ? photographed(bench().reference, at) : photographed(slot(index).film, at);
    const double a = residual(slot(index).film, at);
    if (picture == Picture::heat) return turbo(a / top);
    return two_hues((residual(slot(other).film, at) - a) / top);
}

void put(std::byte* to, const Srgb8& colour) {
    for (std::size_t c = 0; c < 3; ++c) to[c] = static_cast<std::byte>(colour[c]);
    to[3] = std::byte{255};
}

}  // namespace

const void* Disk::paint(int size, const std::function<double(Vec3d)>& value) const {
    const auto side = static_cast<std::size_t>(size);
    std::vector<std::byte>& out = scratch<std::byte>();
    out.assign(side * side * 4, std::byte{0});
    std::vector<double> values(side * side, -1);
    double largest = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double x = (2 * double(k % side) + 1) / size - 1, y = 1 - (2 * double(k / side) + 1) / size;
        if (const auto wi = direction(x, y)) values[k] = value(*wi);
        if (std::isfinite(values[k])) largest = std::max(largest, values[k]);
    }
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (values[k] < 0) continue;
        const double t = values[k] > 0 && largest > 0 ? 1 + math::log10(values[k] / largest) / 4 : 0;
        put(&out[4 * k], turbo(std::clamp(t, 0.0, 1.0)));
    }
    return out.data();
}

/// The scale of maps as a row of `size` pixels: turbo, or for 2 the two hues with neither in the middle.
CRESCENT_EXPORT(scale_bar)(int picture, int size)->const void* {
    std::vector<std::byte>& out = scratch<std::byte>();
    out.resize(static_cast<std::size_t>(size) * 4);
    for (int k = 0; k < size; ++k) {
        const double t = (k + 0.5) / size;
        put(&out[4 * static_cast<std::size_t>(k)], picture == 2 ? two_hues(2 * t - 1) : turbo(t));
    }
    return out.data();
}

/// The pixels of a box: of film `index`, or of the reference for -1. picture 0: its photograph; 1: |Y - Y_ref|, turbo
/// from 0 to `top`; 2: |Y_other - Y_ref| - |Y - Y_ref| over `top`, in the first hue where `other` is nearer.
CRESCENT_EXPORT(paint)
(int picture, int index, int other, double top, int x0, int y0, int x1, int y1)->const void* {
    std::vector<std::byte>& out = scratch<std::byte>();
    out.resize(static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0) * 4);
    const bool needs_reference = picture != 0 || index < 0;
    if (needs_reference && bench().reference.size() == 0) {
        std::fill(out.begin(), out.end(), std::byte{0});
        return out.data();
    }
    std::byte* to = out.data();
    for (int j = y1 - 1; j >= y0; --j)
        for (int i = x0; i < x1; ++i) {
            const std::size_t at = static_cast<std::size_t>(j) * bench().width() + static_cast<std::size_t>(i);
            put(to, colour(static_cast<Picture>(picture), index, other, top, at));
            to += 4;
        }
    return out.data();
}

/// Where the scale of maps ends: the 98th percentile of |Y - Y_ref| over the geometry pixels of the first `count`
/// films.
CRESCENT_EXPORT(scale)(int count)->double {
    std::vector<double> all;
    const Bench& b = bench();
    for (int k = 0; k < count; ++k)
        for (std::size_t at = 0; at < b.pixels(); ++at)
            if (b.shapes.shape[at] >= 0) all.push_back(residual(slot(k).film, at));
    std::erase_if(all, [](double v) { return !std::isfinite(v); });
    if (all.empty()) return 1;
    const auto place = all.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), place, all.end());
    return *place > 0 ? *place : 1;
}

}  // namespace crescent::web
