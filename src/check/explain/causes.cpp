// Tries candidates in order of likelihood. The first that passes the check in place of p is the cause, unless another
// one passes that the draws cannot distinguish from it.
#include "check/explain/causes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>

#include "check/decide/jacobian.h"
#include "check/explain/constants.h"
#include "check/explain/domain_causes.h"
#include "check/explain/factors.h"
#include "check/explain/frames.h"
#include "check/explain/hypothesis.h"
#include "check/explain/known_forms.h"
#include "check/explain/lobes.h"
#include "check/explain/reciprocal_weights.h"
#include "check/explain/regression.h"
#include "check/explain/spread.h"
#include "check/explain/warps.h"
#include "check/explain/weights.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr std::size_t most_places = 2, most_checks = 4;
constexpr std::uint32_t draws_of_many = 4096, draws_of_few = 1024;
constexpr std::uint32_t draws_of_points = 16384;  // few hypotheses are tried over other domains than directions

/// A candidate, and a function that describes it as a cause.
struct Candidate {
    Hypothesis hypothesis;
    std::function<Cause(const Hypothesis&)> make_cause{};
    double sufficient_share = 2;  // also named if it explains this share of the divergence; above 1: only if it passes
    int preference = 0;           // of two equivalent candidates the one with the larger value is named
    bool is_clear = true;  // whether its number is known well enough to name it, and not only to doubt another cause
};

std::optional<Candidate> constant_candidate(std::span<const Place> places) {
    std::vector<MassRatio> ratios;
    bool differs = false;
    for (const Place& place : places) {
        ratios.push_back(mass_ratio(*place.check));
        differs = differs ||
            std::fabs(ratios.back().ratio - 1) > std::max(detection_floor, clear_number * ratios.back().error);
    }
    if (!differs) return {};
    Candidate out;
    out.hypothesis.name = "constant";
    out.hypothesis.has_free_constant = true;
    out.hypothesis.density = [](const SamplerAdapter& s, int t, std::span<const Pair> pairs, std::span<double> to) {
        s.exact_pdf(t, pairs, to);
    };
    for (const MassRatio& m : ratios) {
        out.hypothesis.constants.push_back(1 / std::max(m.ratio, 1e-12));
        out.hypothesis.masses.push_back(out.hypothesis.constants.back());
    }
    score(out.hypothesis, places);
    out.make_cause = [ratios, places](const Hypothesis&) {
        const auto [low, high] = std::ranges::minmax_element(ratios, {}, &MassRatio::ratio);
        double mean = 0, error = 0;
        for (const MassRatio& m : ratios) {
            mean += m.ratio / static_cast<double>(ratios.size());
            error = std::max(error, m.error);
        }
        const double precision = std::max(4 * error / mean, detection_floor);
        Cause cause{.factor = "constant", .exponent = mean, .error = error, .text = ""};
        if (high->ratio - low->ratio > 2 * precision * mean) {
            const auto place_of = [&](auto it) {
                return places[static_cast<std::size_t>(it - ratios.begin())].where();
            };
            cause.text = fmt::format("p is a constant times what is drawn at each w_o, from {}{} to {}{}.",
                with_error(low->ratio, half_width_95 * low->error), place_of(low),
                with_error(high->ratio, half_width_95 * high->error), place_of(high));
            return cause;
        }
        const std::string name = number_name(mean, precision, places[0].traits);
        cause.text = fmt::format("p is a constant {}{} times what is drawn.", with_error(mean, half_width_95 * error),
            name.empty() || name == fmt::format("{:g}", std::round(mean)) ? "" : " = " + name);
        return cause;
    };
    return out;
}

