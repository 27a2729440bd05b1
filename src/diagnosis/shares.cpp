// Several lobes, by what each of them draws (lobe_draws.h): p = x_1 a_1 + x_2 a_2 + ... at nine of ten directions, with
// x of lobe l one where p has it as it is drawn. What is off is the chooser's probability, a constant of one lobe, a
// number that chooses and is used again as it is. Shares have to come to what p integrates to.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "simd/scalar.h"
#include "diagnosis/diagnosis.h"
#include "stats/least_squares.h"
#include "diagnosis/lobe_draws.h"

namespace crescent::inline diagnosis {

namespace {

using Shares = std::vector<double>;  // x, by lobe
constexpr double exact_x = 2e-3, most_draws = 0.9, telling = 0.05;
constexpr std::size_t fewest_draws = 32, fewest_of_a_lobe = 8;

/// sum x a over p, less one.
double off(const Shares& x, const LobeDraws::At& at) {
    double sum = 0;
    for (std::size_t l = 0; l < x.size(); ++l) sum += x[l] * at.drawn[l];
    return sum / at.pdf - 1;
}

/// x by least squares of sum x a over p.
std::optional<Shares> shares_of(const LobeDraws& all) {
    std::vector<Shares> rows;
    for (const LobeDraws::At& at : all.at) {
        rows.push_back(at.drawn);
        for (double& v : rows.back()) v /= at.pdf;
    }
    return solved_for_one(rows, fewest_draws, 1e-4);
}

/// How far x is from one at most.
double furthest(const Shares& x) {
    double most = 0;
    for (double v : x) most = std::max(most, std::fabs(v - 1));
    return most;
}

struct Counted {
    std::size_t inside = 0, above = 0;  // directions at which sum x a is p, or more than p
    std::vector<std::size_t> of_lobe;   // inside, and a lobe has a part of p that tells
    double left = 0, all = 0;
};
Counted count(const LobeDraws& of, const Shares& x) {
    Counted out;
    out.of_lobe.resize(x.size());
    const Shares as_it_is(x.size(), 1.0);
    for (const LobeDraws::At& at : of.at) {
        const double o = off(x, at), may = std::min(exact_x, 0.1 * furthest(x)) + 2 * at.error;
        if (std::fabs(o) <= may) {
            ++out.inside;
            for (std::size_t l = 0; l < x.size(); ++l) out.of_lobe[l] += x[l] * at.drawn[l] > telling * at.pdf;
        } else if (o > 0) ++out.above;
        out.left += std::fabs(o), out.all += std::fabs(off(as_it_is, at));
    }
    return out;
}

/// What the lobes come to where each has x times what it draws, and one standard error of it.
struct Mass {
    double value = 0, error = 0;
};
Mass mass_of(const TrialContext& work, int technique, const LobeDraws& of, const Shares& x) {
    Mass out;
    const double n = static_cast<double>(work.first(technique).u.size());
    double variance = 0;
    for (std::size_t l = 0; l < x.size(); ++l) {
        const LobeDraws::Lobe& lobe = of.lobes[l];
        out.value += x[l] * lobe.share() * (1 - lobe.nothing);
        variance += sqr(x[l]) * lobe.share() * lobe.nothing * (1 - lobe.nothing) / n;
    }
    out.error = std::sqrt(variance);
    return out;
}
bool comes_to(const Mass& m, double mass) { return std::fabs(m.value / mass - 1) < 1e-3 + 5 * m.error / mass; }

/// "0.2, 0.5 and 0.3".
std::string listed(const std::vector<double>& v) {
    std::string out;
    for (std::size_t k = 0; k < v.size(); ++k)
        out += (k == 0 ? "" : k + 1 < v.size() ? ", " : " and ") + fmt::format("{:.4g}", v[k]);
    return out;
}

Diagnosis told_of(const LobeDraws& of, const Shares& x, double explained) {
    std::vector<double> drawn, claimed;
    std::size_t is_off = 0, last = 0;
    for (std::size_t l = 0; l < x.size(); ++l) {
        drawn.push_back(of.lobes[l].share());
        claimed.push_back(x[l] * of.lobes[l].share());
        if (std::fabs(x[l] - 1) > exact_x) ++is_off, last = l;
    }
    if (is_off != 1)
        return {"the chooser's probability", 1, explained,
            fmt::format("the lobes that u{} chooses, in order, are drawn with {}, and pdf(w) has them with {}",
                of.chooser + 1, listed(drawn), listed(claimed)),
            {}};
    return {"a constant in one lobe", 1 / x[last], explained,
        fmt::format("of what u{} chooses, the lobe from {:.4g} to {:.4g} is drawn {:.5g} times as often as pdf(w) has "
                    "it, and the rest as often: its probability, or a constant of its own, is off",
            of.chooser + 1, of.lobes[last].from, of.lobes[last].to, 1 / x[last]),
        {}};
}

/// What the lobes are drawn with is not what p has; all of them together come to what p integrates to.
std::optional<Diagnosis> other_shares(const TrialContext& work, int technique, const LobeDraws& of) {
    const std::optional<Shares> x = shares_of(of);
    if (!x || furthest(*x) < 2 * exact_x) return {};
    const auto [least, most] = std::minmax_element(x->begin(), x->end());
    if (!(*least > -exact_x) || *most - *least < 2 * exact_x) return {};  // a constant is found elsewhere
    const Counted c = count(of, *x);
    if (static_cast<double>(c.inside) < most_draws * static_cast<double>(of.at.size()) || !(c.left < 0.1 * c.all))
        return {};
    for (std::size_t n : c.of_lobe)
        if (n < fewest_of_a_lobe) return {};
    if (!comes_to(mass_of(work, technique, of, *x), work.density(technique).mass.value)) return {};
    return told_of(of, *x, 1 - c.left / c.all);
}

/// A number that chose a lobe, from a to b, goes into the lobe as it is: there the lobe draws 1 / (b - a) times as much
/// as p has of it, and nothing elsewhere. Where the other lobes reach as they ought to, p is (b - a) times what it
/// draws and what they draw; elsewhere p is more.
std::optional<Diagnosis> used_again(const TrialContext& work, int technique, const LobeDraws& of) {
    const Density& d = work.density(technique);
    const std::size_t n = of.lobes.size();
    if (of.chooser > 1 || n > 4) return {};
    std::optional<Shares> best;
    Counted most;
    for (unsigned which = 1; which < (1u << n); ++which) {
        Shares x(n, 1.0);
        for (std::size_t l = 0; l < n; ++l)
            if (which >> l & 1) x[l] = of.lobes[l].share();
        if (comes_to(mass_of(work, technique, of, x), d.mass.value)) continue;
        const Counted c = count(of, x);
        bool every = 20 * c.above < of.at.size() && 4 * c.inside > of.at.size();
        for (std::size_t l = 0; l < n; ++l) every = every && (x[l] == 1 || c.of_lobe[l] >= fewest_of_a_lobe);
        if (every && (!best || c.inside > most.inside)) best = x, most = c;
    }
    if (!best) return {};
    std::vector<std::string> which;
    for (std::size_t l = 0; l < n; ++l)
        if ((*best)[l] != 1) which.push_back(fmt::format("from {:.4g} to {:.4g}", of.lobes[l].from, of.lobes[l].to));
    return Diagnosis{"the number that chooses, used again without stretching", 1,
        static_cast<double>(most.inside) / static_cast<double>(of.at.size()),
        fmt::format("u{} chooses a lobe and is used again within it as it is, in place of the part of its interval "
                    "that it has gone ({})",
            of.chooser + 1, fmt::join(which, "; ")),
        {}};
}

}  // namespace

std::optional<Diagnosis> diagnose_shares(const TrialContext& work, int technique, const LobeDraws& of) {
    if (std::optional<Diagnosis> found = other_shares(work, technique, of)) return found;
    return used_again(work, technique, of);
}

}  // namespace crescent::inline diagnosis
