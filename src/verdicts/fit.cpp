// Counts by bin, ring and sector beside what p has due there.
#include "verdicts/fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/functions.h"
#include "stats/distributions.h"
#include "stats/p_values.h"
#include "verdicts/clumps.h"

namespace crescent::inline verdicts {

namespace {

/// Draws by bin. slack: what `due` is known to, by cubature and where p was tabulated.
struct Counts {
    std::vector<double> seen, due, slack;
    explicit Counts(std::size_t bins) : seen(bins), due(bins), slack(bins) {}
};

struct Binned {
    Counts bins, rings, sectors;
};

/// Pools neighbours until 5 are expected. What cannot reach 5 in the end joins the last pool. The slack is taken off
/// the difference.
Pearson pearson(const Counts& counts) {
    struct Pool {
        double seen = 0, due = 0, slack = 0;
        void add(const Pool& other) { seen += other.seen, due += other.due, slack += other.slack; }
    };
    std::vector<Pool> pools;
    Pool last;
    Pearson out;
    for (std::size_t i = 0; i < counts.due.size(); ++i) {
        const Pool bin{counts.seen[i], std::max(counts.due[i], 0.0), counts.slack[i]};
        if (counts.due[i] < 1e-6) {
            ++out.empty;
            out.empty_observed += bin.seen;
            out.empty_expected += bin.due;
        }
        last.add(bin);
        if (last.due >= 5) pools.push_back(std::exchange(last, {}));
    }
    if (pools.empty()) return out;
    pools.back().add(last);
    for (const Pool& p : pools) out.statistic += sqr(std::max(std::fabs(p.seen - p.due) - p.slack, 0.0)) / p.due;
    out.pools = pools.size();
    out.degrees = static_cast<double>(pools.size()) - 1;
    out.p = chi_squared_p(out.statistic, out.degrees);
    return out;
}

std::vector<double> count(const TrialContext& work, const Density& d, const SampleBatch& b, double& nothing) {
    std::vector<double> bins(d.mass.bins.size());
    const std::vector<Vec2d>& at = work.coordinates_of(b, d.map);
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        work.subject.make_way(1);
        if (is_null_sample(b.draws[i], b.pdf[i])) {
            ++nothing;
            continue;
        }
        ++bins[d.bin_of(at[i])];
    }
    return bins;
}

/// Of n draws those due for a mass of one. What draws nothing is left by p, and the share that was drawn is what p is
/// scaled to, so that the normalisation is not judged twice. The sum of a table says less than its bins.
double due_for_one(const Density& d, double n) {
    const bool table = d.tabulation_error > 0 && std::fabs(d.mass.value + d.nothing - 1) <= d.tabulation_error;
    return table ? n : n * (1 - d.nothing) / d.mass.value;
}

/// What the draws of each bin, ring and sector are beside those due; of a p that is a random estimate with three
/// standard errors each, of points of their own.
Binned binned(const Density& d, const std::vector<double>& seen, double due_for_one, bool estimates) {
    const std::size_t sectors = static_cast<std::size_t>(d.sectors);
    Binned out{Counts(seen.size()), Counts(d.rings.size() - 1), Counts(sectors)};
    const double share_se = d.nothing < 1 ? d.nothing_se / (1 - d.nothing) : 0;  // of the share that is drawn
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const double due = due_for_one * d.mass.bins[i],
                     slack = due_for_one *
            ((d.tabulation_errors.empty() ? 0 : d.tabulation_errors[i]) + (estimates ? 1 : 3) * d.mass.bin_errors[i] +
                2 * share_se * d.mass.bins[i]);
        const auto add = [&](Counts& to, std::size_t k, double of_slack) {
            to.seen[k] += seen[i], to.due[k] += due, to.slack[k] += of_slack;
        };
        add(out.bins, i, slack);
        add(out.rings, i / sectors, estimates ? sqr(slack) : slack);
        add(out.sectors, i % sectors, estimates ? sqr(slack) : slack);
    }
    if (estimates)
        for (Counts* sums : {&out.rings, &out.sectors})
            for (double& v : sums->slack) v = std::sqrt(v);
    return out;
}

