// Each sentence is computed only from the numbers of the finding. The verdict that contains it names w_o.
#include "check/report/sentences.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "check/decide/sizes.h"
#include "check/report/implied.h"
#include "check/report/places.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr double few_nodes = 16;  // fewer are not many places

/// "u = (0.25, 0), w_i = (0, 0, 1)".
std::string place_text(const std::vector<double>& u, const Traits& traits, const Example& e) {
    const std::string place = crescent::place_text(traits, e.draw.wi);
    return u.empty() ? place : fmt::format("u = ({:.6g}), {}", fmt::join(u, ", "), place);
}
std::string place_of(const Example& e, const Traits& traits) { return place_text(numbers_of(e, traits), traits, e); }

/// Without a single draw at which p is positive.
Sentence empty_sentence(const DrawChecks& c, double mass) {
    const std::uint64_t empty_draws = c.nothing - c.draws_below, unused_draws = c.draws - c.nothing;
    std::vector<std::string> parts;
    const auto add = [&](std::uint64_t count, const char* what) {
        if (count > 0) parts.push_back(fmt::format("{} {}", count, what));
    };
    add(c.draws_below, "have a direction below the surface, where pdf(w) is 0");
    add(empty_draws, "return no sample (their pdf is 0)");
    add(c.deltas, "are delta parts");
    add(unused_draws > c.deltas ? unused_draws - c.deltas : 0, "cannot be used");
    return {"no draw of p",
        fmt::format("p integrates to {:.5g}, but no draw is a direction of p: of {} draws {}.", mass, c.draws,
            crescent::listed(parts))};
}

/// Whether p is larger somewhere than its points resolve, as near a pole.
bool is_partly_unresolved(const CheckAt& c) {
    return c.observations.unresolved > 0 || c.integrals.unresolved.value > 0;
}

/// The integral of p where its points resolve it.
Sentence integral_of_p(const CheckAt& c, double value, double half_width) {
    const std::string integral = with_error(value, half_width);
    if (!is_partly_unresolved(c)) return {"integral", fmt::format("p integrates to {}.", integral)};
    return {"integral",
        fmt::format("p integrates to {} where its points resolve it; {} % of the draws are elsewhere.", integral,
            crescent::figures(100 * c.observations.share_unresolved()))};
}

Sentences mass_sentences(const CheckAt& c, const Answer& a) {
    const double drawn_share = a.expected + a.difference, half_width = half_width_95 * a.sd;
    if (!(drawn_share > 0)) return {empty_sentence(c.observations.checks, a.expected)};
    if (!(a.expected > 0))
        return {{"no integral",
            fmt::format("p is 0 at all {:.0f} points at which it is integrated, and {} % of the samples draw a "
                        "direction.",
                c.integrals.points, crescent::figures(100 * drawn_share))}};
    return {integral_of_p(c, a.expected, half_width),
        {"expected",
            drawn_share > 1 - 1e-9
                ? "Expected 1."
                : fmt::format("Expected {:.6g}, the share of the samples that draw a direction.", drawn_share)}};
}

/// The sum of h p over the leaves below a node.
double claimed_below(const CheckAt& c, int node) {
    const TreeNode& x = c.plan->tree.nodes()[static_cast<std::size_t>(node)];
    if (x.child < 0) return c.integrals.leaves[static_cast<std::size_t>(x.leaf)].bridge.value;
    return claimed_below(c, x.child) + claimed_below(c, x.child + 1);
}

/// The share of the draws at a node that are in its first half, or in the other one if p has less of that.
Sentence node_sentence(const CheckAt& c, const Answer& a) {
    const std::vector<TreeNode>& nodes = c.plan->tree.nodes();
    const TreeNode& x = nodes[static_cast<std::size_t>(a.member)];
    const double first_mass = claimed_below(c, x.child), total_mass = first_mass + claimed_below(c, x.child + 1);
    const bool is_first = first_mass <= total_mass - first_mass;
    const double share = (is_first ? first_mass : total_mass - first_mass) / total_mass,
                 per_draw = first_mass / total_mass / a.expected;
    const ChartRect& half_rect = nodes[static_cast<std::size_t>(is_first ? x.child : x.child + 1)].rect;
    if (!(share > 0))
        return {"draws where p is 0",
            fmt::format("Draws fall where p expects none: {}.", region_text(half_rect, c.traits))};
    const double difference = a.difference * per_draw;
    return {"share of half a region",
        fmt::format("Of the draws{} {} % are {}, where p has {:.4g} %.",
            x.depth == 0 ? "" : " " + region_text(x.rect, c.traits) + ",",
            with_error(
                100 * (is_first ? share + difference : share - difference), 100 * half_width_95 * a.sd * per_draw),
            region_text(half_rect, c.traits), 100 * share)};
}

