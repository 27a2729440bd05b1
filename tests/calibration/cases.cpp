// The sets. In `power` a case is a cell of kind and size; index / 20 counts the repetitions of a cell. It uses twelve
// families, or the held-out ones, each with a parameter that can mismatch.
#include "tests/calibration/cases.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace crescent::calibration {

namespace {

Rng rng_for(const CaseKey& key, std::string_view purpose) { return rng_of({key.set, key.seed, key.index, purpose}); }

bool of_held_out_set(const CaseKey& key) { return key.set.ends_with("-held-out"); }

std::vector<const Family*> families_of(bool held_out) {
    std::vector<const Family*> out;
    for (const Family& f : families())
        if (f.held_out == held_out) out.push_back(&f);
    return out;
}

const std::vector<const Family*>& twelve() {
    static const std::vector<const Family*> all = [] {
        std::vector<const Family*> out;
        for (const char* name : {"sky by rows and columns", "sky by alias table", "cone", "rectangle light by area",
                 "triangle light by area", "Henyey-Greenstein", "Lambert on both sides", "von Mises-Fisher mixture",
                 "lobes about fixed axes", "GGX by visible normals", "GGX by D", "fibre"})
            out.push_back(&family_named(name));
        return out;
    }();
    return all;
}

Real real_of(Rng& d) { return d.whole(0, 1) ? Real::f32 : Real::f64; }

std::vector<std::pair<double, double>> grid_of(const CaseKey& key, Traits::WoDomain asked) {
    Rng d = rng_for(key, "w_o");
    return random_grid(d, asked, key.wo);
}

/// The w_o of the cases, without baselines.
std::vector<Vec3d> directions_of(const std::vector<CheckCase>& check_cases) {
    std::vector<Vec3d> out;
    for (const CheckCase& t : check_cases)
        if (!t.baseline) out.push_back(t.wo);
    return out;
}

Case faulty_case(const Family& family, const Member& member, Real real, const Fault& fault, const CaseKey& key) {
    const Case right = case_of(sampler_of(family, member, real), key, State::right, "right");
    const Sampler s =
        faulty(family, member, real, fault, directions_of(right.check_cases), {key.set, key.seed, key.index, "fault"});
    Case c = case_of(s, key, State::wrong, std::string(word(fault)));
    c.size = fault.size;
    c.cause = cause_of(fault);
    c.held_out = family.held_out;
    return c;
}

Case make_right(const CaseKey& key) {
    static const std::vector<const Family*> sets[] = {families_of(false), families_of(true)};
    const auto& all = sets[of_held_out_set(key)];
    const Family& family = *all[key.index % all.size()];
    Rng d = rng_for(key, "parameters");
    const Member member = family.member(d);
    const Real real = key.index / all.size() % 2 ? Real::f32 : Real::f64;
    Case c = case_of(sampler_of(family, member, real), key, State::right, "right");
    c.held_out = family.held_out;
    return c;
}

Case make_power(const CaseKey& key) {
    constexpr FaultKind kinds[] = {FaultKind::constant, FaultKind::leak, FaultKind::rotation, FaultKind::mismatch};
    constexpr double sizes[] = {0.003, 0.01, 0.03, 0.1, 0.3};
    const std::uint64_t cell = key.index % 20;
    static const std::vector<const Family*> held_out = families_of(true);
    const auto& all = of_held_out_set(key) ? held_out : twelve();
    Rng d = rng_for(key, "parameters");
    const Family& family = *all[static_cast<std::size_t>(d.whole(0, static_cast<int>(all.size()) - 1))];
    const Real real = real_of(d);
    const Member member = family.member(d);
    return faulty_case(family, member, real, {kinds[cell / 5], sizes[cell % 5]}, key);
}

/// A fault with the families that can have it; if empty, all families for tuning.
struct Choice {
    Fault fault;
    std::vector<std::string_view> of{};
};

const std::vector<Choice>& nameable() {
    using K = FaultKind;
    const auto inner = [](Broken b) { return Fault{K::broken, 0, b}; };
    const std::vector<std::string_view> skies = {"sky by rows and columns", "sky by alias table"};
    const std::vector<std::string_view> lobes = {
        "von Mises-Fisher mixture", "lobes about fixed axes", "plastic", "rough lobe over Lambert"};
    static const std::vector<Choice> all = {{{K::factor, 2}}, {{K::factor, 3.14159265358979}}, {{K::factor, 0.5}},
        {{K::constant, 0.01}}, {{K::cos_missing}, {"Lambert", "Lambert on both sides", "power cosine"}},
        {{K::cos_twice}, {"Lambert", "Lambert on both sides", "GGX by visible normals", "textured disk", "plastic"}},
        {{K::sin_missing}, {"sky by rows and columns", "sky by alias table", "even texels"}},
        {{K::jacobian_missing}, {"GGX by visible normals", "GGX by D", "Beckmann by D", "Blinn-Phong"}},
        {{K::normal_missing}, {"GGX by D", "Beckmann by D", "Blinn-Phong"}},
        {{K::frame_mirrored}, {"Phong", "GGX by visible normals", "plastic"}},
        {{K::no_azimuth}, {"Henyey-Greenstein", "Lambert", "GGX by visible normals", "von Mises-Fisher"}},
        {inner(Broken::equal_weights), lobes}, {inner(Broken::transposed_table), skies},
        {inner(Broken::shifted_table), skies}, {inner(Broken::mirrored_table), skies}};
    return all;
}

/// Faults of all other kinds.
const std::vector<Choice>& other_kinds() {
    using K = FaultKind;
    const auto inner = [](Broken b) { return Fault{K::broken, 0, b}; };
    const std::vector<std::string_view> both = {"Henyey-Greenstein", "Lambert on both sides", "fibre"};
    const std::vector<std::string_view> lobes = {
        "von Mises-Fisher mixture", "lobes about fixed axes", "plastic", "two Henyey-Greenstein lobes"};
    static const std::vector<Choice> all = {{{K::hole, 0.003}}, {{K::hole, 0.01}}, {{K::hole, 0.03}},
        {{K::blind, 0.003}}, {{K::blind, 0.01}}, {{K::blind, 0.03}}, {{K::nan, 1e-3}}, {{K::nan, 0.01}},
        {{K::negative, 1e-3}}, {{K::negative, 0.01}}, {{K::length, 1e-3}}, {{K::length, 0.01}}, {{K::one_number}},
        {inner(Broken::lobe_pdf), lobes}, {inner(Broken::no_weights), lobes}, {{K::nan_in_plane}, both},
        {{K::nan_near_pole}, {"Phong", "GGX by visible normals", "Henyey-Greenstein"}},
        {{K::nan_at_horizon}, {"Lambert on both sides", "Phong", "Henyey-Greenstein"}}, {{K::nan_at_zero}}};
    return all;
}

Case make_choice(const CaseKey& key, const std::vector<Choice>& all) {
    static const std::vector<const Family*> tuning = families_of(false);
    const Choice& choice = all[key.index % all.size()];
    Rng d = rng_for(key, "parameters");
    const auto any = [&](std::size_t n) { return static_cast<std::size_t>(d.whole(0, static_cast<int>(n) - 1)); };
    const Family& family =
        choice.of.empty() ? *tuning[any(tuning.size())] : family_named(choice.of[any(choice.of.size())]);
    const Real real = real_of(d);
    const Member member = family.member(d);
    return faulty_case(family, member, real, choice.fault, key);
}
Case make_causes(const CaseKey& key) { return make_choice(key, nameable()); }
Case make_kinds(const CaseKey& key) { return make_choice(key, other_kinds()); }
Case make_stated(const CaseKey& key) { return stated_right(stated_case(key), key); }

}  // namespace

