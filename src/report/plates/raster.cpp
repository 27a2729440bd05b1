// When reducing, a pixel is shared between at most two cells across and two down by the area it has in each, row after
// row, before the tone mapper or turbo; when enlarging, a row is written once and copied.
#include "report/plates/raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "output/tone_map.h"

namespace crescent::plates {

namespace {

template <class F> View view_of(const F* f) {
    if (!f) return {};
    return {f->width, f->height, f->r.data(), f->g.data(), f->b.data(), f->y.data()};
}

std::size_t at(const View& v, int x, int y) { return std::size_t(y) * std::size_t(v.width) + std::size_t(x); }

// The output cells that an input cell [i, i+1) of `in` covers when `in` cells become `out`, and the share of each cell.
struct Share {
    int first;
    double part0, part1;  // of cells `first` and `first + 1`; when reducing, it meets no third
};
std::vector<Share> shares(int in, int out) {
    constexpr double slack = 1e-9;
    std::vector<Share> s(static_cast<std::size_t>(in));
    double scale = double(out) / in;
    for (int i = 0; i < in; ++i) {
        double from = i * scale, to = (i + 1) * scale;
        // The slack prevents a cell that ends on an edge, up to rounding, from covering the next one.
        int first = std::min(static_cast<int>(from + slack), out - 1);
        double spill = to - (first + 1);
        bool spills = spill > slack && first + 1 < out;
        s[std::size_t(i)] = {first, std::min(to, first + 1.0) - from, spills ? spill : 0.0};
    }
    return s;
}

// Computes area averages of `box`, C values per pixel, row by row from the top, so that memory grows only with the
// output.
template <int C, class Read, class Write> void reduce(const Box& box, const Fit& f, Read read, Write write) {
    using Cell = std::array<double, C>;
    std::vector<Share> sx = shares(f.in_w, f.out_w), sy = shares(f.in_h, f.out_h);
    std::vector<Cell> row(std::size_t(f.out_w) + 1), sums(std::size_t(f.out_w)), next_sums(std::size_t(f.out_w));
    auto flush = [&](int j) {
        for (int i = 0; i < f.out_w; ++i) write(i, j, sums[std::size_t(i)]);
        std::swap(sums, next_sums);
        std::fill(next_sums.begin(), next_sums.end(), Cell{});
    };
    for (int j = 0; j < f.in_h; ++j) {
        std::fill(row.begin(), row.end(), Cell{});
        for (int i = 0; i < f.in_w; ++i) {
            Cell c = read(box.x0 + i, box.y1 - j);
            const Share& s = sx[std::size_t(i)];
            Cell* to = &row[std::size_t(s.first)];
            for (int k = 0; k < C; ++k) {
                to[0][k] += s.part0 * c[k];
                if (s.part1 > 0) to[1][k] += s.part1 * c[k];
            }
        }
        const Share& s = sy[std::size_t(j)];
        for (int i = 0; i < f.out_w; ++i) {
            for (int k = 0; k < C; ++k) {
                double v = row[std::size_t(i)][k];
                sums[std::size_t(i)][k] += s.part0 * v;
                if (s.part1 > 0) next_sums[std::size_t(i)][k] += s.part1 * v;
            }
        }
        bool is_last = j + 1 == f.in_h;
        if (is_last || sy[std::size_t(j) + 1].first != s.first) flush(s.first);
    }
}

// Repeats each pixel of `box` times x times.
template <class Pixel> Block enlarge(const Box& box, const Fit& f, Pixel pixel) {
    Block out(f.out_w, f.out_h);
    for (int j = 0; j < f.in_h; ++j) {
        for (int i = 0; i < f.in_w; ++i) {
            Srgb8 c = pixel(box.x0 + i, box.y1 - j);
            for (int k = 0; k < f.times; ++k) out.set(i * f.times + k, j * f.times, c);
        }
        const std::size_t bytes = 3 * std::size_t(f.out_w);
        auto first = out.rgb.begin() + std::ptrdiff_t(bytes) * j * f.times;
        for (int k = 1; k < f.times; ++k) std::copy_n(first, bytes, first + std::ptrdiff_t(bytes) * k);
    }
    return out;
}

}  // namespace

View view(const Film* film) { return view_of(film); }
View view(const ReferenceFilm* film) { return view_of(film); }

double Fit::ratio() const { return double(out_w) / in_w; }

Fit fit(int w, int h, double slot_w, double slot_h) {
    Fit f;
    f.in_w = w;
    f.in_h = h;
    double scale = std::min(slot_w / w, slot_h / h);
    if (scale >= 1) {
        f.times = static_cast<int>(scale);
        f.out_w = w * f.times;
        f.out_h = h * f.times;
    } else {
        f.reduced = true;
        f.out_w = std::clamp(static_cast<int>(std::lround(w * scale)), 1, std::max(1, static_cast<int>(slot_w)));
        f.out_h = std::clamp(static_cast<int>(std::lround(h * scale)), 1, std::max(1, static_cast<int>(slot_h)));
    }
    return f;
}

std::string to_string(const Fit& f) {
    const double across = double(f.out_w) / f.in_w, down = double(f.out_h) / f.in_h;
    if (f.reduced && std::max(across, down) > 1.15 * std::min(across, down))
        return fmt::format("×{:.2g} across, ×{:.2g} up", across, down);
    if (f.reduced) return fmt::format("×{:.{}g}", std::max(across, down), std::max(across, down) < 0.95 ? 2 : 3);
    return f.times == 1 ? "1:1" : fmt::format("×{}", f.times);
}

Box whole(const View& v) { return {0, 0, v.width - 1, v.height - 1}; }

Box inside(const Box& box, const View& v) {
    Box b{std::max(box.x0, 0), std::max(box.y0, 0), std::min(box.x1, v.width - 1), std::min(box.y1, v.height - 1)};
    return b.x0 > b.x1 || b.y0 > b.y1 ? whole(v) : b;
}

Block photograph_block(const View& v, const Box& box, const Fit& f, double exposure) {
    auto read = [&](int x, int y) {
        std::size_t i = at(v, x, y);
        return Rgb{double(v.r[i]), double(v.g[i]), double(v.b[i])};
    };
    if (!f.reduced) return enlarge(box, f, [&](int x, int y) { return photograph(read(x, y), exposure); });
    Block out(f.out_w, f.out_h);
    reduce<3>(box, f, read, [&](int i, int j, const Rgb& c) { out.set(i, j, photograph(c, exposure)); });
    return out;
}

Block turbo_block(const Box& box, const Fit& f, const std::function<double(int, int)>& value) {
    if (!f.reduced) return enlarge(box, f, [&](int x, int y) { return turbo(value(x, y)); });
    Block out(f.out_w, f.out_h);
    using One = std::array<double, 1>;
    reduce<1>(
        box, f, [&](int x, int y) { return One{value(x, y)}; },
        [&](int i, int j, const One& c) { out.set(i, j, turbo(c[0])); });
    return out;
}

std::uint64_t not_finite(const View& v, const Box& box) {
    std::uint64_t count = 0;
    for (int y = box.y0; y <= box.y1; ++y) {
        for (int x = box.x0; x <= box.x1; ++x) {
            std::size_t i = at(v, x, y);
            count += !(std::isfinite(v.r[i]) && std::isfinite(v.g[i]) && std::isfinite(v.b[i]));
        }
    }
    return count;
}

}  // namespace crescent::plates
