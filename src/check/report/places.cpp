// Where draws and p differ, as shares: of the draws that fall in a region, and of p that it has there. The regions are
// nodes of the tree, which are rectangles of the chart. Draws are counted; p is integrated by the points of the leaves.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "check/report/verdicts.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr double clear_errors = 6;       // of several thousand nodes none differs by as much by chance
constexpr double part_of_largest = 0.7;  // a smaller node is named if it has this part of the largest difference
constexpr double same_spread = 0.05;     // nats: below this difference two distributions are equally concentrated
constexpr double largest_error = 0.05;   // relative, of the integral of p
constexpr double small_region = 0.3;     // rad

/// Draws, and the integral of p with its variance, below each node; as shares of their sums over the whole tree.
struct NodeShares {
    std::vector<double> drawn, claimed, variance;
    double draws = 0, mass = 0;

    NodeShares(const Plan& plan, const Integrals& integrals, const Observations& observations) {
        const std::vector<TreeNode>& nodes = plan.tree.nodes();
        drawn.resize(nodes.size());
        claimed.resize(nodes.size());
        variance.resize(nodes.size());
        for (std::size_t i = nodes.size(); i-- > 0;) {
            if (nodes[i].child < 0) {
                const auto l = static_cast<std::size_t>(nodes[i].leaf);
                const Estimate& p = integrals.leaves[l].mass;
                drawn[i] = static_cast<double>(observations.counts[l]);
                claimed[i] = p.value;
                variance[i] = p.variance;
                continue;
            }
            for (int half : {0, 1}) {
                const auto k = static_cast<std::size_t>(nodes[i].child + half);
                drawn[i] += drawn[k];
                claimed[i] += claimed[k];
                variance[i] += variance[k];
            }
        }
        draws = drawn[0];
        mass = claimed[0];
    }
    /// Whether there are draws, and p has an integral that is known well enough for shares of it.
    bool known() const { return draws > 0 && mass > 0 && std::sqrt(variance[0]) < largest_error * mass; }
    ShareDifference at(std::size_t i) const {
        ShareDifference out;
        out.drawn = drawn[i] / draws;
        out.claimed = claimed[i] / mass;
        // Counts of a region are binomial; the larger share is used, since none of few draws has no spread.
        const double larger = std::clamp(std::max(out.drawn, out.claimed), 1 / draws, 1.0);
        out.drawn_error = std::sqrt(larger * std::max(1 - std::min(out.drawn, out.claimed), 1 / draws) / draws);
        const double rest = variance[0] - variance[i];
        out.claimed_error = std::sqrt((1 - out.claimed) * (1 - out.claimed) * variance[i] +
                                std::max(rest, 0.0) * out.claimed * out.claimed) /
            mass;
        return out;
    }
};

/// Nodes that are not cut further because neither half has enough draws or enough of p.
std::vector<std::size_t> cells_of(const Tree& tree, const NodeShares& shares) {
    std::vector<std::size_t> open = {0}, out;
    while (!open.empty()) {
        const std::size_t i = open.back();
        open.pop_back();
        const TreeNode& x = tree.nodes()[i];
        const double larger = std::max(shares.drawn[i], shares.claimed[i] / shares.mass * shares.draws);
        if (x.child < 0 || larger < 2 * draws_of_cell) {
            out.push_back(i);
            continue;
        }
        for (int half : {0, 1}) open.push_back(static_cast<std::size_t>(x.child + half));
    }
    return out;
}

/// With as many figures as tell the ends apart.
std::string range_text(double from, double to) {
    constexpr int most_figures = 9;
    int figures = 3;
    const auto text = [&](double degrees) { return fmt::format("{:.{}g}", degrees, figures); };
    while (figures < most_figures && text(from) == text(to)) ++figures;
    return text(from) + " to " + text(to) + " deg";
}

}  // namespace

double ShareDifference::errors() const {
    return std::fabs(difference()) / std::sqrt(drawn_error * drawn_error + claimed_error * claimed_error + 1e-300);
}

std::optional<ShareDifference> largest_difference(
    const Plan& plan, const Integrals& integrals, const Observations& observations) {
    if (integrals.leaves.empty() || observations.counts.empty()) return {};
    const NodeShares shares(plan, integrals, observations);
    if (!shares.known()) return {};
    const Tree& tree = plan.tree;
    double largest = 0;
    std::size_t best = 0;
    for (std::size_t i = 1; i < tree.nodes().size(); ++i) {
        const ShareDifference d = shares.at(i);
        if (d.errors() > clear_errors && std::fabs(d.difference()) > largest) {
            largest = std::fabs(d.difference());
            best = i;
        }
    }
    if (best == 0) return {};
    for (bool smaller = true; smaller;) {
        smaller = false;
        const TreeNode& x = tree.nodes()[best];
        for (int half = 0; x.child >= 0 && half < 2 && !smaller; ++half) {
            const ShareDifference d = shares.at(static_cast<std::size_t>(x.child + half));
            smaller = d.errors() > clear_errors && std::fabs(d.difference()) > part_of_largest * largest;
            if (smaller) best = static_cast<std::size_t>(x.child + half);
        }
    }
    ShareDifference out = shares.at(best);
    out.rect = tree.nodes()[best].rect;
    return out;
}