std::vector<std::pair<double, double>> random_grid(Rng& d, Traits::WoDomain asked, int count) {
    std::vector<std::pair<double, double>> out;
    if (asked == Traits::WoDomain::none) return out;
    for (int k = 0; k < count; ++k) {
        const double theta = d.whole(0, 7) == 0 ? 0 : d.whole(0, 3) ? d.uniform(0.5, 80) : d.uniform(80, 89);
        const double azimuth = d.uniform(0, 360);
        const bool below = d.whole(0, 1) == 1 && asked == Traits::WoDomain::both;
        out.emplace_back(below ? 180 - theta : theta, azimuth);
    }
    return out;
}

Case case_of(const Sampler& sampler, const CaseKey& key, State expected, std::string kind) {
    Case c;
    c.family = sampler.family;
    c.parameters = sampler.parameters;
    c.kind = std::move(kind);
    c.expected = expected;
    c.real = sampler.real();
    c.sampler = sampler;
    c.grid = grid_of(key, sampler.wo);
    c.check_cases = make_user_cases(make_adapter(sampler), key.full, c.grid);
    return c;
}

StatedCase stated_case(const CaseKey& key) {
    constexpr FaultKind kinds[] = {
        FaultKind::constant, FaultKind::leak, FaultKind::hole, FaultKind::rotation, FaultKind::exponent};
    StatedCase out{nullptr, {}, Real::f64, kinds[key.index % 5]};
    std::vector<const Family*> all;
    for (const Family& f : families()) {
        // A uniform density has no leak, and each of its powers is the same density.
        const bool even = f.name.starts_with("uniform") || f.name == "cone" || f.name == "ring";
        const bool can = out.kind == FaultKind::rotation ? f.name != "uniform sphere"
            : out.kind == FaultKind::leak                ? !f.name.starts_with("uniform")
            : out.kind == FaultKind::exponent            ? !even
                                                         : true;
        if (can && f.held_out == of_held_out_set(key)) all.push_back(&f);
    }
    Rng d = rng_for(key, "parameters");
    out.family = all[static_cast<std::size_t>(d.whole(0, static_cast<int>(all.size()) - 1))];
    out.real = real_of(d);
    out.member = out.family->member(d);
    return out;
}
Case stated_right(const StatedCase& of, const CaseKey& key) {
    Case c = case_of(sampler_of(*of.family, of.member, of.real), key, State::right, std::string(word({of.kind})));
    c.held_out = of.family->held_out;
    return c;
}
Case stated_faulty(const StatedCase& of, const CaseKey& key, double size) {
    return faulty_case(*of.family, of.member, of.real, {of.kind, size}, key);
}