std::string factor_sentence(const FactorHypothesis& f, const Hypothesis& h, std::span<const Place> places) {
    const double exponent = f.exponent;
    std::string out;
    if (f.name == "a constant across the surface") {
        const double factor = math::exp(-f.fitted_exponent), half_width = half_width_95 * f.error * factor;
        out = fmt::format("Across the surface p is {} times what is drawn{}.", with_error(factor, half_width),
            h.constants.empty() || std::fabs(h.constants[0] - 1) < near_one ? ", and right on the side of w_o"
                                                                            : ", relative to the side of w_o");
        out +=
            " A constant across the surface explains it: the probability with which a lobe is chosen (the "
            "chooser's) or a factor of that lobe.";
        return out;
    }
    const std::string power = std::fabs(exponent) == 1 ? "" : fmt::format("^{:g}", std::fabs(exponent));
    double least_constant = 1e300, greatest_constant = 0;
    for (double c : h.constants) {
        least_constant = std::min(least_constant, c);
        greatest_constant = std::max(greatest_constant, c);
    }
    std::string constant_text;
    if (greatest_constant < (1 + 2 * near_one) * least_constant && std::fabs(least_constant - 1) > near_one) {
        const std::string name = number_name(least_constant, near_one, places[0].traits);
        const bool is_same = name.empty() || name == fmt::format("{:g}", std::round(least_constant));
        constant_text = fmt::format(" and a constant {:.4g}{}", least_constant, is_same ? "" : " = " + name);
    } else if (greatest_constant > (1 + 2 * near_one) * least_constant) constant_text = " and a constant at each w_o";
    std::string meaning = f.name == "cosine at the light" ? plane_words(-exponent) : "";
    if (meaning.empty())
        meaning = fmt::format("{}{} {} in p", f.name, power, exponent > 0 ? "is missing" : "is once too often");
    return fmt::format("Draws follow p {} {}{}{} (fitted exponent {}): {}.", exponent > 0 ? "times" : "over", f.name,
        power, constant_text, with_error(f.fitted_exponent, half_width_95 * f.error), meaning);
}

Candidate candidate_of(FactorHypothesis f, std::span<const Place> places) {
    Candidate out;
    out.hypothesis = f.hypothesis;
    const bool is_without_constant =
        std::ranges::all_of(f.hypothesis.constants, [](double c) { return std::fabs(c - 1) < near_one; });
    out.preference = (std::fabs(f.exponent) == 1) + is_without_constant;
    out.make_cause = [f, places](const Hypothesis& h) {
        return Cause{.factor = f.name, .exponent = f.exponent, .error = f.error, .text = factor_sentence(f, h, places)};
    };
    return out;
}

Candidate candidate_of_power(FactorHypothesis f) {
    Candidate out{f.hypothesis};  // many densities that are no power of p are nearly one
    out.make_cause = [f](const Hypothesis&) {
        return Cause{.factor = "p",
            .exponent = f.exponent,
            .error = f.error,
            .text = fmt::format(
                "Draws follow p^({}), normalised: they are {} concentrated than p. An exponent or a roughness "
                "differs between sample and pdf.",
                with_error(1 + f.exponent, half_width_95 * f.error), f.exponent > 0 ? "more" : "less")};
    };
    return out;
}

Candidate candidate_of(const Leak& leak, std::span<const Place> places) {
    Candidate out{.hypothesis = leak.hypothesis,
        .make_cause = {},
        .sufficient_share = enough_for_fit,
        .preference = -1,
        .is_clear = leak.is_clear()};
    out.make_cause = [leak, traits = places[0].traits](const Hypothesis&) {
        return Cause{
            .factor = "leak", .exponent = leak.share, .error = leak.error, .text = leak_sentence(leak, traits)};
    };
    return out;
}

Candidate candidate_of(const Hypothesis& frame, bool is_of_points) {
    Candidate out{
        .hypothesis = frame, .make_cause = {}, .sufficient_share = enough_for_frame, .preference = -frame.place};
    // No table of points is read in another order; two exchanged parameters look like a mirrored point in part.
    if (is_of_points) out.sufficient_share = 2;
    out.make_cause = [name = frame.name, exchanges_parameters = frame.exchanges_parameters](const Hypothesis& h) {
        return Cause{.factor = name,
            .exponent = 0,
            .error = 0,
            .text = h.explained_share < explains_all
                ? fmt::format("{:.0f} % of the difference is explained by {} between draws and p.",
                      100 * h.explained_share, name)
                : fmt::format("Draws follow p with {}.{}", name + h.equivalents,
                      exchanges_parameters
                          ? " Two parameters that belong to x and y, such as two roughnesses, have the "
                            "same effect if they are exchanged."
                          : "")};
    };
    return out;
}