Sentence band_sentence(int member, const Answer& a, const Traits& traits) {
    const ChartRect r = rect_of_band(member);
    constexpr double degrees = 360 / two_pi;
    const bool is_of_phi = r.t0 == 0 && r.t1 == 2;
    const std::string where = traits.domain
        ? traits.domain->text(r)
        : fmt::format("at {} from {:.4g} to {:.4g} degrees", is_of_phi ? "azimuths" : "polar angles",
              degrees * (is_of_phi ? r.phi0 : angle_of(r.t0)), degrees * (is_of_phi ? r.phi1 : angle_of(r.t1)));
    const char* comparison = a.difference > 0 ? "more" : "fewer";
    return {fmt::format("{} draws in a band", comparison),
        fmt::format("{} {} draws than p expects {}.",
            percent_with_error(std::fabs(a.difference) / a.expected, half_width_95 * a.sd / a.expected), comparison,
            where)};
}

Sentence pair_sentence(
    const char* what, double share, const Example& e, const Traits& traits, const std::string& values) {
    return {what,
        fmt::format("{} for {:.3g} % of the draws, first at {}{}.", what, 100 * share, place_of(e, traits), values)};
}

std::string channel_of(const Answer& a, bool has_three_channels) {
    return has_three_channels ? fmt::format(" in channel {}", a.member + 1) : "";
}

/// What the weights are an estimate of.
const char* integrand(const Traits& traits) {
    if (traits.reciprocal_weight) return "h = target / (target + q)";
    return traits.domain ? "f" : "f L cos";
}

Sentences light_sentences(const Answer& a, Family family, const Traits& traits) {
    const double half_width = half_width_95 * a.sd;
    const bool has_three_channels = traits.channels == 3;
    if (family == Family::support)
        return {{"support",
            fmt::format("p is 0 over {} that carry {} of {}.", traits.domain ? "points" : "directions",
                percent_with_error(a.difference / a.expected, half_width / a.expected), integrand(traits))}};
    if (family == Family::albedo)
        return {{"albedo",
                    fmt::format("f returns {} times the power of a uniform light{}.",
                        with_error(1 + a.difference, half_width), channel_of(a, has_three_channels))},
            {"expected", "Expected at most 1."}};
    const std::string ratio = with_error(1 + a.difference / a.expected, half_width / a.expected);
    if (traits.reciprocal_weight)
        return {{"weighted draws",
                    fmt::format("The draws with their weights W give {} times the integral of {} over the support of "
                                "the target: light is {}.",
                        ratio, integrand(traits), a.difference > 0 ? "gained" : "lost")},
            {"expected", "Expected 1."}};
    return {{"weighted draws",
                fmt::format("The weighted draws give {} times the integral of {}{}.", ratio,
                    traits.domain ? "f" : "f cos", channel_of(a, has_three_channels))},
        {"expected", "Expected 1."}};
}

/// Sums of h = q / (p + q) weigh all directions; if the shares of all regions agree, the ratio is that of a constant.
Sentence bridge_sentence(const Answer& a) {
    if (!(a.expected > 0)) return {"draws only where p is 0", "Draws fall only where p is 0."};
    const double ratio = 1 + a.difference / a.expected;
    return {ratio > 0 ? "ratio of draws and p" : "no draw of p",
        fmt::format("Draws are {} times what p expects, weighted by h = q / (p + q).",
            with_error(std::max(ratio, 0.0), half_width_95 * a.sd / a.expected))};
}

/// The sentence of a whole sum.
Sentence sum_sentence(const Finding& f, const Answer& a, const Traits& traits) {
    const double half_width = half_width_95 * a.sd;
    switch (f.first.family) {
        case Family::slope:
        case Family::slope_sets:
            return {"mean of h ln p",
                fmt::format("The mean of h ln p over the draws is {} than p expects, by {}; h = q / (p + q).",
                    a.difference > 0 ? "larger" : "smaller", with_error(std::fabs(a.difference), half_width))};
        case Family::centre:
        case Family::centre_sets:
            if (traits.domain) return {"mean", "The mean of the draws differs from that of p."};
            return {"mean direction",
                fmt::format("The mean direction of the draws is off that of p by {} in {}.",
                    with_error(2 * a.difference, 2 * half_width), "xyz"[std::clamp(f.first.member, 0, 2)])};
        case Family::depth:
            return {a.expected < few_nodes ? "chi^2" : "chi^2 of many places",
                fmt::format("Draws and p differ{}: chi^2 is {:.4g}, {:g} expected.",
                    a.expected < few_nodes ? "" : " in many small places", a.difference + a.expected, a.expected)};
        default: return bridge_sentence(a);
    }
}