/// Rings that expect next to nothing: the Poisson law; the error of p is granted, which no bin states so far out.
void set_apart(const Density& d, double n, Binned& counts, FitToDensity& out) {
    const std::size_t sectors = static_cast<std::size_t>(d.sectors);
    for (std::size_t i = 0; i < counts.rings.due.size(); ++i) {
        if (counts.rings.due[i] >= std::max(1.0, 1e-5 * n)) continue;
        out.outside_seen += std::exchange(counts.rings.seen[i], 0);
        out.outside_due += std::exchange(counts.rings.due[i], 0);
        for (std::size_t k = i * sectors; k < (i + 1) * sectors; ++k) {
            counts.sectors.seen[k % sectors] -= std::exchange(counts.bins.seen[k], 0);
            counts.sectors.due[k % sectors] -= std::exchange(counts.bins.due[k], 0);
        }
    }
    if (out.outside_seen > 0)
        out.outside_p =
            poisson_tail(out.outside_due + n * (1e-4 + d.mass.error + d.tabulation_error), out.outside_seen);
}

/// The mean of ln p, or of ln (p sin theta), over the draws: what crowds in texels that are finer than bins.
void hold_heights(const Density& d, const SampleBatch& b, FitToDensity& out) {
    const std::optional<LogHeights>& due = d.mass.heights;
    if (!due || !(due->variance > 1e-8)) return;
    double n = 0, sum = 0;
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        if (is_null_sample(b.draws[i], b.pdf[i]) || !(b.pdf[i] > 0)) continue;
        const double a = d.map.height(b.draws[i].wi), sin = std::sqrt(std::max(a * (2 - a), 0.0));
        if (due->times_sin && !(sin > 0)) continue;
        sum += math::log(due->times_sin ? b.pdf[i] * sin : b.pdf[i]);
        ++n;
    }
    if (!(n > 0)) return;
    out.heights_off = (sum / n - due->mean) / std::sqrt(due->variance / n);
    out.heights_p = normal_two_sided(out.heights_off);
}

}  // namespace

Density joined(const Density& d, double least, std::size_t ring) {
    const auto angle = [](double a) { return math::acos(std::clamp(1 - a, -1.0, 1.0)); };
    Density out = d;
    out.rings = {0};
    std::vector<std::size_t> into;  // of each ring
    for (std::size_t i = 0; i + 1 < d.rings.size(); ++i) {
        into.push_back(out.rings.size() - 1);
        const double edge = d.rings[i + 1];
        if (angle(edge) - angle(out.rings.back()) >= least && angle(2) - angle(edge) >= least)
            out.rings.push_back(edge);
    }
    out.rings.push_back(d.rings.back());
    const double outer = out.rings[into[ring] + 1], round = 2 * pi * std::sqrt(std::max(outer * (2 - outer), 0.0));
    while (out.sectors > 1 && (d.sectors % out.sectors != 0 || round / out.sectors < 4 * least)) --out.sectors;
    const std::size_t sectors = static_cast<std::size_t>(d.sectors), fewer = static_cast<std::size_t>(out.sectors);
    const auto sum = [&](std::vector<double>& to, const std::vector<double>& from) {
        to.assign(from.empty() ? 0 : (out.rings.size() - 1) * fewer, 0.0);
        for (std::size_t i = 0; i < from.size(); ++i)
            to[into[i / sectors] * fewer + i % sectors * fewer / sectors] += from[i];
    };
    sum(out.mass.bins, d.mass.bins);
    sum(out.mass.bin_errors, d.mass.bin_errors);
    sum(out.tabulation_errors, d.tabulation_errors);
    return out;
}

FitToDensity fit_to_density(const TrialContext& work, int technique, const Density& d, const SampleBatch& b) {
    FitToDensity out;
    const bool estimates = work.scatter().pdf();
    if (!estimates) out.clump = densest_clump(work, technique, d, b);  // which needs p itself at the draws
    double nothing = 0;
    out.observed = count(work, d, b, nothing);
    const double n = static_cast<double>(b.draws.size());
    Binned counts = binned(d, out.observed, due_for_one(d, n), estimates);
    out.expected = counts.bins.due;
    set_apart(d, n, counts, out);
    if (n * d.nothing >= 5) {  // nothing drawn is one more bin: all of them together are n
        for (Counts* of : {&counts.bins, &counts.rings, &counts.sectors}) {
            of->seen.insert(of->seen.begin(), nothing);
            of->due.insert(of->due.begin(), n * d.nothing);
            of->slack.insert(of->slack.begin(), 2 * n * d.nothing_se);
        }
    }
    if (work.traits.wo == Traits::Asked::none) hold_heights(d, b, out);
    out.joint = pearson(counts.bins);
    out.rings = pearson(counts.rings);
    out.sectors = pearson(counts.sectors);
    out.joint.empty_observed += out.outside_seen;
    return out;
}

}  // namespace crescent::inline verdicts
