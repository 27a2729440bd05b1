// The elevation of a direction is kept as h = 1 - |cos theta|, which does not lose the rows near the poles. Sums in
// double, row by row. A row or a texel without mass has an empty interval and is never drawn; one with less than 2^-24
// of its row's mass may never be drawn either.
#include "scene/sky.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <span>

#include "base/counted.h"
#include "base/parallel.h"
#include "math/functions.h"
#include "math/simd/scalar.h"
#include "scene/texture.h"

namespace crescent {

namespace {

/// Columns for each entry of the guide of a row.
constexpr std::size_t columns_a_guide = 4;

/// Draws whose tables are fetched together.
constexpr std::size_t draws_at_once = 16;

/// Writes the guides: how many of `rising` are at most k / guides.size(), for each k; convert(x): x in their unit.
template <class Numbers, class Convert>
void write_guides(std::span<std::uint16_t> guides, const Numbers& rising, const Convert& convert) {
    std::size_t index = 0;
    for (std::size_t k = 0; k < guides.size(); ++k) {
        const double x = convert(static_cast<double>(k) / static_cast<double>(guides.size()));
        while (index < rising.size() && static_cast<double>(rising[index]) <= x) ++index;
        guides[k] = static_cast<std::uint16_t>(index);
    }
}

/// The azimuth atan2(y, x) / (2 pi) within 1e-9, in a tenth of the time of math::atan2: half-angle reduction to
/// |r| <= tan(pi / 8), and the series up to r^17.
double rough_turns(double y, double x) {
    const double ax = std::fabs(x), ay = std::fabs(y), longer = ax > ay ? ax : ay, shorter = ax > ay ? ay : ax;
    const bool is_halved = shorter > 0.41421356237309503 * longer;
    const double r = is_halved ? (shorter - longer) / (shorter + longer) : shorter / longer, r2 = r * r;
    constexpr std::array series = {1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1.0};
    double sum = 1.0 / 17;
    for (const double term : series) sum = term - r2 * sum;
    double angle = r * sum + (is_halved ? pi / 4 : 0);
    angle = ay > ax ? pi / 2 - angle : angle;
    angle = x < 0 ? pi - angle : angle;
    return (y < 0 ? -angle : angle) / (2 * pi);
}

/// The sine and cosine of an angle of 2 pi times `turns`, |turns| < 2^29, within 1e-15: the series up to r^15 and r^16
/// for |r| <= pi / 4. Enough for a direction in single precision, and less work than math::sincos.
math::SinCos rough_sincos(double turns) {
    const double quarters = 4 * turns, nearest = std::floor(quarters + 0.5), r = (pi / 2) * (quarters - nearest),
                 r2 = r * r;
    constexpr std::array sine = {
        1.0 / 6227020800, -1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6, 1.0};
    constexpr std::array cosine = {
        -1.0 / 87178291200, 1.0 / 479001600, -1.0 / 3628800, 1.0 / 40320, -1.0 / 720, 1.0 / 24, -0.5, 1.0};
    double s = -1.0 / 1307674368000, c = 1.0 / 20922789888000;
    for (const double term : sine) s = term + r2 * s;
    for (const double term : cosine) c = term + r2 * c;
    s *= r;
    const int quarter = static_cast<int>(nearest) & 3;
    const double sin = quarter & 1 ? c : s, cos = quarter & 1 ? s : c;
    return {quarter & 2 ? -sin : sin, quarter == 1 || quarter == 2 ? -cos : cos};
}

/// The entry of a guide for x in [0, 1); 0 for NaN.
std::size_t entry_of(double x, std::size_t entries) {
    return x > 0 ? std::min(static_cast<std::size_t>(x * static_cast<double>(entries)), entries - 1) : 0;
}

}  // namespace

constexpr double darkest_sky =
    1e-9;  // W/(sr m^2), of its brightest texel, as of every radiance of a file that is not 0

namespace {

/// The numbers below 0 of an image.
struct Negative {
    std::size_t count = 0, lowest = 0;  // lowest: the index of the least number
    double share = 0;                   // of the energy: their sum over that of the others, by solid angle
};

Negative negative_numbers(const RgbImage& image) {
    Negative out;
    double sum_below = 0, sum_above = 0;
    const std::size_t row_size = 3 * static_cast<std::size_t>(image.width);
    for (std::size_t row = 0; row * row_size < image.size(); ++row) {
        double row_below = 0, row_above = 0;
        for (std::size_t k = row * row_size; k < (row + 1) * row_size; ++k) {
            const float x = image[k];
            if (x > 0) row_above += static_cast<double>(x);
            if (!(x < 0)) continue;
            row_below -= static_cast<double>(x);
            if (out.count++ == 0 || x < image[out.lowest]) out.lowest = k;
        }
        const double weight = math::sin(pi * (static_cast<double>(row) + 0.5) / image.height);
        sum_below += weight * row_below;
        sum_above += weight * row_above;
    }
    out.share = sum_below > 0 ? sum_below / sum_above : 0;
    return out;
}

}  // namespace

std::size_t raise_to_zero(RgbImage& image) {
    const Negative negative = negative_numbers(image);
    if (!(negative.share <= negative_share)) return 0;
    for (std::size_t k = 0; k < image.size(); ++k)
        if (image[k] < 0) image.set_zero(k);
    return negative.count;
}

std::string why_no_sky(const RgbImage& image, double scale) {
    if (const std::string why = why_no_sky_of(image.width, image.height); !why.empty()) return why;
    const auto at_texel = [&](std::size_t k) {
        const std::size_t texel = k / 3, width = static_cast<std::size_t>(image.width);
        return fmt::format("texel ({}, {}), counted from the top-left: expected a radiance from 0 to {:g}, found {}",
            texel % width, texel / width, brightest_sky, scale * double(image[k]));
    };
    double largest = 0;
    std::optional<std::size_t> negative_index;
    for (std::size_t k = 0; k < image.size(); ++k) {
        const float x = image[k];
        const double radiance = scale * double(x);
        largest = std::max(largest, radiance);
        if (x < 0 && std::isfinite(x)) negative_index = k;
        else if (!(x >= 0 && radiance <= brightest_sky)) return at_texel(k);
    }
    if (negative_index) {
        const Negative negative = negative_numbers(image);
        return fmt::format("{}; {} {:.3g} % of the energy, more than {:g} %", at_texel(negative.lowest),
            counted(negative.count, "number[s] below 0 [is|are]"), 100 * negative.share, 100 * negative_share);
    }
    if (largest <= 0) return "every texel is 0: expected a sky with light";
    if (largest >= darkest_sky) return "";
    return fmt::format(
        "expected a texel with a radiance of at least {:g}, found {:g} at most, whose square is lost in "
        "single precision",
        darkest_sky, largest);
}

SkyTable::SkyTable(const SkyLight& light) : image_(light.image), scale_(light.scale), turns_(light.rotation / 360) {
    ensure(image_ != nullptr, "the file of a sky is read before its scene is made");
    const int high = height();
    for (int row = 0; 2 * row <= high; ++row) edge_.push_back(2 * sqr(math::sin(pi * row / (2.0 * high))));
    if (high % 2 == 0) edge_.back() = 1;
    const std::size_t columns = static_cast<std::size_t>(width());
    guides_of_row_ = std::bit_ceil(std::max<std::size_t>(1, columns / columns_a_guide));
    columns_.resize(image_->texels());
    column_guide_.resize(guides_of_row_ * static_cast<std::size_t>(high));
    std::vector<double> sums(static_cast<std::size_t>(high));  // of the luminances of a row
    parallel_for(std::size_t{0}, sums.size(), [&](std::size_t row) {
        const std::size_t first = row * columns;
        std::vector<double> up_to(columns);
        for (std::size_t k = 0; k < columns; ++k)
            up_to[k] = sums[row] += luminance(radiance(static_cast<std::uint32_t>(first + k)));
        const std::span<float> shares = std::span(columns_).subspan(first, columns);
        for (std::size_t k = 0; k < columns; ++k)
            shares[k] = sums[row] > 0 ? static_cast<float>(up_to[k] / sums[row]) : 0.0f;
        write_guides(
            std::span(column_guide_).subspan(row * guides_of_row_, guides_of_row_), shares, [](double x) { return x; });
    });
    for (int row = 0; row < high; ++row)
        rows_.push_back(total_ += sums[static_cast<std::size_t>(row)] * solid_angle(row));
    row_guide_.resize(std::bit_ceil(rows_.size()));
    edge_guide_.resize(row_guide_.size());
    write_guides(row_guide_, rows_, [&](double x) { return x * total_; });
    write_guides(edge_guide_, edge_, [](double x) { return x * x * (1 - 1e-12); });  // before any rounding
}

double SkyTable::pdf(std::uint32_t texel) const { return luminance(radiance(texel)) / total_; }

Rgb SkyTable::radiance(std::uint32_t texel) const {
    const RgbImage& image = *image_;
    const std::size_t first = 3 * std::size_t{texel};
    return {scale_ * double(image[first]), scale_ * double(image[first + 1]), scale_ * double(image[first + 2])};
}

SkyTable::RowEdges SkyTable::edges_of(int row) const {
    const int high = height(), mirrored = high - 1 - row, upper = std::min(row, mirrored);
    const double polar = edge_[static_cast<std::size_t>(upper)];
    if (row == mirrored) return {.polar = polar, .equatorial = polar, .crosses_equator = true, .is_below = false};
    return {.polar = polar,
        .equatorial = edge_[static_cast<std::size_t>(upper) + 1],
        .crosses_equator = false,
        .is_below = row > mirrored};
}

double SkyTable::solid_angle(int row) const {
    const RowEdges edges = edges_of(row);
    return 2 * pi / width() * (edges.crosses_equator ? 2 * (1 - edges.polar) : edges.equatorial - edges.polar);
}

SkyDraw SkyTable::sample(double u, double v) const {
    SkyDraw out;
    sample({&u, 1}, {&v, 1}, {&out, 1});
    return out;
}

void SkyTable::sample(std::span<const double> u, std::span<const double> v, std::span<SkyDraw> out) const {
    for (std::size_t first = 0; first < out.size(); first += draws_at_once) {
        const std::size_t count = std::min(draws_at_once, out.size() - first);
        sample_some(u.subspan(first, count), v.subspan(first, count), out.subspan(first, count));
    }
}

void SkyTable::sample_some(std::span<const double> u, std::span<const double> v, std::span<SkyDraw> out) const {
    struct Place {
        std::size_t row, column;
        double row_part, column_part;  // within the texel, 0 to 1
    };
    std::array<Place, draws_at_once> places;
    const auto fraction_of = [](double x, double low, double high) {
        const double part = high > low ? (x - low) / (high - low) : 0.5;
        return std::clamp(part, 0.0, 1.0);
    };
    const std::size_t count = out.size(), columns = static_cast<std::size_t>(width()), last_row = rows_.size() - 1;
    for (std::size_t k = 0; k < count; ++k) {
        std::size_t row = row_guide_[entry_of(u[k], row_guide_.size())];
        while (row < last_row && rows_[row] <= u[k] * total_) ++row;
        row = std::min(row, last_row);
        places[k].row = row;
        places[k].row_part = fraction_of(u[k] * total_, row > 0 ? rows_[row - 1] : 0, rows_[row]);
        __builtin_prefetch(&column_guide_[row * guides_of_row_ + entry_of(v[k], guides_of_row_)]);
    }
    for (std::size_t k = 0; k < count; ++k) {
        Place& place = places[k];
        const std::size_t guide = column_guide_[place.row * guides_of_row_ + entry_of(v[k], guides_of_row_)];
        place.column = std::min(guide, columns - 1);
        __builtin_prefetch(&columns_[place.row * columns + place.column]);
    }
    for (std::size_t k = 0; k < count; ++k) {
        Place& place = places[k];
        const float* const shares = &columns_[place.row * columns];
        std::size_t column = place.column;
        while (column + 1 < columns && double(shares[column]) <= v[k]) ++column;
        place.column = column;
        place.column_part = fraction_of(v[k], column > 0 ? double(shares[column - 1]) : 0, double(shares[column]));
        image_->prefetch(3 * (place.row * columns + column));
    }
    for (std::size_t k = 0; k < count; ++k) {
        const auto& [row, column, row_part, column_part] = places[k];
        const RowEdges edges = edges_of(static_cast<int>(row));
        double h, y;
        if (edges.crosses_equator) {
            y = (1 - edges.polar) * (1 - 2 * row_part);
            h = 1 - std::fabs(y);
        } else {
            h = edges.polar + (edges.equatorial - edges.polar) * (edges.is_below ? 1 - row_part : row_part);
            y = edges.is_below ? h - 1 : 1 - h;
        }
        const double sin_theta = std::sqrt(h * (2 - h));
        const math::SinCos phi = rough_sincos((static_cast<double>(column) + column_part) / width() - turns_);
        const auto texel = static_cast<std::uint32_t>(row * columns + column);
        out[k] = {{sin_theta * phi.sin, y, -sin_theta * phi.cos}, texel, pdf(texel)};
    }
}

std::uint32_t SkyTable::texel_at(Vec3d w) const {
    const double across2 = w.x * w.x + w.z * w.z, size = std::sqrt(across2 + w.y * w.y);
    const double h = across2 / (size * (size + std::fabs(w.y)));
    const int last = (height() - 1) / 2;  // the last row that is not below the equator
    std::size_t edge_index = edge_guide_[entry_of(std::sqrt(h), edge_guide_.size())];
    while (edge_index < edge_.size() && edge_[edge_index] <= h) ++edge_index;
    const int upper = std::min(static_cast<int>(edge_index) - 1, last);
    const int row = w.y < 0 ? height() - 1 - upper : upper;
    const auto position = [&](double turn) { return (turn - std::floor(turn)) * width(); };
    double place = position(rough_turns(w.x, -w.z) + turns_);
    // Within the error of the rough turn from the edge of a column, and for (0, 0): NaN.
    const double fraction = place - std::floor(place);
    if (!(fraction > 1e-4 && fraction < 1 - 1e-4)) place = position(math::atan2(w.x, -w.z) / (2 * pi) + turns_);
    const int column = std::min(static_cast<int>(place), width() - 1);
    return static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(width()) + static_cast<std::uint32_t>(column);
}

}  // namespace crescent