Sentence invalid_sentence(const InvalidAnswers& a, const Traits& traits) {
    const bool is_of_pdf = a.first == InvalidAnswers::Function::pdf;
    return {is_of_pdf ? "unusable pdf(w)" : "unusable f(w)",
        fmt::format("{} is not a number >= 0 at {} of {} {}, first {:g} at {}.", is_of_pdf ? "pdf(w)" : "f(w)",
            is_of_pdf ? a.pdf : a.f, is_of_pdf ? a.pdf_evaluations : a.f_evaluations,
            traits.domain ? "points" : "directions", a.value, place_text(traits, a.wi))};
}

}  // namespace

std::vector<double> numbers_of(const Example& e, const Traits& traits, bool is_draw) {
    std::vector<double> out;
    for (int k = 0; k < traits.own_numbers(); ++k) out.push_back(e.u[k]);
    if (!is_draw && std::ranges::all_of(out, [](double u) { return u == 0; })) return {};
    return out;
}

std::vector<double> numbers_of(const SmallFault& f, const Traits& traits) {
    return numbers_of(f.first, traits, f.family == Family::corners && !f.wo);
}

Sentences sentences_of(const CheckAt& c, const Finding& f) {
    const Answer& a = f.second.sd > 0 ? f.second : f.first;
    const DrawChecks& checks = c.observations.checks;
    const Traits& traits = c.traits;
    switch (f.first.family) {
        case Family::mass:
        case Family::mass_sets: return mass_sentences(c, a);
        case Family::node:
        case Family::node_sets: return {node_sentence(c, a)};
        case Family::bridge:
        case Family::bridge_sets:
        case Family::slope:
        case Family::slope_sets:
        case Family::centre:
        case Family::centre_sets:
        case Family::depth: return {sum_sentence(f, a, traits)};
        case Family::band: return {band_sentence(f.first.member, a, traits)};
        case Family::pointwise:
            return {pair_sentence("The pdf with a draw is not pdf(w)", a.difference, checks.pointwise.first, traits,
                fmt::format(": {:.5g} with the draw, pdf(w) {:.5g}",
                    traits.density(checks.pointwise.first.draw.wi, checks.pointwise.first.draw.pdf),
                    traits.density(checks.pointwise.first.draw.wi, checks.pointwise.first.p)))};
        case Family::zero: return {pair_sentence("pdf(w) is 0", a.difference, checks.zero.first, traits, "")};
        case Family::weight:
            return {pair_sentence("The weight is not f cos / pdf", a.difference, checks.weight.first, traits,
                fmt::format(": weight {:.5g}, f cos / pdf {:.5g}", checks.weight.first.draw.weight.value_or(0),
                    checks.weight.first.expected))};
        case Family::reference_f:
            return {pair_sentence("f is not the BRDF", a.difference, checks.reference_f.first, traits,
                fmt::format(
                    ": f cos {:.5g}, expected {:.5g}", checks.reference_f.first.p, checks.reference_f.first.expected))};
        case Family::repeats:
            return {{"repeats",
                        fmt::format("{:g} pairs of {:g} draws have the same {}.", a.difference,
                            c.observations.independent, traits.domain ? "point" : "direction")},
                {"expected", fmt::format("Expected {:.2g}.", a.expected)}};
        case Family::delta_share:
            return {{"share of a delta part",
                fmt::format("A delta part is {} of the draws and states a probability of {:.5g}.",
                    with_error(a.expected + a.difference, half_width_95 * a.sd), a.expected)}};
        case Family::delta_scatter:
            return {{"directions of delta parts",
                "Draws of delta parts have more than 16 directions: a distribution with a density is not a delta "
                "part."}};
        case Family::delta_weight:
            return {{"weights of a delta part",
                fmt::format("{:g} draws of a delta part have another weight than its first draw.", a.difference)}};
        case Family::support:
        case Family::albedo:
        case Family::mean: return light_sentences(a, f.first.family, traits);
        default:
            if (checks.invalid.times > 0)
                return {{"unusable answers",
                    fmt::format("{}: {:g} answers cannot be used, first at {}.",
                        fault_of(checks.invalid.first.draw, traits)
                            .value_or("The pdf or the weight is not a number >= 0"),
                        a.difference, place_of(checks.invalid.first, traits))}};
            return {invalid_sentence(c.invalid, traits)};
    }
}