Candidate candidate_of(const FoundTurn& turn, std::span<const Place> places, bool is_about_z) {
    Candidate out{turn.hypothesis, {}, is_about_z ? enough_for_frame : enough_for_fit};
    out.make_cause = [turn, places, is_about_z](const Hypothesis& h) {
        std::size_t largest_index = 0;
        for (std::size_t k = 1; k < turn.turns.size(); ++k)
            if (dot(turn.turns[k].rotation, turn.turns[k].rotation) >
                dot(turn.turns[largest_index].rotation, turn.turns[largest_index].rotation))
                largest_index = k;
        const Turn& t = turn.turns[largest_index];
        const double angle = std::sqrt(dot(t.rotation, t.rotation));
        const Vec3d axis = t.rotation * (1 / std::max(angle, 1e-300));
        Cause cause{
            .factor = is_about_z ? "turned about z" : "turned", .exponent = angle, .error = t.error, .text = ""};
        if (is_about_z)
            cause.text = fmt::format(
                "Draws are those of p turned about z by {} rad{}: a shift of a table's columns, or "
                "of the azimuth.",
                with_error(t.rotation.z, half_width_95 * t.error),
                std::fabs(t.rotation.z) > 0 ? fmt::format(" = 2 pi / {:.1f}", two_pi / std::fabs(t.rotation.z)) : "");
        else
            cause.text = fmt::format("Draws are those of p turned by {} rad about ({:.3f}, {:.3f}, {:.3f}){}.",
                with_error(angle, half_width_95 * t.error), axis.x, axis.y, axis.z, places[largest_index].where());
        if (h.explained_share < explains_all)
            cause.text += fmt::format(" That explains {:.0f} % of the difference.", 100 * h.explained_share);
        return cause;
    };
    return out;
}

/// A number with which p has the coordinate of a line, and sample another one.
Candidate candidate_of(const FittedMove& move) {
    Candidate out{.hypothesis = move.hypothesis, .make_cause = {}, .sufficient_share = enough_for_fit, .preference = 1};
    out.make_cause = [move](const Hypothesis& h) {
        return Cause{.factor = move.factor,
            .exponent = move.value,
            .error = move.error,
            .text = fmt::format(
                "Draws are those of p with {} multiplied by {}{}: a rate, a mean free path or another scale "
                "differs between sample and pdf.",
                move.coordinate, with_error(move.value, half_width_95 * move.error), h.equivalents)};
    };
    return out;
}

/// A lobe or another entry is chosen with another probability than p says.
Candidate candidate_of(const EntryShares& entries) {
    Candidate out{
        .hypothesis = entries.hypothesis, .make_cause = {}, .sufficient_share = enough_for_fit, .preference = 1};
    out.make_cause = [shares = entries.shares](const Hypothesis&) {
        constexpr std::size_t most_entries = 4;
        std::string text;
        for (std::size_t k = 0; k < std::min(shares.size(), most_entries); ++k)
            text += fmt::format("{}entry {} with {}, p says {:.3g}", k > 0 ? "; " : "", k,
                with_error(shares[k].drawn_share, half_width_95 * shares[k].error), shares[k].claimed_share);
        return Cause{.factor = "shares of entries",
            .exponent = shares[0].drawn_share,
            .error = shares[0].error,
            .text =
                fmt::format("Within each entry draws follow p, but the entries are chosen with other probabilities: "
                            "{}{}.",
                    text, shares.size() > most_entries ? "; and more" : "")};
    };
    return out;
}

/// The frame of the surface is turned about n in sample and not in pdf, or by another angle.
Candidate candidate_of_frame(const FoundTurn& turn) {
    Candidate out{turn.hypothesis, {}, enough_for_frame};
    out.make_cause = [turn](const Hypothesis& h) {
        const Turn& t = turn.turns[0];
        std::string text = fmt::format(
            "Draws are those of p in a frame turned about n by {} rad: the tangent of sample is "
            "not that of pdf.",
            with_error(t.rotation.z, half_width_95 * t.error));
        if (h.explained_share < explains_all)
            text += fmt::format(" That explains {:.0f} % of the difference.", 100 * h.explained_share);
        return Cause{.factor = "turned about n", .exponent = t.rotation.z, .error = t.error, .text = std::move(text)};
    };
    return out;
}

using Candidates = std::vector<Candidate>;

void add_if(Candidates& to, std::optional<Candidate> c) {
    if (c) to.push_back(std::move(*c));
}

void sort_by_gain(Candidates& candidates) {
    std::ranges::sort(candidates, std::greater<>(), [](const Candidate& c) { return c.hypothesis.gain; });
}

/// Causes without a fitted number except a constant, or a share of uniform draws, which may look like one.
Candidates plain_candidates(std::span<const Place> places, std::span<const Leak> leaks) {
    Candidates out;
    add_if(out, constant_candidate(places));
    for (FactorHypothesis& f : factor_hypotheses(places))
        if (std::fabs(f.fitted_exponent) > clear_number * f.error) out.push_back(candidate_of(std::move(f), places));
    for (const Hypothesis& h : frame_hypotheses(places))
        out.push_back(candidate_of(h, places[0].traits.domain != nullptr));
    for (const Leak& leak : leaks)
        if (leak.is_clear()) out.push_back(candidate_of(leak, places));
    sort_by_gain(out);
    return out;
}

