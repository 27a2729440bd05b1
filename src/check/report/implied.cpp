// The cells are nodes of the tree, cut while their halves have enough draws. A bin of a map takes its share of each
// leaf, since both are rectangles of the same chart. Counts have binomial standard errors.
#include "check/report/implied.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr std::size_t most_cells = 512;
constexpr double degrees_per_ring = 5;

/// A share of the draws over a solid angle, 1/sr.
struct Implied {
    double p = 0, se = 0;
    Implied(double count, double draws, double solid_angle)
        : p(count / (draws * solid_angle)),
          se(std::sqrt(count * std::max(1 - count / draws, 0.0)) / (draws * solid_angle)) {}
};

std::vector<double> draws_by_node(const CheckAt& c) {
    const std::vector<TreeNode>& nodes = c.plan->tree.nodes();
    std::vector<double> out(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const TreeNode& x = nodes[i];
        const auto child = static_cast<std::size_t>(x.child);
        out[i] = x.child < 0 ? static_cast<double>(c.observations.counts[static_cast<std::size_t>(x.leaf)])
                             : out[child] + out[child + 1];
    }
    return out;
}

/// Cuts the cell with the most draws first.
std::vector<std::size_t> cells_of(const Tree& tree, const std::vector<double>& draws) {
    const auto can_be_cut = [&](std::size_t i) { return tree.nodes()[i].child >= 0 && draws[i] >= 2 * draws_of_cell; };
    const auto is_emptier = [&](std::size_t a, std::size_t b) {
        return draws[a] < draws[b] || (draws[a] == draws[b] && a > b);
    };
    std::vector<std::size_t> heap = {0}, out;
    while (!heap.empty()) {
        std::pop_heap(heap.begin(), heap.end(), is_emptier);
        const std::size_t i = heap.back();
        heap.pop_back();
        if (!can_be_cut(i) || heap.size() + out.size() + 2 > most_cells) {
            out.push_back(i);
            continue;
        }
        for (int half : {0, 1}) {
            heap.push_back(static_cast<std::size_t>(tree.nodes()[i].child + half));
            std::push_heap(heap.begin(), heap.end(), is_emptier);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<ImpliedDensity::Ring> rings_of(const CheckAt& c) {
    const auto& rings = c.observations.rings;
    std::size_t last = rings.size() / 2;
    for (std::size_t i = 0; i < rings.size(); ++i)
        if (rings[i] > 0) last = std::max(last, i + 1);
    std::vector<ImpliedDensity::Ring> out;
    for (std::size_t i = 0; i < last; ++i) {
        const double from = static_cast<double>(i) * degrees_per_ring, to = from + degrees_per_ring;
        const double angle = two_pi * (math::cos(from * two_pi / 360) - math::cos(to * two_pi / 360));
        const Implied density(rings[i], c.observations.independent, angle);
        out.push_back({from, to, density.p, density.se});
    }
    return out;
}

}  // namespace

void note_implied_density(const CheckAt& c, Verdict& v) {
    const Tree& tree = c.plan->tree;
    const std::vector<double> draws = draws_by_node(c);
    const double n = c.observations.independent;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    double highest_bound =
        0;  // The highest cell is selected by its lower bound: four standard errors exceed the chance of 512 cells
    std::size_t highest_cell = 0;
    for (std::size_t i : cells_of(tree, draws)) {
        const ChartRect& r = tree.nodes()[i].rect;
        const Implied density(draws[i], n, r.area());
        rows.push_back({1 - r.t1, 1 - r.t0, r.phi0, r.phi1, density.p, density.se});
        if (density.p - 4 * density.se > highest_bound) {
            highest_bound = density.p - 4 * density.se;
            highest_cell = i;
        }
    }
    const ChartRect& r = tree.nodes()[highest_cell].rect;
    const Vec3d w = from_chart(r.at(0.5, 0.5));
    const Implied peak(draws[highest_cell], n, r.area());
    v.evidence["implied_by"] = "tree";
    v.evidence["implied_peak"] = {{"wi", {w.x, w.y, w.z}}, {"pdf", peak.p}, {"standard_error", peak.se}};
    v.implied = {rings_of(c), peak.p, peak.se};
    nlohmann::ordered_json ring_rows = nlohmann::ordered_json::array();
    for (const ImpliedDensity::Ring& ring : v.implied->rings)
        ring_rows.push_back({ring.from, ring.to, ring.pdf, ring.error});
    v.evidence["implied_rings"] = {
        {"columns", {"from_deg", "to_deg", "pdf", "standard_error"}}, {"rows", std::move(ring_rows)}};
    v.evidence["implied_bins"] = {
        {"columns", {"cos_theta_from", "cos_theta_to", "phi_from", "phi_to", "pdf", "standard_error"}},
        {"rows", std::move(rows)}};
    if (draws[0] > 0)
        v.sentences = {{"no pdf", "There is no pdf(w) to compare the draws with."},
            {"implied density",
                fmt::format("The density that they imply is highest about {}: {:.4g} +- {:.2g} 1/sr, over {:.2g} sr.",
                    direction_text(w), peak.p, peak.se, r.area())}};
    else v.sentences = {{"no pdf", "There is no pdf(w), and no direction is drawn as a density."}};
}

}  // namespace crescent::check
