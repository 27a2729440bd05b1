// The list of families, in the order of the enumeration.
#include "check/verdicts/questions.h"

#include <array>

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

}  // namespace crescent::check