const std::vector<CaseSet>& case_sets() {
    static const std::vector<CaseSet> all = {
        {"right", "right samplers with random parameters, one w_o each", 0, 1, make_right},
        {"right-held-out", "the same of the held-out families", 0, 1, make_right},
        {"fresh", "right samplers of families written after the engine", 0, 1, make_fresh},
        {"hard", "right samplers that are hard to integrate or to draw in single precision", count_hard(), 2,
            make_hard},
        {"power", "faults by size in twelve families: constant, leak, rotation, mismatch", 0, 0, make_power},
        {"power-held-out", "the same in the held-out families", 0, 0, make_power},
        {"stated", "faults of the size that a right verdict states as possibly hidden", 0, 1, make_stated},
        {"stated-held-out", "the same in the held-out families", 0, 1, make_stated},
        {"known", "planted faults of tests/known_samplers/faulty, including those held out", count_known(), 0,
            make_known},
        {"causes", "faults whose cause can be named", 0, 0, make_causes},
        {"kinds", "faults of all other kinds: caps, NaN, negative, boundaries, lobes", 0, 0, make_kinds},
        {"faults", "faults that users reported with their corrected samplers, and right ones reported wrong",
            count_reported(), 0, make_reported}};
    return all;
}

const CaseSet& case_set(std::string_view name) {
    std::vector<std::string> names;
    for (const CaseSet& s : case_sets()) {
        if (s.name == name) return s;
        names.push_back(s.name);
    }
    throw InputError({"SET", 0, 0}, fmt::format("no set '{}'{}", name, did_you_mean(name, names)));
}

}  // namespace crescent::calibration
