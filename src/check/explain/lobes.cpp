// The ends of the lobes are jumps of the direction along one number, at the same position for all values of the others.
// By (1), the integral of h p over a cell is the sum over lobes of x times the mean of h over draws of that lobe, with
// x = 1 if p has the lobe as it is drawn. Weighted least squares over cells gives x.
#include "check/explain/lobes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "check/explain/causes.h"
#include "check/estimate/sampling_map.h"
#include "check/explain/constants.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr std::size_t settings_of_others = 12, scan_points = 65, most_lobes = 8;
constexpr int halvings = 22;
constexpr std::uint32_t draws_for_lobes = 1u << 16, few_draws_for_lobes = 1u << 14;
constexpr std::uint32_t more_draws = 4, most_draws_for_lobes = 1u << 18;  // times as many, where a fit may become clear

struct NumberStep {
    std::size_t setting;
    double from, to;
    Draw a, b;
    bool jumps() const { return chord(a, b) > jump_angle; }
};

/// Bisects each step towards the larger change, and removes those that are smooth.
void close_in(Source& source, int number, std::span<const PrimarySample> others, std::vector<NumberStep>& steps) {
    for (int k = 0; k < halvings && !steps.empty(); ++k) {
        std::vector<PrimarySample> u;
        for (const NumberStep& s : steps) {
            u.push_back(others[s.setting]);
            u.back()[number] = (s.from + s.to) / 2;
        }
        const std::vector<Draw> middle = source.draw(u);
        for (std::size_t i = 0; i < steps.size(); ++i) {
            NumberStep& s = steps[i];
            if (chord(s.a, middle[i]) > chord(middle[i], s.b)) {
                s.to = u[i][number];
                s.b = middle[i];
            } else {
                s.from = u[i][number];
                s.a = middle[i];
            }
        }
        std::erase_if(steps, [](const NumberStep& s) { return !s.jumps(); });
    }
}

std::vector<NumberStep> jumps_along(Source& source, int number, std::span<const PrimarySample> others) {
    std::vector<NumberStep> out;
    for (std::size_t i = 0; i < others.size(); ++i) {
        std::vector<PrimarySample> u(scan_points, others[i]);
        for (std::size_t k = 0; k < scan_points; ++k)
            u[k][number] = std::clamp(static_cast<double>(k) / (scan_points - 1), steep_rim, 1 - steep_rim);
        const std::vector<Draw> w = source.draw(u);
        for (std::size_t k = 0; k + 1 < scan_points; ++k)
            if (const NumberStep s{
                    .setting = i, .from = u[k][number], .to = u[k + 1][number], .a = w[k], .b = w[k + 1]};
                s.jumps())
                out.push_back(s);
    }
    if (out.size() > settings_of_others * most_lobes) return {};  // a table
    close_in(source, number, others, out);
    std::ranges::sort(out, {}, &NumberStep::from);
    return out;
}

/// The ends that a third of the settings have in common; none if there are many other jumps between two directions.
std::vector<LobeInterval> intervals(const std::vector<NumberStep>& steps, std::size_t setting_count) {
    const auto has_two_directions = [](const NumberStep& s) { return has_direction(s.a) && has_direction(s.b); };
    std::vector<LobeInterval> out;
    double from = 0;
    std::ptrdiff_t common_count = 0;
    for (auto next = steps.begin(); next != steps.end();) {
        const auto first = next;
        while (next != steps.end() && next->from - first->from < one_end) ++next;
        if (3 * (next - first) < static_cast<std::ptrdiff_t>(setting_count)) continue;
        common_count += std::count_if(first, next, has_two_directions);
        const double end = (first[(next - first) / 2].from + first[(next - first) / 2].to) / 2;
        out.push_back({from, end});
        from = end;
    }
    if (out.empty() || 10 * common_count < 9 * std::count_if(steps.begin(), steps.end(), has_two_directions)) return {};
    out.push_back({from, 1});
    return out.size() <= most_lobes ? out : std::vector<LobeInterval>();
}

