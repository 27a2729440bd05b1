// Each sentence is computed only from the numbers of the finding. The verdict that contains it names w_o.
#include "check/report/verdicts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/constants.h"
#include "output/format.h"

namespace crescent::check {

namespace {

constexpr double few_nodes = 16;  // fewer are not many places

std::string u_text(const PrimarySample& u, int count) {
    std::string out = "(";
    for (int k = 0; k < count; ++k) out += fmt::format("{}{:.6g}", k ? ", " : "", u[k]);
    return out + ")";
}

/// "first at u = (0.25, 0), w_i = (0, 0, 1)". of_draw: whether it is a draw even if all its numbers are 0.
std::string first_at(const Example& e, const Traits& traits, bool of_draw = false) {
    const int numbers = traits.own_numbers();
    bool any = of_draw;
    for (int k = 0; k < numbers; ++k) any = any || e.u[k] != 0;
    std::string out = "first at ";
    if (any && numbers > 0) out += "u = " + u_text(e.u, numbers) + ", ";
    return out + place_text(traits, e.draw.wi);
}

/// Without a single draw at which p is positive.
std::string empty_sentence(const DrawChecks& c, double mass) {
    const std::uint64_t empty = c.nothing - c.outside, unused = c.tested - c.nothing;
    std::vector<std::string> parts;
    const auto add = [&](std::uint64_t count, const char* what) {
        if (count > 0) parts.push_back(fmt::format("{} {}", count, what));
    };
    add(c.outside, "have a direction below the surface, where pdf(w) is 0");
    add(empty, "return no sample (their pdf is 0)");
    add(c.deltas, "are delta parts");
    add(unused > c.deltas ? unused - c.deltas : 0, "cannot be used");
    return fmt::format("p integrates to {:.5g}, but no draw is a direction of p: of {} draws {}.", mass, c.tested,
        crescent::listed(parts));
}

std::string mass_sentence(const CheckAt& c, const Answer& a) {
    const double drawn = a.expected + a.difference, half = half_width_95 * a.sd;
    if (!(drawn > 0)) return empty_sentence(c.observations.checks, a.expected);
    if (!(a.expected > 0))
        return fmt::format(
            "p is 0 at all {:.0f} points at which it is integrated, and {} % of the samples draw a "
            "direction.",
            c.integrals.points, crescent::figures(100 * drawn));
    if (drawn > 1 - 1e-9) return fmt::format("p integrates to {}. Expected 1.", with_error(a.expected, half));
    return fmt::format("p integrates to {}. Expected {:.6g}, the share of the samples that draw a direction.",
        with_error(a.expected, half), drawn);
}

/// The sum of h p over the leaves below a node.
double claimed_below(const CheckAt& c, int node) {
    const TreeNode& x = c.plan->tree.nodes()[static_cast<std::size_t>(node)];
    if (x.child < 0) return c.integrals.leaves[static_cast<std::size_t>(x.leaf)].bridge.value;
    return claimed_below(c, x.child) + claimed_below(c, x.child + 1);
}

/// The share of the draws at a node that are in its first half, or in the other one if p has less of that.
std::string node_sentence(const CheckAt& c, const Answer& a) {
    const std::vector<TreeNode>& nodes = c.plan->tree.nodes();
    const TreeNode& x = nodes[static_cast<std::size_t>(a.member)];
    const double first = claimed_below(c, x.child), both = first + claimed_below(c, x.child + 1);
    const bool is_first = first <= both - first;
    const double share = (is_first ? first : both - first) / both, per_draw = first / both / a.expected;
    const ChartRect& half = nodes[static_cast<std::size_t>(is_first ? x.child : x.child + 1)].rect;
    if (!(share > 0)) return fmt::format("Draws fall where p expects none: {}.", region_text(half, c.traits));
    const double difference = a.difference * per_draw;
    return fmt::format("Of the draws{} {} % are {}, where p has {:.4g} %.",
        x.depth == 0 ? "" : " " + region_text(x.rect, c.traits) + ",",
        with_error(100 * (is_first ? share + difference : share - difference), 100 * half_width_95 * a.sd * per_draw),
        region_text(half, c.traits), 100 * share);
}

std::string band_sentence(int member, const Answer& a, const Traits& traits) {
    const ChartRect r = rect_of_band(member);
    constexpr double degrees = 360 / two_pi;
    const bool of_phi = r.t0 == 0 && r.t1 == 2;
    const std::string where = traits.domain
        ? traits.domain->text(r)
        : fmt::format("at {} from {:.4g} to {:.4g} degrees", of_phi ? "azimuths" : "polar angles",
              degrees * (of_phi ? r.phi0 : angle_of(r.t0)), degrees * (of_phi ? r.phi1 : angle_of(r.t1)));
    return fmt::format("{} {} draws than p expects {}.",
        percent_with_error(std::fabs(a.difference) / a.expected, half_width_95 * a.sd / a.expected),
        a.difference > 0 ? "more" : "fewer", where);
}

std::string pair_sentence(
    const char* what, double share, const Example& e, const Traits& traits, const std::string& values) {
    return fmt::format("{} for {:.3g} % of the draws, {}{}.", what, 100 * share, first_at(e, traits), values);
}

std::string channel_of(const Answer& a, bool of_three) {
    return of_three ? fmt::format(" in channel {}", a.member + 1) : "";
}

/// What the weights are an estimate of.
const char* integrand(const Traits& traits) {
    if (traits.reciprocal_weight) return "h = target / (target + q)";
    return traits.domain ? "f" : "f L cos";
}

std::string light_sentence(const Answer& a, Family family, const Traits& traits) {
    const double half = half_width_95 * a.sd;
    const bool of_three = traits.channels == 3;
    if (family == Family::support)
        return fmt::format("p is 0 over {} that carry {} of {}.", traits.domain ? "points" : "directions",
            percent_with_error(a.difference / a.expected, half / a.expected), integrand(traits));
    if (family == Family::albedo)
        return fmt::format("f returns {} times the power of a uniform light{}. Expected at most 1.",
            with_error(1 + a.difference, half), channel_of(a, of_three));
    if (traits.reciprocal_weight)
        return fmt::format(
            "The draws with their weights W give {} times the integral of {} over the support of the "
            "target: light is {}. Expected 1.",
            with_error(1 + a.difference / a.expected, half / a.expected), integrand(traits),
            a.difference > 0 ? "gained" : "lost");
    return fmt::format("The weighted draws give {} times the integral of {}{}. Expected 1.",
        with_error(1 + a.difference / a.expected, half / a.expected), traits.domain ? "f" : "f cos",
        channel_of(a, of_three));
}

/// Sums of h = q / (p + q) weigh all directions; if the shares of all regions agree, the ratio is that of a constant.
std::string bridge_sentence(const Answer& a) {
    if (!(a.expected > 0)) return "Draws fall only where p is 0.";
    const double ratio = 1 + a.difference / a.expected;
    return fmt::format("Draws are {} times what p expects, weighted by h = q / (p + q).",
        with_error(std::max(ratio, 0.0), half_width_95 * a.sd / a.expected));
}

/// The sentence of a whole sum.
std::string sum_sentence(const Finding& f, const Answer& a, const Traits& traits) {
    const double half = half_width_95 * a.sd;
    switch (f.first.family) {
        case Family::slope:
        case Family::slope_sets:
            return fmt::format("The mean of h ln p over the draws is {} than p expects, by {}; h = q / (p + q).",
                a.difference > 0 ? "larger" : "smaller", with_error(std::fabs(a.difference), half));
        case Family::centre:
        case Family::centre_sets:
            if (traits.domain) return "The mean of the draws differs from that of p.";
            return fmt::format("The mean direction of the draws is off that of p by {} in {}.",
                with_error(2 * a.difference, 2 * half), "xyz"[std::clamp(f.first.member, 0, 2)]);
        case Family::depth:
            return a.expected < few_nodes
                ? fmt::format(
                      "Draws and p differ: chi^2 is {:.4g}, {:g} expected.", a.difference + a.expected, a.expected)
                : fmt::format("Draws and p differ in many small places: chi^2 is {:.4g}, {:g} expected.",
                      a.difference + a.expected, a.expected);
        default: return bridge_sentence(a);
    }
}

std::string invalid_sentence(const InvalidAnswers& a, const Traits& traits) {
    const bool of_pdf = a.first == InvalidAnswers::Function::pdf;
    return fmt::format("{} is not a number >= 0 at {} of {} {}, first {:g} at {}.", of_pdf ? "pdf(w)" : "f(w)",
        of_pdf ? a.pdf : a.f, of_pdf ? a.of_pdf : a.of_f, traits.domain ? "points" : "directions", a.value,
        place_text(traits, a.wi));
}

}  // namespace

std::string sentence_of(const CheckAt& c, const Finding& f) {
    const Answer& a = f.second.sd > 0 ? f.second : f.first;
    const DrawChecks& checks = c.observations.checks;
    const Traits& traits = c.traits;
    switch (f.first.family) {
        case Family::mass:
        case Family::mass_sets: return mass_sentence(c, a);
        case Family::node:
        case Family::node_sets: return node_sentence(c, a);
        case Family::bridge:
        case Family::bridge_sets:
        case Family::slope:
        case Family::slope_sets:
        case Family::centre:
        case Family::centre_sets:
        case Family::depth: return sum_sentence(f, a, traits);
        case Family::band: return band_sentence(f.first.member, a, traits);
        case Family::pointwise:
            return pair_sentence("The pdf with a draw is not pdf(w)", a.difference, checks.pointwise.first, traits,
                fmt::format(": {:.5g} with the draw, pdf(w) {:.5g}",
                    traits.density(checks.pointwise.first.draw.wi, checks.pointwise.first.draw.pdf),
                    traits.density(checks.pointwise.first.draw.wi, checks.pointwise.first.p)));
        case Family::zero: return pair_sentence("pdf(w) is 0", a.difference, checks.zero.first, traits, "");
        case Family::weight:
            return pair_sentence("The weight is not f cos / pdf", a.difference, checks.weight.first, traits,
                fmt::format(": weight {:.5g}, f cos / pdf {:.5g}", checks.weight.first.draw.weight.value_or(0),
                    checks.weight.first.expected));
        case Family::reference_f:
            return pair_sentence("f is not the BRDF", a.difference, checks.reference_f.first, traits,
                fmt::format(
                    ": f cos {:.5g}, expected {:.5g}", checks.reference_f.first.p, checks.reference_f.first.expected));
        case Family::repeats:
            return fmt::format("{:g} pairs of {:g} draws have the same {}. Expected {:.2g}.", a.difference,
                c.observations.independent, traits.domain ? "point" : "direction", a.expected);
        case Family::delta_share:
            return fmt::format("A delta part is {} of the draws and states a probability of {:.5g}.",
                with_error(a.expected + a.difference, half_width_95 * a.sd), a.expected);
        case Family::delta_scatter:
            return "Draws of delta parts have more than 16 directions: a distribution with a density is not a delta "
                   "part.";
        case Family::delta_weight:
            return fmt::format("{:g} draws of a delta part have another weight than its first draw.", a.difference);
        case Family::support:
        case Family::albedo:
        case Family::mean: return light_sentence(a, f.first.family, traits);
        default:
            if (checks.invalid.times > 0)
                return fmt::format("{:g} answers cannot be used: {}, {}.", a.difference,
                    fault_of(checks.invalid.first.draw, traits).value_or("the pdf or the weight is not a number >= 0"),
                    first_at(checks.invalid.first, traits));
            return invalid_sentence(c.invalid, traits);
    }
}

std::string sentence_of(const SmallFault& f, const Traits& traits) {
    std::string what = f.what;
    if (!what.empty() && what[0] >= 'a' && what[0] <= 'z' && what.compare(0, 2, "p ") != 0 &&
        what.compare(0, 3, "pdf") != 0 && what.compare(0, 2, "f(") != 0)
        what[0] = static_cast<char>(what[0] - 'a' + 'A');
    std::string out = fmt::format("{}: {:g} of {:g}", what, f.times, f.of);
    if (f.family == Family::jacobian) out += fmt::format(", by up to {:.3g} %", 100 * std::fabs(f.size));
    else if (f.family == Family::mis)
        out += fmt::format(" draws, by up to {:.3g}{}", std::fabs(f.size),
            f.first.expected > 0 ? fmt::format(" (sampler {:g})", f.first.expected) : "");
    const std::string where = first_at(f.first, traits, f.family == Family::corners && !f.wo);
    if (!f.place.empty()) return fmt::format("{} rows, first at {}: {}.", out, f.place, where.substr(9));
    return out + ", " + (f.wo ? fmt::format("first at w_o = {}, {}", direction_text(*f.wo), where.substr(9)) : where) +
        ".";
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
std::string valid_sentence(const CheckAt& c) {
    const double draws = c.observations.independent + c.observations.scrambled;
    std::string out = fmt::format("{} evaluations can be used.", c.evaluations);
    if (draws > 0) out += fmt::format(" NaN in one of {:.2g} draws would have been found.", draws / 3);
    return out;
}

std::string albedo_sentence(const CheckAt& c) {
    double largest = 0, half = 0;
    for (const Answer& a : c.answers)
        if (a.family == Family::albedo && a.difference + a.expected > largest) {
            largest = a.difference + a.expected;
            half = half_width_95 * a.sd;
        }
    return largest > 0 ? fmt::format("{} of a uniform light is reflected or transmitted.", with_error(largest, half))
                       : "";
}

std::string mean_sentence(const CheckAt& c) {
    for (const Answer& a : c.answers)
        if (a.family == Family::mean && a.expected > 0)
            return fmt::format("Weights average to {} times the integral of {}.",
                with_error(1 + a.difference / a.expected, half_width_95 * a.sd / a.expected), integrand(c.traits));
    return "";
}

}  // namespace

std::string sentence_of_right(const CheckAt& c, std::string_view verdict) {
    const Estimate& whole = c.integrals.sums[mass];
    if (verdict == "valid") return valid_sentence(c);
    if (verdict == "support")
        return fmt::format("{} is 0 wherever p is 0, at {:.0f} points.", integrand(c.traits), c.integrals.light.points);
    if (verdict == "normalised")
        return fmt::format("p integrates to {}.", with_error(whole.value, half_interval(whole)));
    if (verdict == "physics") return albedo_sentence(c);
    if (verdict == "mean") return mean_sentence(c);
    if (const auto [p, families] = least_p(c, verdict); families > 0 && verdict == "density")
        return fmt::format("Draws follow p in {} families of tests; the least p-value is {:.2g}.", families, p);
    if (verdict == "identity") return "The functions of the sampler agree.";
    return "";
}

std::string sentence_of_open(const CheckAt& c, std::string_view verdict) {
    struct Open {
        const char* what;
        double size, target, ratio;
    };
    const Sizes& s = c.sizes;
    const Estimate& whole = c.integrals.sums[mass];
    if (verdict == "normalised" && s.integral && *s.integral > c.most_ratio() * target_constant)
        return fmt::format(
            "{:.0f} points do not determine the integral of p to {:g} %: they give about {:.2g}, and a "
            "pole of p may have any integral.",
            c.integrals.points, 100 * c.most_ratio() * target_constant, whole.value);
    std::vector<Open> open;
    const auto add = [&](const char* what, std::optional<double> Sizes::* size, double target) {
        Sizes only;
        only.by_leak = s.by_leak;
        only.by_rotation = s.by_rotation;
        only.by_parameter = s.by_parameter;
        only.*size = s.*size;
        if (s.*size) open.push_back({what, *(s.*size), target, worst_ratio(only)});
    };
    if (verdict == "normalised") {
        add("relative constant factor of p", &Sizes::constant, target_constant);
    } else {
        add("share of draws spread evenly", &Sizes::leak, target_leak);
        add(c.traits.domain ? "share of p in a gap that is never drawn" : "share of p in a cap that is never drawn",
            &Sizes::cap, target_cap);
        add(c.traits.domain ? "shift as a share of the range" : "rotation in radians", &Sizes::rotation,
            target_rotation);
        add("relative change of an exponent", &Sizes::parameter, target_parameter);
    }
    if (open.empty()) return "";
    const Open& worst = *std::ranges::max_element(open, {}, &Open::ratio);
    return fmt::format("The least {} that would have been found is {:.2g}. Right requires at most {:g}.", worst.what,
        worst.size, c.most_ratio() * worst.target);
}

// ---- Without pdf(w) only the weights of the draws are compared with f; if there are no weights either, the draws
// cannot be tested.

namespace {

bool has_all_weights(const CheckAt& c) { return c.observations.weighted_draws > 0 && c.observations.weightless == 0; }

void note_density(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v) {
    note_implied_density(c, v);
    v.state = State::skipped;
    const bool of_deltas = static_cast<double>(c.observations.checks.deltas) == c.observations.independent;
    if (of_deltas || (sampler.has_f() && has_all_weights(c))) return;
    v.state = State::inconclusive;
    v.message += fmt::format(" There is {}: whether the draws are right could not be examined.",
        has_all_weights(c) ? "no f either" : "no weight with the draws either");
    v.next_step = has_all_weights(c) ? "f(w), for a comparison with the mean of the weights."
                                     : "pdf(w), or f(w) and a weight, f |cos| / p, with each draw (weight=yes).";
}

void note_mean(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v) {
    const bool tested = std::ranges::any_of(c.answers, [](const Answer& a) { return a.family == Family::mean; });
    if (tested || c.nothing_drawn) return;  // of several techniques, another one may have draws
    const bool dark = c.integrals.light.points > 0 && c.integrals.light.all[0].value == 0 &&
        c.integrals.light.all[1].value == 0 && c.integrals.light.all[2].value == 0;
    if (c.observations.weightless > 0) {
        v.state = State::skipped;
        v.message = "The draws come with neither a pdf nor a weight.";
    } else if (dark) {
        v.message = fmt::format("f is 0 at all {:.0f} points.", c.integrals.light.points);
    } else if (has_all_weights(c) && (!sampler.traits().has_pdf || c.scatter.pdf() || c.scatter.f())) {
        v.state = State::inconclusive;
        v.message = "The weights have a heavy tail: their mean has no known error.";
        v.next_step = "Draws whose weights are bounded.";
    } else {
        v.state = State::inconclusive;
        v.message = "The mean of the weights was not measured.";
    }
}

/// Describes how the rows of a file were used, and how many rows are needed.
void note_rows(const CheckAt& c, Verdict& v) {
    if (v.name == "density") {
        v.evidence["rows_compared"] = c.observations.independent;
        v.message += fmt::format("{}One row in eight shapes the tree, four are compared with p, three confirm.",
            v.message.empty() ? "" : " ");
    }
    if (v.state != State::inconclusive || c.sizes.constant == std::nullopt) return;
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
    if (v.name == "valid") v.message += text_of(c.scatter);
    if (!sampler.can_draw()) note_rows(c, v);
}

}  // namespace crescent::check