std::string region_text(const ChartRect& r, const Traits& traits) {
    if (traits.domain) return traits.domain->text(r);
    if (const double width = std::max(r.theta_width(), r.phi_width()); width < small_region)
        return fmt::format("around w_i = {}, within {:.2g} rad", direction_text(from_chart(r.at(0.5, 0.5))), width / 2);
    constexpr double degrees = 360 / two_pi;
    const bool every_angle = r.t0 == 0 && r.t1 == 2, every_azimuth = r.phi1 - r.phi0 > 0.999 * two_pi;
    std::string out = "at ";
    if (!every_angle || every_azimuth)
        out += "polar angles " + range_text(degrees * angle_of(r.t0), degrees * angle_of(r.t1));
    if (!every_azimuth)
        out += fmt::format("{}azimuths {}", every_angle ? "" : ", ", range_text(degrees * r.phi0, degrees * r.phi1));
    return out;
}

std::string share_text(double share, double error) {
    const double half = half_width_95 * error;
    if (share - half < 0) return fmt::format("at most {:.2g} %", 100 * (share + half));
    if (share + half > 1) return fmt::format("at least {:.4g} %", 100 * (share - half));
    return percent_with_error(share, half);
}

Sentence sentence_of(const ShareDifference& d, const Traits& traits) {
    if (const auto entry = traits.domain ? traits.domain->entry(d.rect) : std::nullopt)
        return {"probability of an entry",
            fmt::format("Entry {} is drawn with {}, p says {}.", *entry,
                with_error(d.drawn, half_width_95 * d.drawn_error),
                with_error(d.claimed, half_width_95 * d.claimed_error))};
    return {"share of a region",
        fmt::format("Of the draws {} are {}, where p has {}.", share_text(d.drawn, d.drawn_error),
            region_text(d.rect, traits), share_text(d.claimed, d.claimed_error))};
}

std::optional<Concentration> concentration_of(const CheckAt& c) {
    if (!c.plan || c.integrals.leaves.empty() || c.observations.counts.empty()) return {};
    // The chart of an infinite line is fitted to the draws, so that they are even on it whatever they are on the line.
    if (c.traits.domain && c.traits.domain->domain().is_infinite()) return {};
    const NodeShares shares(*c.plan, c.integrals, c.observations);
    if (!shares.known()) return {};
    const Tree& tree = c.plan->tree;
    double drawn = 0, claimed = 0, square = 0, occupied = 0;
    for (std::size_t i : cells_of(tree, shares)) {
        const double area = tree.nodes()[i].rect.area(), s = shares.drawn[i] / shares.draws,
                     m = shares.claimed[i] / shares.mass;
        const double log_s = s > 0 ? math::log(s / area) : 0;
        drawn -= s * log_s;
        square += s * log_s * log_s;
        occupied += s > 0;
        if (m > 0) claimed -= m * math::log(m / area);
    }
    Concentration out;
    // Miller 1955: the entropy of counts is too low by (cells - 1) / (2 n).
    out.drawn = math::exp(drawn + (occupied - 1) / (2 * shares.draws));
    out.claimed = math::exp(claimed);
    const double change = math::log(out.drawn / out.claimed);
    const double relative = std::sqrt(shares.variance[0]) / shares.mass;
    out.error = std::sqrt(std::max(square - drawn * drawn, 0.0) / shares.draws) + relative;
    if (std::fabs(change) < same_spread && out.error < same_spread / 2) out.compared = Concentration::Compared::same;
    else if (std::fabs(change) > same_spread + clear_errors * out.error)
        out.compared = change < 0 ? Concentration::Compared::more : Concentration::Compared::less;
    return out;
}

std::optional<Sentence> sentence_of(const Concentration& s, const Traits& traits) {
    using Compared = Concentration::Compared;
    if (s.compared == Compared::unknown) return {};
    if (s.compared == Compared::same)
        return Sentence{"equally concentrated",
            fmt::format("Draws and p are equally concentrated,{} at different places.",
                traits.domain ? "" : fmt::format(" within {:.3g} sr,", s.drawn))};
    const std::string what = fmt::format("{} concentrated", s.compared == Compared::more ? "more" : "less");
    return Sentence{what,
        fmt::format("Draws are {} than p{}.", what,
            traits.domain ? "" : fmt::format(": over {:.3g} sr, p over {:.3g} sr", s.drawn, s.claimed))};
}

}  // namespace crescent::check