/// Sums of h by leaf over draws of one lobe, and the number of draws.
struct LobeDraws {
    std::vector<double> sum, square;
    double draw_count = 0;
};
LobeDraws draws_of(
    Source& source, const Place& place, const LobeChooser& chooser, std::size_t lobe, std::uint32_t count) {
    LobeDraws out;
    const Plan& plan = *place.check->plan;
    out.sum.resize(plan.tree.leaves().size());
    out.square.resize(out.sum.size());
    StreamKey key{.seed = 13,
        .place = static_cast<std::uint16_t>(place.number),
        .technique = static_cast<std::uint8_t>(place.technique()),
        .stage = 8,
        .purpose = Purpose::draws,
        .part = static_cast<std::uint16_t>(lobe)};
    for (std::uint32_t from = 0; from < count; from += batch_size) {
        std::vector<PrimarySample> u(std::min(batch_size, count - from));
        for (std::uint32_t i = 0; i < u.size(); ++i) {
            u[i] = numbers_at(key, from + i, source.numbers(), source.resolution());
            u[i][chooser.number] = chooser.lobes[lobe].from + chooser.lobes[lobe].share() * u[i][chooser.number];
        }
        const std::vector<Draw> draws = source.draw(u);
        const UsableDraws usable = usable_draws(source, draws);
        for (std::size_t i = 0; i < usable.w.size(); ++i) {
            const std::size_t l = plan.tree.find(to_chart(usable.w[i]));
            const double h = plan.values(plan.tree.leaves()[l], usable.w[i], usable.p[i])[bridge];
            out.sum[l] += h;
            out.square[l] += h * h;
        }
    }
    out.draw_count = count;
    return out;
}

/// A cell of leaves: the integral of h p, and the means of each lobe.
struct LobeCell {
    double claimed_mass = 0, variance = 0, draws = 0;
    std::vector<double> mean, mean_variance;
};

/// Neighbouring leaves in the order of the tree are joined until a cell has enough draws.
std::vector<LobeCell> cells_of(const Place& place, const LobeChooser& chooser, const std::vector<LobeDraws>& lobes) {
    std::vector<LobeCell> out;
    LobeCell cell;
    const auto clear = [&] {
        cell = {};
        cell.mean.resize(lobes.size());
        cell.mean_variance.resize(lobes.size());
    };
    clear();
    for (std::size_t l = 0; l < place.check->integrals.leaves.size(); ++l) {
        const Estimate& claim = place.check->integrals.leaves[l].bridge;
        cell.claimed_mass += claim.value;
        cell.variance += claim.variance;
        for (std::size_t k = 0; k < lobes.size(); ++k) {
            const double share = chooser.lobes[k].share() / lobes[k].draw_count;
            cell.mean[k] += share * lobes[k].sum[l];
            cell.mean_variance[k] += share * share * lobes[k].square[l];
            cell.draws += 2 * lobes[k].sum[l];
        }
        if (cell.draws + 2 * cell.claimed_mass * lobes[0].draw_count < draws_of_lobe) continue;
        out.push_back(std::move(cell));
        clear();
    }
    return out;
}

struct Shares {
    std::vector<double> x, errors;
    double misfit = 0, unit_misfit = 0, cells = 0;  // chi squared with x and with 1
};

double chi_squared(const std::vector<LobeCell>& cells, const std::vector<double>& x) {
    double out = 0;
    for (const LobeCell& c : cells) {
        double sum = 0, v = c.variance;
        for (std::size_t k = 0; k < x.size(); ++k) {
            sum += x[k] * c.mean[k];
            v += x[k] * x[k] * c.mean_variance[k];
        }
        out += (c.claimed_mass - sum) * (c.claimed_mass - sum) / (v + 1e-300);
    }
    return out;
}

std::optional<Shares> shares_of(const std::vector<LobeCell>& cells, std::size_t lobes) {
    Shares out;
    out.x.assign(lobes, 1);
    out.errors.resize(lobes);
    out.cells = static_cast<double>(cells.size());
    out.unit_misfit = chi_squared(cells, out.x);
    std::vector<std::vector<double>> normal;
    for (int round = 0; round < 8; ++round) {
        normal.assign(lobes, std::vector<double>(lobes));
        std::vector<double> right_side(lobes);
        for (const LobeCell& c : cells) {
            double v = c.variance + 1e-300;
            for (std::size_t k = 0; k < lobes; ++k) v += out.x[k] * out.x[k] * c.mean_variance[k];
            for (std::size_t k = 0; k < lobes; ++k) {
                right_side[k] += c.mean[k] * c.claimed_mass / v;
                for (std::size_t j = 0; j < lobes; ++j) normal[k][j] += c.mean[k] * c.mean[j] / v;
            }
            // The square of a mean is biased by its variance.
            for (std::size_t k = 0; k < lobes; ++k) normal[k][k] -= c.mean_variance[k] / v;
        }
        const auto x = solved(normal, right_side, 1e-6);
        if (!x) return {};
        for (double v : *x)
            if (!std::isfinite(v)) return {};
        out.x = *x;
    }
    for (std::size_t k = 0; k < lobes; ++k) {
        std::vector<double> unit(lobes);
        unit[k] = 1;
        const auto column = solved(normal, unit, 1e-6);
        out.errors[k] = column ? std::sqrt(std::max((*column)[k], 0.0)) : 1;
    }
    out.misfit = chi_squared(cells, out.x);
    return out;
}

