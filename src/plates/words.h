// The words and numbers that stand on plates, all read from the experiment: arm names, densities, labels.
// Everything returned is Pango markup.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiment/experiment.h"
#include "films/film.h"
#include "plates/plates.h"

namespace crescent::plates {

/// A run of the plan with the experiment's own s and seed filled in.
RunKey key_of(const PlateRun& run, const Experiment& e);
std::vector<RunKey> keys_of(const PlatePlan& plan, const Experiment& e);

/// The label that a built-in arm has ("light-area (NEE)"); an arm under another name than its sampler keeps it.
std::string arm_name(const std::string& arm, const Experiment& e);
/// The word of arms/all.h that the arm uses, "" where the experiment has no such arm.
std::string sampler_of(const std::string& arm, const Experiment& e);
/// "n" or "R", what the arm's density is centred on; "" where that is not one of them.
std::string axis_of(const std::string& arm, const Experiment& e);
/// "p(ω) = (s+1)/(2π) (ω·R)<sup>s</sup>"; of an arm that combines two, their weights.
std::string density_formula(const std::string& arm, const Experiment& e);
/// The same density after `s` has been put in.
std::string density_formula_at(const std::string& arm, double s, const Experiment& e);

/// "phong N=256 s=32", or with several runs "uniform | cosine | phong N=64 s=32": what they share is said once,
/// and s where it says something of a run. Of an arm that joins two techniques N counts pairs.
std::string runs_label(const std::vector<RunKey>& runs, const Experiment& e, bool with_n = true);

/// How the reference was computed: "by quadrature, no samples" or its sample counts and seed.
std::string reference_words(const Experiment& e);

/// At most `digits` significant digits, a true minus, ∞ and "not a number" in words; powers of ten set as such.
std::string number(double v, int digits = 4);
/// Exactly `digits` significant digits, trailing zeros kept, so that columns of a table align; 0 is "0", and what has
/// more digits before the point keeps them up to 10^7.
std::string figure(double v, int digits = 4);
/// 12345678 -> "12 345 678" with thin spaces.
std::string count(std::uint64_t v);

/// The parts with `between` between them.
std::string joined(const std::vector<std::string>& parts, std::string_view between);

inline constexpr const char* radiance_unit = "W·sr<sup>−1</sup>·m<sup>−2</sup>";

}  // namespace crescent::plates
