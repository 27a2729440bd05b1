// A combination of samplers as an experiment declares it: multiple importance sampling, a mixture, or resampled
// importance sampling. render/combination.h estimates with it.
//
//   mis      X = sum_i w_i f L cos / (n_i p_i), sum_i w_i = 1: one sample of each (draw = "every") or of one sampler
//            that is chosen with probability c_i (draw = "one"). Veach & Guibas 1995, "Optimally Combining Sampling
//            Techniques for Monte Carlo Rendering".
//   mixture  one direction, p = sum_i w_i p_i.
//   ris      M candidates, one of them chosen in proportion to target/p. Talbot, Cline & Egbert 2005, "Importance
//            Resampling for Global Illumination".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace crescent {

enum class CombinationKind { mis, mixture, ris };

/// w_i of mis, in proportion to n_i p_i, to its square, or as `weights` say.
enum class MisHeuristic { balance, power };

/// A sample of mis is a direction of every sampler, or of one.
enum class MisDraw { every, one };

struct CombinationPlan {
    std::optional<CombinationKind> kind{};  // none: the arm is no combination
    std::vector<std::string> of{};          // arms, or samplers of samplers/all.h
    std::optional<MisHeuristic> heuristic{};
    std::optional<MisDraw> draw{};
    std::vector<std::string> weights{};           // a formula for each of `of`, see weight_formula.h
    std::optional<std::string> weights_python{};  // of mis: a function of Python in their place, "FILE.py:NAME"
    std::vector<std::string> probabilities{};     // of draw = "one", likewise
    std::vector<std::uint64_t> samples{};         // directions of each in one sample of draw = "every"
    std::optional<std::uint64_t> candidates{};    // of ris
    std::optional<std::string> target{};          // of ris: target_product, target_brdf, an arm or a sampler
};

/// f L cos of the nearest light, without occlusion; f cos.
inline constexpr const char *target_product = "product", *target_brdf = "brdf";

}  // namespace crescent