bool explains(const Shares& s) {
    const double degrees = s.cells - static_cast<double>(s.x.size());
    if (degrees < 4 || !(s.unit_misfit > 2 * s.misfit)) return false;
    for (std::size_t k = 0; k < s.x.size(); ++k)
        if (s.x[k] < -3 * s.errors[k]) return false;  // no share is negative
    // The rest is within chance, or a fiftieth of the original misfit.
    return chi_squared_tail(degrees, s.misfit) > lobes_fit || s.misfit - degrees < 0.02 * (s.unit_misfit - degrees);
}

/// Whether x fits better than 1 beyond chance, and well: with more draws it may explain the difference.
bool may_explain(const Shares& s) {
    const double lobes = static_cast<double>(s.x.size());
    return s.cells > lobes && chi_squared_tail(lobes, s.unit_misfit - s.misfit) < lobes_fit &&
        chi_squared_tail(s.cells - lobes, s.misfit) > lobes_fit;
}

/// The shares by which p has the lobes that it draws otherwise; none if they do not explain the difference.
std::optional<Shares> shares_at(Source& source, const Place& place, const LobeChooser& chooser) {
    const auto lobes = static_cast<std::uint32_t>(chooser.lobes.size());
    for (std::uint32_t count = source.adapter.serial() ? few_draws_for_lobes : draws_for_lobes;; count *= more_draws) {
        std::vector<LobeDraws> draws;
        for (std::size_t k = 0; k < lobes; ++k) draws.push_back(draws_of(source, place, chooser, k, count / lobes));
        const std::optional<Shares> shares = shares_of(cells_of(place, chooser, draws), lobes);
        if (!shares || explains(*shares)) return shares;
        if (!may_explain(*shares) || count * more_draws > most_draws_for_lobes) return {};
    }
}

/// A probability with half of its interval, which is cut at 0 and 1.
std::string probability_text(double p, double half_width) {
    if (p - half_width < 0) return fmt::format("at most {:.2g}", std::max(p + half_width, 0.0));
    if (p + half_width > 1) return fmt::format("at least {:.2g}", std::min(p - half_width, 1.0));
    return with_error(p, half_width);
}

/// Whether one constant, the weighted mean, agrees with every x: nothing then speaks of a lobe.
bool is_one_constant(const Shares& s) {
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < s.x.size(); ++k) {
        const double weight = 1 / (s.errors[k] * s.errors[k] + 1e-300);
        sum += weight * s.x[k];
        weights += weight;
    }
    for (std::size_t k = 0; k < s.x.size(); ++k)
        if (std::fabs(s.x[k] - sum / weights) > std::max(3 * s.errors[k], known_share / 2)) return false;
    return true;
}

/// Whether p has a lobe as if it alone were drawn: times x, where it is drawn with this probability.
bool is_without_probability(double probability, double x, double error) {
    return std::fabs(x * probability - 1) < std::max(3 * error * probability, known_share);
}

