// The list of families, in the order of the enumeration, and the requirements of each verdict.
#include "check/verdicts/questions.h"

#include <array>

#include "check/verdicts/density.h"
#include "check/verdicts/kinds.h"
#include "check/verdicts/sums.h"

namespace crescent::check {

const FamilyInfo& info(Family family) {
    static constexpr std::array<FamilyInfo, static_cast<std::size_t>(Family::families)> list = {{
        {"values", "valid"},
        {"corners", "valid"},
        {"mass", "normalised"},
        {"mass, replicates", "normalised"},
        {"bridge", "density"},
        {"bridge, replicates", "density"},
        {"slope", "density"},
        {"slope, replicates", "density"},
        {"centre", "density"},
        {"centre, replicates", "density"},
        {"node", "density"},
        {"node, replicates", "density"},
        {"band", "density"},
        {"depth", "density"},
        {"delta share", "density"},
        {"delta scatter", "density"},
        {"delta weight", "identity"},
        {"pointwise", "identity"},
        {"zero", "identity"},
        {"weight", "identity"},
        {"jacobian", "identity"},
        {"repeats", "identity"},
        {"state", "identity"},
        {"support", "support"},
        {"mean", "mean"},
        {"f", "mean"},
        {"mis", "mean"},
        {"albedo", "physics"},
        {"reciprocity", "physics"},
        {"delta direction", "physics"},
    }};
    return list[static_cast<std::size_t>(family)];
}

bool is_of_f(Family f) {
    return f == Family::weight || f == Family::support || f == Family::mean || f == Family::reference_f ||
        f == Family::albedo;
}

void test_distribution(const Evidence& e, const Visit& visit) {
    test_sums(e, visit);
    test_nodes(e, visit);
    test_bands(e, visit);
}

}  // namespace crescent::check

namespace crescent::check::kinds {

// ---- The requirements of each verdict: a pdf, f, weights.

namespace {

bool always(const SamplerAdapter&) { return true; }
bool draws_by_density(const SamplerAdapter& s) { return !s.traits().reciprocal_weight; }
bool never(const SamplerAdapter&) { return false; }
bool with_pdf(const SamplerAdapter& s) { return s.traits().has_pdf; }
bool with_pdf_and_f(const SamplerAdapter& s) { return s.traits().has_pdf && s.has_f(); }
bool with_f(const SamplerAdapter& s) { return s.has_f(); }
bool with_power(const SamplerAdapter& s) {
    return (s.has_f() || s.traits().delta) && !s.traits().domain && !s.traits().reciprocal_weight;
}
bool with_weights(const SamplerAdapter& s) { return s.has_drawn_f(); }

}  // namespace

constinit const VerdictKind valid = {.applies = always};
constinit const VerdictKind support = {.applies = with_pdf_and_f, .needs = "Needs pdf and f."};
constinit const VerdictKind normalised = {.applies = with_pdf, .needs = "Needs pdf."};
constinit const VerdictKind density = {.applies = draws_by_density,
    .needs = "Needs draws with one density."};  // without a pdf: the density that the draws imply
constinit const VerdictKind identity = {.applies = always};
constinit const VerdictKind physics = {.applies = with_power, .needs = "Needs f of a surface."};
constinit const VerdictKind tail = {.applies = with_weights, .needs = "Needs f or weights."};
constinit const VerdictKind mean = {.applies = with_f, .needs = "Needs f."};
constinit const VerdictKind efficiency = {
    .applies = never, .needs = "Needs f and another sampler at the same w_o."};  // decide/efficiency.cpp

}  // namespace crescent::check::kinds