/// Causes with a fitted angle, exponent or share.
Candidates fitted_candidates(std::span<const Place> places, std::span<const Leak> leaks) {
    Candidates out;
    const bool has_directions = !places[0].traits.domain;
    if (!has_directions) {
        for (const FittedMove& move : domain_moves(places))
            if (move.is_clear()) out.push_back(candidate_of(move));
        if (const auto shares = entry_shares(places)) out.push_back(candidate_of(*shares));
    } else if (places[0].traits.wo == Traits::WoDomain::none) {
        if (const auto turn = azimuth_hypothesis(places); turn && turn->is_clear())
            out.push_back(candidate_of(*turn, places, true));
    } else if (const auto turn = frame_turn_hypothesis(places); turn && turn->is_clear())
        out.push_back(candidate_of_frame(*turn));
    if (const auto turn = has_directions ? turn_hypothesis(places) : std::nullopt; turn && turn->is_clear())
        out.push_back(candidate_of(*turn, places, false));
    if (auto power = power_hypothesis(places); power && std::fabs(power->exponent) > clear_number * power->error)
        out.push_back(candidate_of_power(std::move(*power)));
    for (const Leak& leak : leaks) out.push_back(candidate_of(leak, places));
    sort_by_gain(out);
    return out;
}

/// The candidate that passes, if no other of similar likelihood passes too.
std::optional<Cause> passing_cause(Candidates& candidates, std::span<const Place> places, bool& is_ambiguous) {
    Candidate* choice = nullptr;
    std::size_t checks = 0;
    for (Candidate& c : candidates) {
        if (choice) {
            const double lead = choice->hypothesis.gain - c.hypothesis.gain;
            const double chance_lead = least_lead / std::min(choice->hypothesis.draws, c.hypothesis.draws);
            if (lead > std::max(lead_errors * std::max(choice->hypothesis.error, c.hypothesis.error), chance_lead))
                break;
            if (are_equivalent(choice->hypothesis, c.hypothesis, places)) {
                const bool is_preferred = c.preference > choice->preference;
                const std::string other_name = is_preferred ? choice->hypothesis.name : c.hypothesis.name;
                if (is_preferred) {
                    c.hypothesis.equivalents = choice->hypothesis.equivalents;
                    choice = &c;
                }
                choice->hypothesis.equivalents += " (or " + other_name + ", which is the same here)";
                continue;
            }
        }
        if (is_below_map(c.hypothesis, places)) continue;
        if (checks++ == most_checks) break;
        if (!passes(c.hypothesis, places, 1)) continue;
        if (choice) return is_ambiguous = true, std::nullopt;
        choice = &c;
    }
    if (!choice) return {};
    if (!choice->is_clear) return is_ambiguous = true, std::nullopt;
    choice->hypothesis.explained_share = 1;
    return choice->make_cause(choice->hypothesis);
}

/// A cause for most of a difference that no candidate explains completely, at least twice as much as any other.
std::optional<Cause> partial_cause(Candidates& candidates, std::span<const Place> places) {
    Candidate* best = nullptr;
    for (Candidate& c : candidates) {
        if (c.sufficient_share > 1 || !c.is_clear) continue;
        score(c.hypothesis, places);
        if (c.hypothesis.gain > clear_number * c.hypothesis.error &&
            c.hypothesis.explained_share > c.sufficient_share && (!best || c.hypothesis.gain > best->hypothesis.gain))
            best = &c;
    }
    if (!best) return {};
    for (const Candidate& c : candidates) {
        if (&c == best || c.sufficient_share > 1 || c.hypothesis.explained_share < best->hypothesis.explained_share / 2)
            continue;
        if (!are_equivalent(best->hypothesis, c.hypothesis, places)) return {};
    }
    return best->make_cause(best->hypothesis);
}

/// The density of the sampling map over p, from its derivatives at a few points of each place.
std::vector<KnownRatio> map_ratios(std::span<const Place> places) {
    std::vector<KnownRatio> out;
    for (const Place& place : places)
        for (const MapDensity& m : place.map)
            out.push_back({place.check_case->wo, m.draw.wi, m.density / m.p, m.error});
    return out;
}

