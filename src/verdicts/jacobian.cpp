// |Jacobian| x p without knowing the warp: central differences of sample(wo, u). Where a warp is one to one, p |J| = 1;
// where several u reach one direction p is the sum of 1/|J| over them, so p |J| >= 1 everywhere. p |J| < 1 is a wrong
// density in any case, whatever the sampler. Seams and kinks of a warp (a tabulated density has one at every cell) are
// told from smooth ground by comparing step sizes, and by one-sided differences: beside a kink the side away from it is
// clean.
#include <algorithm>
#include <array>
#include <cmath>

#include "simd/math.h"
#include "verdicts/ordered.h"

namespace crescent::inline verdicts {

namespace {

constexpr double step = 0x1p-8;
constexpr double tiny_step = 0x1p-19;
constexpr std::ptrdiff_t most_suspects = 60;  // that are asked about again
constexpr int stencil = 11;                   // centre, +-h, +-h/2 along each side, and a tiny move along each

/// The other numbers are held: what chooses among lobes stays with its choice.
std::array<Numbers, stencil> stencil_at(const Numbers& centre, double h = step) {
    const double k = h / 2;
    constexpr Vec2d none{0, 0};
    const Vec2d moves[stencil] = {
        none, {h, 0}, {-h, 0}, {0, h}, {0, -h}, {k, 0}, {-k, 0}, {0, k}, {0, -k}, {tiny_step, 0}, {0, tiny_step}};
    std::array<Numbers, stencil> out;
    for (std::size_t i = 0; i < stencil; ++i) {
        out[i] = centre;
        out[i].x += moves[i].x, out[i].y += moves[i].y;
    }
    return out;
}

struct Derivative {
    double j = 0;      // |d w / d u1 x d w / d u2|
    double error = 0;  // relative
    bool usable = false;
    double along[2] = {};  // |d w / d u|
};

double area(Vec3d a, Vec3d b) { return length(cross(a, b)); }

Derivative derivative(std::span<const Draw> w, double direction_resolution) {
    Derivative out;
    for (const Draw& d : w)
        if (!(d.pdf > 0)) return out;
    const Vec3d c = w[0].wi;
    const auto central = [&](int plus, int minus, double h) { return (w[plus].wi - w[minus].wi) * (0.5 / h); };
    const double h = step, k = step / 2;
    const Vec3d x1 = central(1, 2, h), y1 = central(3, 4, h), x2 = central(5, 6, k), y2 = central(7, 8, k);
    const double j1 = area(x1, y1), j2 = area(x2, y2);
    if (!(j2 > 0)) return out;
    out.j = (4 * j2 - j1) / 3;  // Richardson
    const double lx = length(x2), ly = length(y2);
    const double noise = direction_resolution * (1 / lx + 1 / ly) * (lx * ly / j2) / k;
    const auto sided = [&](int px, int py, double s) {
        return area((w[px].wi - c) * (1 / s), (w[py].wi - c) * (1 / s));
    };
    const double wide = std::fabs(sided(1, 3, h) - sided(2, 4, h)), narrow = std::fabs(sided(5, 7, k) - sided(6, 8, k));
    out.error = std::fabs(j2 - j1) / j2 / 3 + noise;
    out.usable =
        out.error < 0.05 && narrow < 0.7 * wide + 4 * noise * j2 + 1e-3 * j2;  // a kink does not halve with the step
    out.along[0] = lx;
    out.along[1] = ly;
    return out;
}

/// The largest |J| of the four quadrants about u, by one-sided differences of second order, and its relative noise.
struct Quadrants {
    double largest = 0, noise = 1;
};

Quadrants quadrants(std::span<const Draw> w, double direction_resolution, double h) {
    Quadrants out;
    for (const Draw& d : w)
        if (!(d.pdf > 0)) return out;
    const Vec3d c = w[0].wi;
    const auto sided = [&](int whole, int half) { return ((w[half].wi - c) * 4.0 - (w[whole].wi - c)) * (1 / h); };
    for (const Vec3d& x : {sided(1, 5), sided(2, 6)})
        for (const Vec3d& y : {sided(3, 7), sided(4, 8)}) {
            const double j = area(x, y);
            if (j <= out.largest) continue;
            out.largest = j;
            out.noise = 8 * direction_resolution / h * (1 / length(x) + 1 / length(y)) * (length(x) * length(y) / j);
        }
    return out;
}

/// p |J| that three of four points do not exceed, of those at which it is known to 3e-4; 1 where these are too few.
double third_quartile(std::vector<double> pj) {
    if (pj.size() < 100) return 1;
    const auto at = pj.begin() + static_cast<std::ptrdiff_t>(3 * pj.size() / 4);
    std::nth_element(pj.begin(), at, pj.end());
    return *at;
}

constexpr std::array look_steps = {0x1p-7, 0x1p-8, 0x1p-10, 0x1p-12, 0x1p-14, 0x1p-16, 0x1p-18};

struct Suspect {
    Numbers u;
    double p, p_j;  // over the share of the choosing number
    double share = 1, allowed = 0;
    bool stands = true;
    double resolution = 0;                         // rounding of the warp there
    std::array<double, look_steps.size()> here{};  // p |J| by each step, and its noise
    std::array<double, look_steps.size()> noise{};