/// `where`: " at w_o 60 deg", or "". Other probabilities of the same lobes leave the integral of p as it is: if that
/// differs, each lobe has a factor, which is named if it is known.
std::optional<std::string> lobe_sentence(const LobeChooser& chooser, const Shares& s, const std::string& where) {
    const int number = chooser.number + 1;
    std::vector<std::size_t> differing_lobes;
    std::vector<std::string> drawn_shares, claimed_shares, factors;
    bool are_shares_known = true, are_factors_known = true, lack_probabilities = true;
    double sum = 0, sum_half_width = 0;
    for (std::size_t k = 0; k < s.x.size(); ++k) {
        const double share = chooser.lobes[k].share(), half_width = 1.96 * s.errors[k];
        are_shares_known = are_shares_known && half_width * share < known_probability;
        are_factors_known = are_factors_known && half_width < known_factor * s.x[k];
        lack_probabilities = lack_probabilities && is_without_probability(share, s.x[k], s.errors[k]);
        sum += s.x[k] * share;
        sum_half_width += half_width * share;
        drawn_shares.push_back(fmt::format("{:.3g}", share));
        claimed_shares.push_back(probability_text(s.x[k] * share, half_width * share));
        factors.push_back(with_error(s.x[k], half_width));
        if (std::fabs(s.x[k] - 1) > std::max(3 * s.errors[k], known_share)) differing_lobes.push_back(k);
    }
    for (std::size_t k : differing_lobes)
        if (std::fabs(s.x[k]) < std::max(3 * s.errors[k], known_share) && 3 * s.errors[k] < known_absence)
            return fmt::format("p does not have one of the lobes that u{} chooses, the one from {:.4g} to {:.4g}{}.",
                number, chooser.lobes[k].from, chooser.lobes[k].to, where);
    if (differing_lobes.size() == 1) {
        const LobeInterval& lobe = chooser.lobes[differing_lobes[0]];
        const double x = s.x[differing_lobes[0]];
        const bool lacks_probability = is_without_probability(lobe.share(), x, s.errors[differing_lobes[0]]);
        return fmt::format(
            "Of the lobes that u{} chooses, the one from {:.4g} to {:.4g} has {:.3g} +- {:.1g} times what "
            "it draws in p{}, the others are right: {}.",
            number, lobe.from, lobe.to, x, 1.96 * s.errors[differing_lobes[0]], where,
            lacks_probability ? "the chooser's probability of that one lobe is left out"
                              : "the chooser's probability of that one lobe, or a constant of its own, is off");
    }
    if (lack_probabilities && are_factors_known)
        return fmt::format(
            "Of the lobes that u{} chooses, p has {} times what they draw{}, each as if it alone were drawn: the "
            "chooser's probability of each is left out.",
            number, fmt::join(factors, ", "), where);
    if (std::fabs(sum - 1) > sum_half_width + known_share) {
        if (!are_factors_known) return {};
        return fmt::format(
            "Of the lobes that u{} chooses, p has {} times what they draw{}: a factor that differs from lobe to lobe, "
            "such as a Jacobian or the area of a light.",
            number, fmt::join(factors, ", "), where);
    }
    return fmt::format(
        "The lobes that u{} chooses are drawn with {}{}; p has them with {}: the chooser's probability differs.",
        number, fmt::join(drawn_shares, ", "), where,
        are_shares_known ? fmt::format("{}", fmt::join(claimed_shares, ", ")) : "other probabilities");
}

}  // namespace

std::optional<LobeChooser> chooser_of(Source& source, const StreamKey& key) {
    if (source.traits.own_random || !source.declaration.can_draw || source.traits.numbers < 2) return {};
    std::vector<PrimarySample> others;
    for (std::uint32_t i = 0; others.size() < settings_of_others && i < 1000; ++i) {
        const PrimarySample u = numbers_at(key, i, source.numbers(), source.resolution());
        if (std::min(u.x, u.y) > 0.1 && std::max(u.x, u.y) < 0.9) others.push_back(u);
    }
    std::optional<LobeChooser> out;
    for (int number = source.traits.numbers - 1; number >= 0; --number) {
        std::vector<LobeInterval> lobes = intervals(jumps_along(source, number, others), others.size());
        if (lobes.empty()) continue;
        if (out) return {};  // two numbers select
        out = {number, std::move(lobes)};
    }
    return out;
}

std::optional<Cause> lobe_cause(std::span<const Place> places) {
    for (const Place& place : places) {
        if (place.traits.domain && place.traits.domain->has_set()) continue;  // every entry is a lobe of its own
        Source source = place.source();
        const StreamKey key = place.key(13, Purpose::pairs, 2);
        const std::optional<LobeChooser> chooser = chooser_of(source, key);
        if (!chooser) continue;
        const std::optional<Shares> shares = shares_at(source, place, *chooser);
        if (!shares) continue;
        if (is_one_constant(*shares)) continue;
        if (std::optional<std::string> text = lobe_sentence(*chooser, *shares, place.where()))
            return Cause{.factor = "chooser", .exponent = 0, .error = 0, .text = std::move(*text)};
    }
    return {};
}

}  // namespace crescent::check