/// A constant or factor at nine of ten points of the map. They have no noise, so no other cause is as likely.
std::optional<Cause> cause_from_map(std::span<const KnownRatio> ratios, std::span<const Place> places) {
    const std::vector<Factor> factors = factors_for(places[0].traits, places[0].check_case->light);
    const std::optional<RatioCause> c = explain_ratios(ratios, factors);
    if (!c) return {};
    std::optional<Candidate> candidate = c->exponent == 0 ? constant_candidate(places) : std::nullopt;
    if (c->exponent != 0) {
        candidate.emplace();
        candidate->hypothesis = times(*std::ranges::find(factors, c->name, &Factor::name), c->exponent);
        candidate->hypothesis.constants.assign(places.size(), c->constant);
        candidate->make_cause = [c, places](const Hypothesis&) {
            return Cause{.factor = c->name,
                .exponent = c->exponent,
                .error = 0,
                .text = ratio_sentence("By the derivatives of sample(u), draws follow", "p", *c, places[0].traits) +
                    fmt::format(" In p {} is {}.", c->name, c->exponent > 0 ? "missing" : "once too often")};
        };
    }
    if (!candidate || !passes(candidate->hypothesis, places, 1)) return {};
    return candidate->make_cause(candidate->hypothesis);
}

std::optional<Cause> explained_by(std::span<const Place> places) {
    if (std::optional<Cause> c = warp_cause(places)) return c;
    const std::vector<KnownRatio> ratios = map_ratios(places);
    if (std::optional<Cause> c = cause_from_map(ratios, places)) return c;
    const std::vector<Leak> leaks = leak_hypotheses(places);
    Candidates candidates = plain_candidates(places, leaks);
    bool is_ambiguous = false;
    std::optional<Cause> cause = passing_cause(candidates, places, is_ambiguous);
    // Two lobes with exchanged weights, one of them uniform, are a share of uniform draws too; but p has that lobe.
    const bool is_leak = cause && cause->factor == "leak";
    if ((cause && !is_leak) || is_ambiguous) return cause;
    // A fitted parameter explains more than a factor without one, which is therefore tried first.
    if (std::optional<Cause> c = places[0].traits.domain ? std::nullopt : cause_of_known_form(ratios, places)) return c;
    if (std::optional<Cause> c = lobe_cause(places)) return c;
    if (cause) return cause;
    Candidates fits = fitted_candidates(places, leaks);
    if (std::optional<Cause> c = passing_cause(fits, places, is_ambiguous); c || is_ambiguous) return c;
    candidates.insert(candidates.end(), std::make_move_iterator(fits.begin()), std::make_move_iterator(fits.end()));
    return partial_cause(candidates, places);
}

/// Whether unusable draws and draws where p is 0 explain the difference of the masses: these have their own findings.
bool unusable_draws_explain(std::span<const Place> places) {
    bool has_unusable = false;
    for (const Place& place : places) {
        const DrawChecks& c = place.check->observations.checks;
        const auto share_of = [](std::uint64_t a, double total) {
            return static_cast<double>(a) / std::max(total, 1.0);
        };
        // Unusable draws are counted among all draws. Where p is 0, only a part of the draws that contradict pdf(w) is
        // compared.
        const double unusable_share =
                         share_of(c.invalid.times, static_cast<double>(c.draws) + place.check->observations.scrambled),
                     zero_share = share_of(c.zero.times, static_cast<double>(c.compared_draws)) *
            share_of(c.differing_draws, static_cast<double>(c.evaluated_draws));
        const MassRatio m = mass_ratio(*place.check);
        const double unexplained_mass = m.claimed_mass - m.drawn_mass - (unusable_share - zero_share);
        has_unusable = has_unusable || unusable_share + zero_share > detection_floor;
        if (std::fabs(unexplained_mass) >
            unusable_tolerance * (unusable_share + zero_share) + 4 * m.error * m.drawn_mass + detection_floor)
            return false;
    }
    return has_unusable;
}

}  // namespace

std::optional<Cause> cause_of(std::span<const CheckCase> check_cases, const CheckOutcome& outcome) {
    if (!outcome.check_cases.empty() && check_cases[outcome.check_cases[0]].adapter->traits().reciprocal_weight)
        return reciprocal_weight_cause(check_cases, outcome);
    const bool is_serial =
        std::ranges::any_of(outcome.check_cases, [&](std::size_t i) { return check_cases[i].adapter->serial(); });
    const bool has_points = std::ranges::any_of(
        outcome.check_cases, [&](std::size_t i) { return check_cases[i].adapter->traits().domain != nullptr; });
    const std::vector<Place> places = places_of(check_cases, outcome, most_places,
        has_points      ? draws_of_points
            : is_serial ? draws_of_few
                        : draws_of_many);
    if (places.empty()) return weight_cause(check_cases, outcome);
    if (unusable_draws_explain(places)) return {};
    if (std::optional<Cause> c = delta_cause(places)) return c;
    if (std::optional<Cause> c = curve_cause(places)) return c;
    if (std::optional<Cause> c = explained_by(places)) return c;
    return unreached_cause(places);
}

}  // namespace crescent::check
