// A jump that leaves a cell goes on in the cell beside it. Where that one is large and none of its points met the jump,
// the corners of the small cells along it did.
#include <algorithm>
#include <array>
#include <cmath>

#include "cubature/cell.h"

namespace crescent::inline cubature {

namespace {

/// Which cell holds a point: strips of b, in each the cells by ascending a0.
class Places {
public:
    explicit Places(const std::vector<Cell>& cells) : cells_(cells) {
        for (std::size_t i = 0; i < cells.size(); ++i)
            for (std::size_t s = strip(cells[i].rect.b0), end = strip(cells[i].rect.b1); s <= end; ++s)
                strips_[s].push_back(i);
        for (auto& s : strips_)
            std::sort(
                s.begin(), s.end(), [&](std::size_t x, std::size_t y) { return cells[x].rect.a0 < cells[y].rect.a0; });
    }
    /// cells.size() where none does.
    std::size_t at(Vec2d p) const {
        const std::vector<std::size_t>& s = strips_[strip(p.y)];
        auto i = std::upper_bound(
            s.begin(), s.end(), p.x, [&](double a, std::size_t cell) { return a < cells_[cell].rect.a0; });
        while (i != s.begin()) {
            const Rect& r = cells_[*--i].rect;
            if (p.x < r.a1 && p.y >= r.b0 && p.y < r.b1) return *i;
        }
        return cells_.size();
    }

private:
    static constexpr std::size_t count = 256;
    static std::size_t strip(double b) {
        return static_cast<std::size_t>(
            std::clamp(b * static_cast<double>(count), 0.0, static_cast<double>(count - 1)));
    }
    const std::vector<Cell>& cells_;
    std::array<std::vector<std::size_t>, count> strips_;
};

/// A point just inside of a cell that has not seen its like.
struct Suspicion {
    std::size_t cell, by;
    Vec2d at;
};

bool unlike(const Cell& c, double value) {
    return std::max(value - c.high, c.low - value) > 0.2 * std::max(c.high, value);
}

/// Beyond each corner of the cells cut last, along either side.
std::vector<Suspicion> suspicions(std::vector<Cell>& cells) {
    const Places places(cells);
    std::vector<Suspicion> out;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        Cell& c = cells[n];
        if (!c.cut || !c.rim_tried || c.looked_around) continue;
        c.looked_around = true;
        const Rect& r = c.rect;
        const double da = inset * (r.a1 - r.a0), db = inset * (r.b1 - r.b0);
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec2d corner = corners(r)[k];
            const double a = k >= 2 ? r.a1 + da : r.a0 - da, b = k % 2 == 1 ? r.b1 + db : r.b0 - db;
            for (Vec2d p : {Vec2d{a, corner.y}, Vec2d{corner.x, b}}) {
                p.y -= std::floor(p.y);
                const std::size_t i = places.at(p);
                if (i < cells.size() && !cells[i].jumpy() && unlike(cells[i], c.outer[4 + k])) out.push_back({i, n, p});
            }
        }
    }
    return out;
}

}  // namespace

std::size_t look_around(std::vector<Cell>& cells, const Batch& g, double edge_mass, bool& found) {
    if (std::none_of(cells.begin(), cells.end(), [](const Cell& c) { return c.cut && !c.looked_around; })) return 0;
    const std::vector<Suspicion> all = suspicions(cells);
    std::vector<Vec2d> where;
    for (const Suspicion& s : all) where.push_back(s.at);
    const std::vector<double> v = values_at(g, where);
    for (std::size_t i = 0; i < all.size(); ++i) {
        Cell& c = cells[all[i].cell];
        if (!unlike(c, v[i])) continue;  // the jump runs along the side
        c.rim_jumps = found = true;
        cells[all[i].by].looked_around = false;  // it asks the halves again
        c.low = std::min(c.low, v[i]);
        c.high = std::max(c.high, v[i]);
        c.inside.push_back({all[i].at, v[i]});  // its halves are told too
        if (c.step() >= edge_mass) c.error = std::max(c.error, 0.05 * c.area() * c.high);
    }
    return where.size();
}

}  // namespace crescent::inline cubature
