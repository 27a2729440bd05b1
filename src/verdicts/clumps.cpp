// Clumps: draws that crowd where p says that next to none are due, in less room than a bin has. Statistically
// equivalent blocks (Tukey 1947, "Non-parametric estimation II"): n draws that are cut at one of them after the other,
// by any rule that looks at no draw inside, leave blocks of which each holds Beta(m, n + 1 - m) of what is drawn,
// whatever the density is, m - 1 being the draws inside. The last cut of a block is at its highest p: what is left of
// it holds at most its solid angle times that p, which is known with the draws already.
#include "verdicts/clumps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <numeric>
#include <tuple>

#include "math/functions.h"
#include "simd/scalar.h"
#include "stats/distributions.h"
#include "stats/quantiles.h"
#include "trials/trial_context.h"

namespace crescent::inline verdicts {

namespace {

constexpr std::size_t fewest_in_a_block = 5;  // draws of a block

/// Coordinates and p in single precision. That moves a draw by less than the rounding that is granted to every block,
/// but for a beside 2, where a float is known to 2^-23 of itself: 5e-4 rad about the far pole (solid_angle adds it).
struct PlacedDraw {
    float a, b, p;
    std::uint32_t draw;
};

double theta_of(double a) { return 2 * math::asin(std::sqrt(std::clamp(a / 2, 0.0, 1.0))); }

/// In sr, with what the rounding of directions may add on every side.
double solid_angle(const Rect& r, double rounding) {
    const double from = std::max(theta_of(r.a0) - rounding, 0.0), to = std::min(theta_of(r.a1) + rounding, pi);
    const double height = 2 * (sqr(math::sin(to / 2)) - sqr(math::sin(from / 2)));
    const double of_floats = 0x1p-23 * (r.a0 + r.a1);
    return 2 * pi * (r.b1 - r.b0) * (height + of_floats) + 2 * rounding * (to - from);
}

/// The least likely of the blocks that it is shown.
class Search {
public:
    Search(const TrialContext& work, double draws, double mass, double rounding)
        : work_(work), per_sr_(draws / mass), rounding_(rounding) {}
    /// Before as much as it takes to sort so many draws, or to look at them.
    void make_way(std::size_t draws) const { work_.subject.make_way(draws); }
    void look(const Rect& r, std::span<const PlacedDraw> inside) {
        if (inside.size() < fewest_in_a_block) return;
        make_way(inside.size());
        ++tried_;
        float highest = 0;
        for (const PlacedDraw& s : inside) highest = std::max(highest, s.p);
        const double m = static_cast<double>(inside.size()), worth = per_sr_ * static_cast<double>(highest);
        if (!(worth * 2 * pi * (r.a1 - r.a0) * (r.b1 - r.b0) < 0.5 * m)) return;
        const double room = solid_angle(r, rounding_), due = worth * room;
        const double p = due < 0.5 * m ? poisson_tail(due, m) : 1;  // P(Beta(m, n + 1 - m) <= due / n), or more
        if (p >= least_) return;
        least_ = p;
        found_ = {1, m, due, room, {}};
        const PlacedDraw& middle = inside[inside.size() / 2];
        at_ = {static_cast<double>(middle.a), static_cast<double>(middle.b)};
        crowd_.clear();
        for (std::size_t i = 0; i < inside.size() && crowd_.size() < 32; ++i) crowd_.push_back(inside[i].draw);
    }
    /// Some of the draws in it.
    std::span<const std::size_t> crowd() const { return crowd_; }
    Clump found(const SphereMap& map) const {
        Clump out = found_;
        out.p = tried_ > 0 ? std::min(least_ * tried_, 1.0) : 1;  // too few draws for a block
        out.at = map.direction(at_);
        return out;
    }

private:
    const TrialContext& work_;
    double per_sr_, rounding_, least_ = 1, tried_ = 0;
    Clump found_;
    Vec2d at_{};
    std::vector<std::size_t> crowd_;
};

constexpr auto lower = [](const PlacedDraw& x, const PlacedDraw& y) { return x.a < y.a; };
constexpr auto before = [](const PlacedDraw& x, const PlacedDraw& y) { return x.b < y.b; };

/// Halves the block at its middle draw, across its longer side, down to a few draws.
void look_at_blocks(const Rect& r, std::span<PlacedDraw> inside, Search& search) {
    constexpr std::size_t most = 1024;  // in larger ones p varies too much
    if (inside.size() <= most) search.look(r, inside);
    if (inside.size() <= 2 * fewest_in_a_block) return;
    const double middle = 0.5 * (r.a0 + r.a1), sin = std::sqrt(std::max(middle * (2 - middle), 1e-12));
    const bool along_a = (r.a1 - r.a0) / sin > 2 * pi * (r.b1 - r.b0) * sin;
    const std::size_t half = inside.size() / 2;
    const auto mid = inside.begin() + static_cast<std::ptrdiff_t>(half);
    search.make_way(half / 8);
    Rect low = r, high = r;
    if (along_a) {
        std::nth_element(inside.begin(), mid, inside.end(), lower);
        low.a1 = high.a0 = static_cast<double>(mid->a);
    } else {
        std::nth_element(inside.begin(), mid, inside.end(), before);
        low.b1 = high.b0 = static_cast<double>(mid->b);
    }
    look_at_blocks(low, inside.first(half), search);
    look_at_blocks(high, inside.subspan(half + 1), search);
}

/// Sorts by a coordinate: those of floats that are not negative are in the order of their bits, 11 of them at a time.
void sort(std::vector<PlacedDraw>& placed, float PlacedDraw::* coordinate, const Search& search) {
    constexpr std::uint32_t digits = 1 << 11;
    std::vector<PlacedDraw> sorted(placed.size());
    for (int shift = 0; shift < 32; shift += 11) {
        const auto digit = [&](const PlacedDraw& s) {
            return std::bit_cast<std::uint32_t>(s.*coordinate) >> shift & (digits - 1);
        };
        std::array<std::uint32_t, digits> next{};
        for (const PlacedDraw& s : placed) ++next[digit(s)];
        std::exclusive_scan(next.begin(), next.end(), next.begin(), 0u);
        for (const PlacedDraw& s : placed) {
            search.make_way(1);
            sorted[next[digit(s)]++] = s;
        }
        placed.swap(sorted);
    }
}

/// Rings, or sectors, of so many draws each between those they are cut at.
void look_at_slices(std::vector<PlacedDraw>& placed, bool rings, Search& search) {
    float PlacedDraw::* const coordinate = rings ? &PlacedDraw::a : &PlacedDraw::b;
    sort(placed, coordinate, search);
    for (std::size_t draws : {2 * fewest_in_a_block, 16 * fewest_in_a_block}) {
        double from = 0;
        for (std::size_t i = 0; i + draws < placed.size(); i += draws + 1) {
            const double to = static_cast<double>(placed[i + draws].*coordinate);
            search.look(rings ? Rect{from, to, 0, 1, 0} : Rect{0, 2, from, to, 0}, std::span(placed).subspan(i, draws));
            from = to;
        }
    }
}

/// How far apart directions lie that come again and again, as those of a warp do that rounds: median over `draws` of
/// the way to the nearest other one that came twice. 0 where there is none such.
double resolution_of(const SampleBatch& b, std::span<const std::size_t> draws) {
    std::vector<Vec3d> all, again;
    for (const Draw& d : b.draws)
        if (d.pdf > 0 && is_finite(d.wi)) all.push_back(d.wi);
    const auto key = [](Vec3d w) { return std::tuple(w.x, w.y, w.z); };
    std::sort(all.begin(), all.end(), [&](Vec3d x, Vec3d y) { return key(x) < key(y); });
    for (std::size_t i = 1; i < all.size(); ++i)
        if (key(all[i]) == key(all[i - 1]) && (again.empty() || key(again.back()) != key(all[i])))
            again.push_back(all[i]);
    std::vector<double> apart;
    for (std::size_t i : draws) {
        double least = 2;
        for (Vec3d w : again)
            if (const double far = length(w - b.draws[i].wi); far > 0) least = std::min(least, far);
        apart.push_back(least < 2 ? least : 0);
    }
    return median_of(std::move(apart));
}

}  // namespace

double least_step(const TrialContext& work, int technique, const SampleBatch& b, std::span<const std::size_t> draws) {
    const int numbers = work.traits.numbers;
    if (draws.empty() || b.u.size() != b.draws.size() || !work.subject.draws_at_will()) return 0;
    if (work.traits.own_random) return resolution_of(b, draws);  // no step of u moves it
    struct Move {
        std::size_t draw;
        int axis;
        double stays = 0, goes = 0x1p-24, step = 0;  // moves of u
        double next() const { return step > 0 ? 0.5 * (stays + goes) : goes; }
    };
    constexpr double longest = 0x1p-5;  // stairs of u that are longer are told as u with too few bits
    std::vector<Move> all;
    for (std::size_t i : draws)
        for (int k = 0; k < numbers; ++k) all.push_back({i, k});
    for (int round = 0; round < 40; ++round) {
        std::vector<Move*> open;
        std::vector<Numbers> u;
        for (Move& m : all) {
            const bool narrow = m.step > 0 && m.goes - m.stays <= 0x1p-24;
            if (narrow || m.goes > longest) continue;
            open.push_back(&m);
            const double by = m.next();
            u.push_back(b.u[m.draw]);
            u.back()[m.axis] += u.back()[m.axis] < 0.5 ? by : -by;
        }
        if (open.empty()) break;
        std::vector<Draw> moved(u.size());
        work.subject.sample(technique, work.trial.wo, u, moved);
        for (std::size_t i = 0; i < open.size(); ++i) {
            Move& m = *open[i];
            const double far =
                moved[i].pdf > 0 && is_finite(moved[i].wi) ? length(moved[i].wi - b.draws[m.draw].wi) : 0;
            const double by = m.next();
            if (far > 0) m.goes = by, m.step = far;
            else m.stays = by, m.goes = m.step > 0 ? m.goes : 4 * by;
        }
    }
    std::vector<double> steps(draws.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        double& most = steps[i / static_cast<std::size_t>(numbers)];
        most = std::max(most, all[i].step);
    }
    return median_of(std::move(steps));
}

Clump densest_clump(const TrialContext& work, int technique, const Density& d, const SampleBatch& b) {
    if (d.mass.error > 0.5 * d.mass.value) return {};  // what p lets be due is not known, as beside a pole
    std::vector<PlacedDraw> placed;
    placed.reserve(b.draws.size());
    const std::vector<Vec2d>& at = work.coordinates_of(b, d.map);
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        work.subject.make_way(1);
        if (is_null_sample(b.draws[i], b.pdf[i])) continue;
        const double p = b.pdf[i] + work.subject.tabulation_error(b.draws[i].wi);
        placed.push_back({static_cast<float>(std::fabs(at[i].x)), static_cast<float>(std::fabs(at[i].y)),
            static_cast<float>(p), static_cast<std::uint32_t>(i)});
    }
    double rounding = 4 * std::max(work.direction_resolution(), 0x1p-24);  // u itself is a multiple of 2^-24
    for (int turn = 0;; ++turn) {
        Search search(work, static_cast<double>(placed.size()), d.mass.value, rounding);
        look_at_blocks({0, 2, 0, 1, 0}, placed, search);
        for (bool rings : {true, false}) look_at_slices(placed, rings, search);
        const Clump found = search.found(d.map);
        if (turn == 2 || !(found.p < work.settings.screen)) return found;
        const double step = 4 * least_step(work, technique, b, search.crowd());
        if (step <= rounding) return found;
        rounding = step;
    }
}

void tell_clump(Verdict& v, const Clump& c) {
    v.state = State::wrong;
    v.evidence["clump"] = {{"w", {c.at.x, c.at.y, c.at.z}}, {"sr", c.room}, {"draws", c.draws}, {"due_at_most", c.due}};
    v.say = fmt::format(
        "{:.0f} draws crowd within {:.2g} sr about w = ({:.4g}, {:.4g}, {:.4g}), where p lets {:.2g} be due at most, "
        "and draws crowd again on a fresh seed: something is drawn that p leaves out.",
        c.draws, c.room, c.at.x, c.at.y, c.at.z, c.due);
}

}  // namespace crescent::inline verdicts