namespace {

/// A direction, with its length if rounding moved it: at length 1 the fault may not be there.
std::string with_length(Vec3d w) {
    const double excess = std::sqrt(dot(w, w)) - 1;
    if (!(std::fabs(excess) > 1e-9)) return direction_text(w);
    return fmt::format("{} of length 1 {} {:.2g}", direction_text(w), excess < 0 ? '-' : '+', std::fabs(excess));
}

}  // namespace

Sentence sentence_of(const SmallFault& f, const Traits& traits) {
    std::string out = fmt::format("{}: {:g} of {:g}", f.what, f.times, f.trials);
    if (f.family == Family::jacobian) out += fmt::format(", by up to {:.3g} %", 100 * std::fabs(f.size));
    else if (f.family == Family::mis)
        out += fmt::format(" draws, by up to {:.3g}{}", std::fabs(f.size),
            f.first.expected > 0 ? fmt::format(" (sampler {:g})", f.first.expected) : "");
    const std::string place = place_text(numbers_of(f, traits), traits, f.first);
    if (!f.place.empty()) return {f.what, fmt::format("{} rows, first at {}: {}.", out, f.place, place)};
    return {f.what,
        fmt::format("{}, first at {}{}.", out, f.wo ? fmt::format("w_o = {}, ", with_length(*f.wo)) : "", place)};
}

namespace {

/// The least p-value of the families of a verdict, and the number of families that were tested.
std::pair<double, int> least_p(const CheckAt& c, std::string_view verdict) {
    std::pair<double, int> out{1, 0};
    for (const Answer& a : c.answers)
        if (info(a.family).verdict == verdict) {
            out.first = std::min(out.first, a.p);
            ++out.second;
        }
    return out;
}

/// With none among n draws, a share of 3 / n would have been found with a probability of 95 %.
Sentences valid_sentences(const CheckAt& c) {
    const double draws = c.observations.independent + c.observations.scrambled;
    Sentences out = {{"usable", fmt::format("{} evaluations can be used.", c.evaluations)}};
    if (draws > 0)
        out.push_back({"detectable", fmt::format("NaN in one of {:.2g} draws would have been found.", draws / 3)});
    return out;
}

Sentences albedo_sentence(const CheckAt& c) {
    double largest_albedo = 0, half_width = 0;
    for (const Answer& a : c.answers)
        if (a.family == Family::albedo && a.difference + a.expected > largest_albedo) {
            largest_albedo = a.difference + a.expected;
            half_width = half_width_95 * a.sd;
        }
    if (!(largest_albedo > 0)) return {};
    return {{"albedo",
        fmt::format("{} of a uniform light is reflected or transmitted.", with_error(largest_albedo, half_width))}};
}

Sentences mean_sentence(const CheckAt& c) {
    for (const Answer& a : c.answers)
        if (a.family == Family::mean && a.expected > 0)
            return {{"weighted draws",
                fmt::format("Weights average to {} times the integral of {}.",
                    with_error(1 + a.difference / a.expected, half_width_95 * a.sd / a.expected),
                    integrand(c.traits))}};
    return {};
}

}  // namespace

Sentences sentences_of_right(const CheckAt& c, std::string_view verdict) {
    const Estimate& integral = c.integrals.sums[mass];
    if (verdict == "valid") return valid_sentences(c);
    if (verdict == "support")
        return {{"support",
            fmt::format("{} is 0 wherever p is 0, at {:.0f} points.", integrand(c.traits), c.integrals.light.points)}};
    if (verdict == "normalised") return {integral_of_p(c, integral.value, half_interval(integral))};
    if (verdict == "physics") return albedo_sentence(c);
    if (verdict == "mean") return mean_sentence(c);
    if (const auto [p, families] = least_p(c, verdict); families > 0 && verdict == "density")
        return {{"p-value",
            fmt::format("Draws follow p in {} families of tests; the least p-value is {:.2g}.", families, p)}};
    if (verdict == "identity") return {{"agreement", "The functions of the sampler agree."}};
    return {};
}

