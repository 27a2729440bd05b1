// Where draws and p differ, as shares: of the draws that fall in a region, and of p that it has there. The regions are
// nodes of the tree, which are rectangles of the chart. Draws are counted; p is integrated by the points of the leaves.
#include "check/report/places.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr double clear_errors = 6;      // of several thousand nodes none differs by as much by chance
constexpr double least_part = 0.7;      // a smaller node is named if it has this part of the largest difference
constexpr double same_spread = 0.05;    // nats: below this difference two distributions are equally concentrated
constexpr double largest_error = 0.05;  // relative, of the integral of p
constexpr double small_region = 0.3;    // rad

/// Draws, and the integral of p with its variance, below each node; as shares of their sums over the whole tree.
struct NodeShares {
    std::vector<double> counts, masses, variances;
    double draws = 0, mass = 0;

    NodeShares(const Plan& plan, const Integrals& integrals, const Observations& observations) {
        const std::vector<TreeNode>& nodes = plan.tree.nodes();
        counts.resize(nodes.size());
        masses.resize(nodes.size());
        variances.resize(nodes.size());
        for (std::size_t i = nodes.size(); i-- > 0;) {
            if (nodes[i].child < 0) {
                const auto l = static_cast<std::size_t>(nodes[i].leaf);
                const Estimate& p = integrals.leaves[l].mass;
                counts[i] = static_cast<double>(observations.counts[l]);
                masses[i] = p.value;
                variances[i] = p.variance;
                continue;
            }
            for (int half : {0, 1}) {
                const auto k = static_cast<std::size_t>(nodes[i].child + half);
                counts[i] += counts[k];
                masses[i] += masses[k];
                variances[i] += variances[k];
            }
        }
        draws = counts[0];
        mass = masses[0];
    }
    /// Whether there are draws, and p has an integral that is known well enough for shares of it.
    bool are_known() const { return draws > 0 && mass > 0 && std::sqrt(variances[0]) < largest_error * mass; }
    ShareDifference difference_at(std::size_t i) const {
        ShareDifference out;
        out.drawn_share = counts[i] / draws;
        out.claimed_share = masses[i] / mass;
        // Counts of a region are binomial; the larger share is used, since none of few draws has no spread.
        const double larger_share = std::clamp(std::max(out.drawn_share, out.claimed_share), 1 / draws, 1.0);
        out.drawn_error =
            std::sqrt(larger_share * std::max(1 - std::min(out.drawn_share, out.claimed_share), 1 / draws) / draws);
        const double other_variance = variances[0] - variances[i];
        out.claimed_error = std::sqrt((1 - out.claimed_share) * (1 - out.claimed_share) * variances[i] +
                                std::max(other_variance, 0.0) * out.claimed_share * out.claimed_share) /
            mass;
        return out;
    }
};

/// Nodes that are not cut further because neither half has enough draws or enough of p.
std::vector<std::size_t> cells_of(const Tree& tree, const NodeShares& shares) {
    std::vector<std::size_t> open_nodes = {0}, out;
    while (!open_nodes.empty()) {
        const std::size_t i = open_nodes.back();
        open_nodes.pop_back();
        const TreeNode& x = tree.nodes()[i];
        const double larger_count = std::max(shares.counts[i], shares.masses[i] / shares.mass * shares.draws);
        if (x.child < 0 || larger_count < 2 * draws_of_cell) {
            out.push_back(i);
            continue;
        }
        for (int half : {0, 1}) open_nodes.push_back(static_cast<std::size_t>(x.child + half));
    }
    return out;
}

/// With as many figures as tell the ends apart.
std::string range_text(double from, double to) {
    constexpr int most_figures = 9;
    int figures = 3;
    const auto text_of = [&](double degrees) { return fmt::format("{:.{}g}", degrees, figures); };
    while (figures < most_figures && text_of(from) == text_of(to)) ++figures;
    return text_of(from) + " to " + text_of(to) + " deg";
}

}  // namespace

double ShareDifference::errors() const {
    return std::fabs(difference()) / std::sqrt(drawn_error * drawn_error + claimed_error * claimed_error + 1e-300);
}

std::optional<ShareDifference> largest_difference(
    const Plan& plan, const Integrals& integrals, const Observations& observations) {
    if (integrals.leaves.empty() || observations.counts.empty()) return {};
    const NodeShares shares(plan, integrals, observations);
    if (!shares.are_known()) return {};
    const Tree& tree = plan.tree;
    double largest_size = 0;
    std::size_t best_node = 0;
    for (std::size_t i = 1; i < tree.nodes().size(); ++i) {
        const ShareDifference d = shares.difference_at(i);
        if (d.errors() > clear_errors && std::fabs(d.difference()) > largest_size) {
            largest_size = std::fabs(d.difference());
            best_node = i;
        }
    }
    if (best_node == 0) return {};
    for (bool has_smaller = true; has_smaller;) {
        has_smaller = false;
        const TreeNode& x = tree.nodes()[best_node];
        for (int half = 0; x.child >= 0 && half < 2 && !has_smaller; ++half) {
            const ShareDifference d = shares.difference_at(static_cast<std::size_t>(x.child + half));
            has_smaller = d.errors() > clear_errors && std::fabs(d.difference()) > least_part * largest_size;
            if (has_smaller) best_node = static_cast<std::size_t>(x.child + half);
        }
    }
    ShareDifference out = shares.difference_at(best_node);
    out.rect = tree.nodes()[best_node].rect;
    return out;
}

