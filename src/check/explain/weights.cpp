// Uses fresh draws at up to three w_o where a test of them failed.
#include "check/explain/weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "check/decide/check_sampler.h"
#include "check/decide/whole_sampler.h"
#include "check/explain/causes.h"
#include "check/explain/constants.h"
#include "check/explain/factors.h"

namespace crescent::check {

namespace {

constexpr std::size_t most_directions = 3;
constexpr std::uint32_t draws_to_compare = 512;

using ByChannel = std::array<double, 3>;

/// For one draw: the returned and the expected value.
struct Compared {
    Vec3d wo{}, wi{};
    double pdf = 0, p = 0;
    bool has_weight = false;
    ByChannel weight{}, expected{}, f{}, reference_f{};
};

ByChannel channels_of(Vec3d v) { return {v.x, v.y, v.z}; }

std::vector<Compared> compared_at(const CheckCase& check_case, int technique, std::uint16_t place) {
    Source source(*check_case.adapter, technique, check_case.wo, check_case.light);
    const StreamKey key{.seed = 17,
        .place = place,
        .technique = static_cast<std::uint8_t>(technique),
        .stage = 8,
        .purpose = Purpose::light,
        .part = 1};
    const std::vector<PrimarySample> u = first_numbers(key, draws_to_compare, source.traits);
    const std::vector<Draw> draws = source.draw(u);
    std::vector<Vec3d> w;
    std::vector<const Draw*> usable;
    for (const Draw& d : draws)
        if (has_direction(d)) {
            w.push_back(d.wi);
            usable.push_back(&d);
        }
    std::vector<double> p(w.size());
    std::vector<Vec3d> f(w.size()), truth(w.size());
    if (source.has_density()) source.stated_pdf(w, p);
    if (source.has_f()) source.f_cos(w, f);
    if (check_case.adapter->has_true_f()) source.f_cos(w, truth, true);
    std::vector<Compared> out;
    for (std::size_t i = 0; i < w.size(); ++i) {
        const Draw& d = *usable[i];
        Compared c{.wo = check_case.wo,
            .wi = w[i],
            .pdf = d.pdf,
            .p = p[i],
            .has_weight = d.weight.has_value() && source.has_f(),
            .weight = {},
            .expected = {},
            .f = channels_of(f[i]),
            .reference_f = channels_of(truth[i])};
        if (c.has_weight) {
            c.weight = source.channels() == 3 ? channels_of(d.weights) : ByChannel{*d.weight, *d.weight, *d.weight};
            c.expected = channels_of(f[i] * (1 / d.pdf));
        }
        out.push_back(c);
    }
    return out;
}

bool are_near(const ByChannel& a, const ByChannel& b) {
    for (std::size_t c = 0; c < 3; ++c)
        if (!(std::fabs(a[c] - b[c]) <= 1e-3 * std::max(std::fabs(a[c]), std::fabs(b[c])))) return false;
    return true;
}
ByChannel grey(const ByChannel& c) {
    const double y = luminance({c[0], c[1], c[2]});
    return {y, y, y};
}
struct ChannelExchange {
    const char* name;
    ByChannel (*apply)(const ByChannel&);
};
constexpr ChannelExchange channel_exchanges[] = {
    {"channels 1 and 3 exchanged", [](const ByChannel& c) { return ByChannel{c[2], c[1], c[0]}; }},
    {"channels 1 and 2 exchanged", [](const ByChannel& c) { return ByChannel{c[1], c[0], c[2]}; }},
    {"channels 2 and 3 exchanged", [](const ByChannel& c) { return ByChannel{c[0], c[2], c[1]}; }},
    {"channels moved by one", [](const ByChannel& c) { return ByChannel{c[1], c[2], c[0]}; }},
    {"channels moved by two", [](const ByChannel& c) { return ByChannel{c[2], c[0], c[1]}; }},
    {"luminance in every channel", grey}};

std::optional<Cause> exchanged_channels(const std::vector<Compared>& comparisons) {
    double weight_count = 0, right_count = 0;
    std::array<double, std::size(channel_exchanges)> match_counts{};
    for (const Compared& c : comparisons) {
        if (!c.has_weight) continue;
        ++weight_count;
        right_count += are_near(c.weight, c.expected);
        for (std::size_t k = 0; k < match_counts.size(); ++k)
            match_counts[k] += are_near(c.weight, channel_exchanges[k].apply(c.expected));
    }
    if (weight_count < 64 || 2 * right_count > weight_count) return {};
    for (std::size_t k = 0; k < match_counts.size(); ++k)
        if (match_counts[k] >= 0.9 * weight_count)
            return Cause{.factor = channel_exchanges[k].name,
                .exponent = 0,
                .error = 0,
                .text = fmt::format("Weights are f cos / p with {}.", channel_exchanges[k].name),
                .verdict = "identity"};
    return {};
}

std::optional<Cause> ratio_cause(const std::vector<KnownRatio>& ratios, const CheckCase& check_case,
    const char* subject, const char* expected, const char* verdict) {
    const std::vector<Factor> factors = factors_for(check_case.adapter->traits(), check_case.light);
    const std::optional<RatioCause> c = explain_ratios(ratios, factors);
    if (!c) return {};
    return Cause{.factor = c->name,
        .exponent = c->exponent == 0 ? c->constant : c->exponent,
        .error = 0,
        .text = ratio_sentence(subject, expected, *c, check_case.adapter->traits()),
        .verdict = verdict};
}

void add_ratio(std::vector<KnownRatio>& to, Vec3d wo, Vec3d wi, double value, double expected) {
    if (expected > 0) to.push_back({wo, wi, value / expected});
}

/// f(a, b) with its eta^2 over f(b, a), for pairs across the surface and on one side.
std::vector<KnownRatio> reciprocity_ratios(const CheckCase& check_case) {
    const SamplerAdapter& s = *check_case.adapter;
    const Traits traits = s.traits();
    Stream stream({.seed = 19, .place = 0, .technique = 0, .stage = 8, .purpose = Purpose::pairs, .part = 1});
    std::vector<Pair> pairs, reversed_pairs;
    for (int i = 0; i < 256; ++i) {
        const auto direction = [&](bool is_below) { return random_direction(stream, is_below, 0.05); };
        const bool has_both_sides = traits.wo == Traits::WoDomain::both;
        pairs.push_back({direction(has_both_sides && i % 2), direction(has_both_sides && i % 2 == 0)});
        reversed_pairs.push_back({pairs.back().wi, pairs.back().wo});
    }
    std::vector<double> a(pairs.size()), b(reversed_pairs.size());
    s.f(pairs, a);
    s.f(reversed_pairs, b);
    std::vector<KnownRatio> out;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Pair& p = pairs[i];
        add_ratio(out, p.wo, p.wi, a[i] * reciprocal_ratio(traits, p, 0), b[i]);
    }
    return out;
}

/// Factors eta^2, in the orientation of w_o, and cosines that reciprocity reveals, once for each direction.
std::optional<Cause> reciprocity_cause(const CheckCase& check_case) {
    const Traits traits = check_case.adapter->traits();
    const std::vector<KnownRatio> ratios = reciprocity_ratios(check_case);
    std::vector<Factor> factors = {{"cos theta_i", [](Vec3d o, Vec3d i) { return std::fabs(i.z / o.z); }}};
    if (traits.eta && traits.eta->x == traits.eta->z)
        factors.push_back({"eta^2", [eta2 = sqr(traits.eta->x)](Vec3d o, Vec3d i) {
                               return o.z * i.z >= 0 ? 1.0 : o.z > 0 ? eta2 : 1 / eta2;
                           }});
    const std::optional<RatioCause> c = explain_ratios(ratios, factors);
    if (!c || c->exponent == 0 || std::fabs(c->constant - 1) > agreement) return {};
    return Cause{.factor = c->name,
        .exponent = c->exponent,
        .error = 0,
        .text = fmt::format("f(a, b) over f(b, a) is off by {}{} across the surface: {} in f.",
            c->name == "eta^2" ? "eta^2" : "the ratio of the cosines (cos theta_i)",
            c->exponent == 1 || c->exponent == -1 ? "" : fmt::format(" to the power {:g}", c->exponent),
            c->name == "eta^2" ? "eta^2 is missing or inverted" : "cos theta_i is once too often or missing"),
        .verdict = "physics"};
}

bool has_finding(const CheckAt& c, Family family) {
    return std::ranges::any_of(c.findings, [&](const Finding& f) { return f.first.family == family; });
}

}  // namespace