    double lacking() const { return 1 - p_j; }
    bool nearly(double a, double b) const { return std::fabs(a - b) < 0.1 * lacking(); }
    /// The finest steps say the same and less than one, whatever the rounding is thought to be: a warp in doubles.
    bool settles_below() const {
        const std::size_t last = here.size() - 1;
        return nearly(here[last], here[last - 1]) && nearly(here[last - 1], here[last - 2]) && here[last] > 0.1 &&
            here[last] < 1 - 0.3 * lacking();  // on a stair nothing moves
    }
    bool settles_at_one() const {
        for (std::size_t k = 2; k < here.size(); ++k)
            if (nearly(here[k], 1) && nearly(here[k - 1], 1)) return true;
        return false;
    }
    /// One that reaches 1 in any quadrant is let go, and so is one of which no two steps in turn say the same: there
    /// the difference is the step's, not the density's.
    bool stands_against_rounding() const {
        double before = 0;
        bool settled = false;
        for (std::size_t k = 0; k < here.size(); ++k) {
            const double h = look_steps[k];
            if (h < step && 2 * noise[k] > 0.25 * lacking()) continue;  // lost in rounding: the wider steps decide
            if (h <= step && (here[k] > 1 - 0.3 * lacking() || noise[k] > lacking())) return false;
            settled = settled || (before > 0 && std::fabs(here[k] - before) < 0.5 * lacking());
            before = here[k];
        }
        return settled;
    }
};

/// How finely the warp is computed at each suspect. A difference of two nearly equal numbers within the sampler may
/// cost most of its digits, of which the direction's own resolution knows nothing. By third differences over moves of
/// u, which leave rounding alone where the warp is smooth, however curved; by their median, since a seam that the moves
/// cross spoils three of nine. Small moves stay within the cell of a table; where floats make stairs of a warp only
/// wide ones leave a stair, of several lengths, since stairs as long as the move look smooth. Where most moves stay on
/// their stair, its height is what the warp is known to.
void find_grains(const TrialContext& work, int technique, std::vector<Suspect>& suspects) {
    constexpr std::size_t moves = 12;
    for (const double by : {tiny_step, 1267 * 0x1p-24, 2048 * 0x1p-24, 3001 * 0x1p-24}) {
        std::vector<Numbers> u;
        for (const Suspect& s : suspects)
            for (int axis = 0; axis < 2; ++axis)
                for (std::size_t k = 0; k < moves; ++k) u.push_back(s.u), u.back()[axis] += static_cast<double>(k) * by;
        std::vector<Draw> w(u.size());
        work.subject.sample(technique, work.trial.wo, u, w);
        for (std::size_t line = 0; line < 2 * suspects.size(); ++line) {
            Suspect& s = suspects[line / 2];
            std::array<double, moves - 3> rough{}, moved{};
            for (std::size_t k = 0; k < rough.size(); ++k) {
                const Draw* at = &w[line * moves + k];
                if (at[0].pdf > 0 && at[1].pdf > 0) moved[k] = length(at[1].wi - at[0].wi);
                if (at[0].pdf > 0 && at[1].pdf > 0 && at[2].pdf > 0 && at[3].pdf > 0)
                    rough[k] = length(at[3].wi - at[0].wi + (at[1].wi - at[2].wi) * 3.0);
            }
            std::ranges::nth_element(rough, rough.begin() + rough.size() / 2);
            std::ranges::sort(moved);
            const double stair = moved[moved.size() / 2] > 0 ? 0 : moved.back();
            s.resolution = std::max({s.resolution, work.direction_resolution(), 0.5 * rough[rough.size() / 2], stair});
        }
    }
}

/// Looks at every suspect again with steps down to 2^-18.
void look_closer(const TrialContext& work, int technique, std::vector<Suspect>& suspects) {
    find_grains(work, technique, suspects);
    for (std::size_t k = 0; k < look_steps.size(); ++k) {
        std::vector<Numbers> u;
        for (const Suspect& s : suspects)
            for (const Numbers& v : stencil_at(s.u, look_steps[k])) u.push_back(v);
        std::vector<Draw> w(u.size());
        work.subject.sample(technique, work.trial.wo, u, w);
        for (std::size_t i = 0; i < suspects.size(); ++i) {
            Suspect& s = suspects[i];
            const Quadrants q = quadrants(std::span(w).subspan(i * stencil, stencil), s.resolution, look_steps[k]);
            s.here[k] = s.p * q.largest, s.noise[k] = q.noise;
        }
    }
    for (Suspect& s : suspects)
        s.stands = s.stands && !s.settles_at_one() && (s.settles_below() || s.stands_against_rounding());
}

/// A number may choose at a few points alone: seen from the denser side glass lets little through. Every suspect is
/// asked for its own share; one whose share is not known is let go.
void recall_choosers(const TrialContext& work, int technique, std::vector<Suspect>& suspects) {
    std::vector<Numbers> at;
    for (const Suspect& s : suspects) at.push_back(s.u);
    const Branches branches = follow_branches(work, technique, at);
    for (std::size_t i = 0; i < suspects.size(); ++i) {
        Suspect& s = suspects[i];
        const double share = branches.share[i];
        s.stands = share > 0 && s.p_j / share * s.share < 1 - s.allowed - branches.known_to / std::max(share, 1e-9);
        s.p *= s.share / std::max(share, 1e-9);
        s.p_j *= s.share / std::max(share, 1e-9);
        s.share = share;
    }
    std::erase_if(suspects, [](const Suspect& s) { return !s.stands; });
}

/// u well inside the square, with their stencils.
std::vector<Numbers> stencils_of(const TrialContext& work, const SampleBatch& b, std::size_t wanted) {
    std::vector<Numbers> u;
    for (std::size_t i = 0; i < b.u.size() && u.size() < wanted * stencil; ++i) {
        const Numbers& c = b.u[i];
        if (std::min({c.x, c.y, 1 - c.x, 1 - c.y}) <= 2 * step) continue;
        if (work.traits.numbers > 2 && !(b.draws[i].pdf > 0)) continue;
        for (const Numbers& v : stencil_at(c)) u.push_back(v);
    }
    return u;
}

void count_steps(const TrialContext& work, const Derivative& d, std::span<const Draw> w, WarpFinding& out) {
    for (int axis = 0; axis < 2; ++axis) {
        const double due = d.along[axis] * tiny_step;
        if (due < 24 * work.direction_resolution()) continue;
        ++out.steps_tried;
        if (length(w[9 + static_cast<std::size_t>(axis)].wi - w[0].wi) < 0.2 * due) ++out.stuck;
    }
}

WarpFinding studied(const TrialContext& work, int technique) {
    WarpFinding out;
    if (!work.subject.draws_at_will() || work.traits.own_random || work.scatter().any()) return out;
    const bool several = work.traits.numbers > 2;
    const std::vector<Numbers> u = stencils_of(work, work.first(technique), work.settings.full ? 8192 : 1024);
    std::vector<Draw> w(u.size());
    work.subject.sample(technique, work.trial.wo, u, w);
    std::vector<Derivative> derivatives;
    std::vector<Numbers> centres;
    for (std::size_t i = 0; i + stencil <= w.size(); i += stencil) {
        derivatives.push_back(derivative(std::span(w).subspan(i, stencil), work.direction_resolution()));
        if (derivatives.back().usable) centres.push_back(u[i]);
    }
    const Branches branches = several ? follow_branches(work, technique, centres) : Branches{};
    out.choosers = branches.choosers;
    std::size_t one = 0, next = 0;
    std::vector<Suspect> suspects;
    std::vector<double> known;
    for (std::size_t i = 0; i + stencil <= w.size(); i += stencil) {
        const Derivative& d = derivatives[i / stencil];
        if (!d.usable) continue;
        const double share = several ? branches.share[next++] : 1;
        count_steps(work, d, std::span(w).subspan(i, stencil), out);
        if (!(share > 0)) continue;
        ++out.usable;
        const double pj = w[i].pdf * d.j / share, allowed = 5e-4 + 2 * d.error + branches.known_to / share;
        out.points.push_back({w[i].wi, d.j / share, d.error, u[i], pj});
        if (pj < 1 - allowed) suspects.push_back({u[i], w[i].pdf / share, pj, share, allowed});
        if (std::fabs(pj - 1) <= allowed) ++one;
        if (allowed < 8e-4) known.push_back(pj);
    }
    if (!work.traits.has_pdf) return out;
    out.nowhere_above = third_quartile(std::move(known));
    if (work.thrifty() && std::ssize(suspects) > most_suspects)
        suspects.erase(suspects.begin() + most_suspects, suspects.end());
    if (several) recall_choosers(work, technique, suspects);
    look_closer(work, technique, suspects);
    for (const Suspect& s : suspects) {
        if (!s.stands) continue;
        ++out.below;
        if (s.p_j >= out.smallest) continue;
        out.smallest = s.p_j;
        out.at = s.u;
    }
    out.one_to_one = out.usable ? static_cast<double>(one) / static_cast<double>(out.usable) : 0;
    return out;
}

}  // namespace

std::vector<std::optional<WarpPoint>> jacobians_at(
    const TrialContext& work, int technique, std::span<const Numbers> at) {
    std::vector<Numbers> u;
    for (const Numbers& c : at)
        for (const Numbers& v : stencil_at(c)) u.push_back(v);
    std::vector<Draw> w(u.size());
    work.subject.sample(technique, work.trial.wo, u, w);
    std::vector<std::optional<WarpPoint>> out(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Derivative d = derivative(std::span(w).subspan(i * stencil, stencil), work.direction_resolution());
        const Draw& there = w[i * stencil];
        if (d.usable) out[i] = WarpPoint{there.wi, d.j, d.error, at[i], there.pdf * d.j};
    }
    return out;
}

const WarpFinding& study_warp(const TrialContext& work, int technique) {
    auto& kept = work.warps[static_cast<std::size_t>(technique)];
    if (!kept) kept = std::make_shared<const WarpFinding>(studied(work, technique));
    return *kept;
}

}  // namespace crescent::inline verdicts