std::string region_text(const ChartRect& r, const Traits& traits) {
    if (traits.domain) return traits.domain->text(r);
    if (const double width = std::max(r.theta_width(), r.phi_width()); width < small_region)
        return fmt::format("around w_i = {}, within {:.2g} rad", direction_text(from_chart(r.at(0.5, 0.5))), width / 2);
    constexpr double degrees = 360 / two_pi;
    const bool has_every_angle = r.t0 == 0 && r.t1 == 2, has_every_azimuth = r.phi1 - r.phi0 > 0.999 * two_pi;
    std::string out = "at ";
    if (!has_every_angle || has_every_azimuth)
        out += "polar angles " + range_text(degrees * angle_of(r.t0), degrees * angle_of(r.t1));
    if (!has_every_azimuth)
        out +=
            fmt::format("{}azimuths {}", has_every_angle ? "" : ", ", range_text(degrees * r.phi0, degrees * r.phi1));
    return out;
}

std::string share_text(double share, double error) {
    const double half_width = half_width_95 * error;
    if (share - half_width < 0) return fmt::format("at most {:.2g} %", 100 * (share + half_width));
    if (share + half_width > 1) return fmt::format("at least {:.4g} %", 100 * (share - half_width));
    return percent_with_error(share, half_width);
}

Sentence sentence_of(const ShareDifference& d, const Traits& traits) {
    if (const auto entry = traits.domain ? traits.domain->entry(d.rect) : std::nullopt)
        return {"probability of an entry",
            fmt::format("Entry {} is drawn with {}, p says {}.", *entry,
                with_error(d.drawn_share, half_width_95 * d.drawn_error),
                with_error(d.claimed_share, half_width_95 * d.claimed_error))};
    return {"share of a region",
        fmt::format("Of the draws {} are {}, where p has {}.", share_text(d.drawn_share, d.drawn_error),
            region_text(d.rect, traits), share_text(d.claimed_share, d.claimed_error))};
}

std::optional<Concentration> concentration_of(const CheckAt& c) {
    if (!c.plan || c.integrals.leaves.empty() || c.observations.counts.empty()) return {};
    // The chart of an infinite line is fitted to the draws, so that they are even on it whatever they are on the line.
    if (c.traits.domain && c.traits.domain->domain().is_infinite()) return {};
    const NodeShares shares(*c.plan, c.integrals, c.observations);
    if (!shares.are_known()) return {};
    const Tree& tree = c.plan->tree;
    double drawn_entropy = 0, claimed_entropy = 0, log_square_sum = 0, occupied_cells = 0;
    for (std::size_t i : cells_of(tree, shares)) {
        const double area = tree.nodes()[i].rect.area(), s = shares.counts[i] / shares.draws,
                     m = shares.masses[i] / shares.mass;
        const double log_s = s > 0 ? math::log(s / area) : 0;
        drawn_entropy -= s * log_s;
        log_square_sum += s * log_s * log_s;
        occupied_cells += s > 0;
        if (m > 0) claimed_entropy -= m * math::log(m / area);
    }
    Concentration out;
    // Miller 1955: the entropy of counts is too low by (cells - 1) / (2 n).
    out.drawn_solid_angle = math::exp(drawn_entropy + (occupied_cells - 1) / (2 * shares.draws));
    out.claimed_solid_angle = math::exp(claimed_entropy);
    const double change = math::log(out.drawn_solid_angle / out.claimed_solid_angle);
    const double relative_error = std::sqrt(shares.variances[0]) / shares.mass;
    out.error =
        std::sqrt(std::max(log_square_sum - drawn_entropy * drawn_entropy, 0.0) / shares.draws) + relative_error;
    if (std::fabs(change) < same_spread && out.error < same_spread / 2)
        out.comparison = Concentration::Comparison::same;
    else if (std::fabs(change) > same_spread + clear_errors * out.error)
        out.comparison = change < 0 ? Concentration::Comparison::more : Concentration::Comparison::less;
    return out;
}

std::optional<Sentence> sentence_of(const Concentration& s, const Traits& traits) {
    using Comparison = Concentration::Comparison;
    if (s.comparison == Comparison::unknown) return {};
    if (s.comparison == Comparison::same)
        return Sentence{"equally concentrated",
            fmt::format("Draws and p are equally concentrated,{} at different places.",
                traits.domain ? "" : fmt::format(" within {:.3g} sr,", s.drawn_solid_angle))};
    const std::string what = fmt::format("{} concentrated", s.comparison == Comparison::more ? "more" : "less");
    return Sentence{what,
        fmt::format("Draws are {} than p{}.", what,
            traits.domain
                ? ""
                : fmt::format(": over {:.3g} sr, p over {:.3g} sr", s.drawn_solid_angle, s.claimed_solid_angle))};
}

}  // namespace crescent::check