std::string ratio_sentence(const char* subject, const char* expected, const RatioCause& c, const Traits& traits) {
    const std::string number = number_name(c.constant, agreement, traits);
    const std::string constant = fmt::format("a constant {:.4g}{}", c.constant, number.empty() ? "" : " = " + number);
    if (c.exponent == 0) return fmt::format("{} {} times {}.", subject, expected, constant);
    const std::string power = std::fabs(c.exponent) == 1 ? "" : fmt::format("^{:g}", std::fabs(c.exponent));
    return fmt::format("{} {} {} {}{}{}.", subject, expected, c.exponent > 0 ? "times" : "over", c.name, power,
        std::fabs(c.constant - 1) < agreement ? "" : " and " + constant);
}

std::optional<Cause> weight_cause(std::span<const CheckCase> check_cases, const CheckOutcome& outcome) {
    std::vector<Compared> comparisons;
    const CheckCase* check_case = nullptr;
    std::size_t directions = 0;
    for (std::size_t k = 0; k < outcome.checks.size() && directions < most_directions; ++k)
        for (const CheckAt& c : outcome.checks[k]) {
            const bool is_wrong = has_finding(c, Family::pointwise) || has_finding(c, Family::weight) ||
                has_finding(c, Family::reference_f) || has_finding(c, Family::mean);
            if (!is_wrong) continue;
            check_case = &check_cases[outcome.check_cases[k]];
            const std::vector<Compared> place_comparisons =
                compared_at(*check_case, c.technique, static_cast<std::uint16_t>(outcome.check_cases[k]));
            comparisons.insert(comparisons.end(), place_comparisons.begin(), place_comparisons.end());
            ++directions;
        }
    if (check_case) {
        if (auto c = exchanged_channels(comparisons); c && check_case->adapter->traits().channels == 3) return c;
        std::vector<KnownRatio> pdf, weight, f;
        for (const Compared& c : comparisons) {
            add_ratio(pdf, c.wo, c.wi, c.pdf, c.p);
            if (c.has_weight) add_ratio(weight, c.wo, c.wi, c.weight[0], c.expected[0]);
            if (check_case->adapter->has_true_f()) add_ratio(f, c.wo, c.wi, c.f[0], c.reference_f[0]);
        }
        if (auto c = ratio_cause(pdf, *check_case, "The pdf with a draw is", "pdf(w)", "identity")) return c;
        if (auto c = ratio_cause(weight, *check_case, "Weights are", "f cos / p", "identity")) return c;
        if (auto c = ratio_cause(f, *check_case, "f is", "the BRDF", "mean")) return c;
    }
    for (const SmallFault& f : outcome.small)
        if (f.family == Family::reciprocity) return reciprocity_cause(check_cases[outcome.check_cases[0]]);
    return {};
}

}  // namespace crescent::check