Sentences sentences_of_open(const CheckAt& c, std::string_view verdict) {
    const Estimate& integral = c.integrals.sums[mass];
    if (verdict == "normalised" && c.is_integral_open())
        return {{"undetermined integral",
            fmt::format("{:.0f} points do not determine the integral of p to {:g} %: they give about {:.2g}, and a "
                        "pole of p may have any integral.",
                c.integrals.points, 100 * c.most_ratio() * target_constant, integral.value)}};
    const FaultKind* worst = nullptr;
    double size = 0, largest_ratio = 0;
    for (std::size_t k = 0; k < c.sizes.faults.size(); ++k) {
        const FaultKind& kind = fault_kinds()[k];
        const double ratio = ratio_of(c.sizes.faults[k], kind);
        if (verdict != kind.verdict || !(ratio > largest_ratio)) continue;
        worst = &kind;
        size = *c.sizes.faults[k].size;
        largest_ratio = ratio;
    }
    if (!worst) return {};
    const char* what = worst->words(c.traits).least;
    return {
        {fmt::format("least {}", what), fmt::format("The least {} that would have been found is {:.2g}.", what, size)},
        {"required", fmt::format("Right requires at most {:g}.", c.most_ratio() * worst->target)}};
}

std::vector<std::string> found_faults(std::map<std::string, double> sizes) {
    std::vector<std::string> out;
    for (const FaultKind& kind : fault_kinds())
        for (const FaultKind::Words& words : {kind.of_directions, kind.of_points}) {
            const auto entry = sizes.find(words.name);
            if (entry == sizes.end()) continue;
            out.push_back(fmt::format(fmt::runtime(words.found), std::min(words.unit * entry->second, words.unit)));
            sizes.erase(entry);  // both may have one name
        }
    return out;
}

// ---- Without pdf(w) only the weights of the draws are compared with f; if there are no weights either, the draws
// cannot be tested.

namespace {

bool has_all_weights(const CheckAt& c) { return c.observations.weighted_draws > 0 && c.observations.weightless == 0; }

void note_density(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v) {
    note_implied_density(c, v);
    v.state = State::skipped;
    const bool draws_only_deltas = static_cast<double>(c.observations.checks.deltas) == c.observations.independent;
    if (draws_only_deltas || (sampler.has_f() && has_all_weights(c))) return;
    v.state = State::inconclusive;
    v.sentences.push_back({"not examined",
        fmt::format("There is {}: whether the draws are right could not be examined.",
            has_all_weights(c) ? "no f either" : "no weight with the draws either")});
    v.next_step = has_all_weights(c) ? "f(w), for a comparison with the mean of the weights."
                                     : "pdf(w), or f(w) and a weight, f |cos| / p, with each draw (weight=yes).";
}

void note_mean(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v) {
    const bool has_mean = std::ranges::any_of(c.answers, [](const Answer& a) { return a.family == Family::mean; });
    if (has_mean || c.nothing_drawn) return;  // of several techniques, another one may have draws
    const bool is_dark = c.integrals.light.points > 0 && c.integrals.light.integral[0].value == 0 &&
        c.integrals.light.integral[1].value == 0 && c.integrals.light.integral[2].value == 0;
    if (c.observations.weightless > 0) {
        v.state = State::skipped;
        v.sentences = {{"no weights", "The draws come with neither a pdf nor a weight."}};
    } else if (is_dark) {
        v.sentences = {{"no light", fmt::format("f is 0 at all {:.0f} points.", c.integrals.light.points)}};
    } else if (has_all_weights(c) && (!sampler.traits().has_pdf || c.scatter.pdf() || c.scatter.f())) {
        v.state = State::inconclusive;
        v.sentences = {{"heavy tail", "The weights have a heavy tail: their mean has no known error."}};
        v.next_step = "Draws whose weights are bounded.";
    } else {
        v.state = State::inconclusive;
        v.sentences = {{"not measured", "The mean of the weights was not measured."}};
    }
}

/// Describes how the rows of a file were used, and how many rows are needed.
void note_rows(const CheckAt& c, Verdict& v) {
    if (v.name == "density") {
        v.evidence["rows_compared"] = c.observations.independent;
        v.sentences.push_back(
            {"use of rows", "One row in eight shapes the tree, four are compared with p, three confirm."});
    }
    if (v.state != State::inconclusive || !c.sizes.of("constant")) return;
    v.next = {};
    const double times = worst_ratio(c.sizes) / inconclusive_at;
    if (times > 1)
        v.next_step =
            fmt::format("About {:.2g} rows, and a table as fine.", 2 * c.observations.independent * times * times);
}

}  // namespace

void note_limits(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v) {
    if (v.state == State::wrong) return;
    if (v.name == "density" && !sampler.traits().has_pdf) note_density(sampler, c, v);
    if (v.name == "mean" && sampler.has_f()) note_mean(sampler, c, v);
    if (v.name == "valid") std::ranges::move(sentences_of(c.scatter), std::back_inserter(v.sentences));
    if (!sampler.can_draw()) note_rows(c, v);
}

}  // namespace crescent::check
