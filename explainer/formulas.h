// The formulas of the film. Their digits are mathematics; no result stands here.
#pragma once

#include "words.h"

namespace crescent::film::formulas {

inline constexpr Formula sum{"(1/N) Σ"};
inline constexpr Formula f{"f(ω)"};
inline constexpr Formula light{"L(ω)"};
inline constexpr Formula cosine{"cos θ"};
inline constexpr Formula density{"p(ω)"};
inline constexpr Formula uniform_density{"p = 1/(2π)"};
inline constexpr Formula cosine_density{"p = cos θ / π"};
inline constexpr Formula phong_density{"p = (s+1)/(2π) · (ω·R)<sup>s</sup>"};
inline constexpr Formula tail_index{"k = (s−1)/(s+1)"};
inline constexpr Formula tail_slope{"−1/k"};
inline constexpr Formula lost_support{"(1 − cos θ)/2"};
inline constexpr Formula half{"1/2"};
inline constexpr Formula one{"1"};
inline constexpr Formula radiance_unit{"W·sr<sup>−1</sup>·m<sup>−2</sup>"};
inline constexpr Formula one_over_density{"1/p"};
inline constexpr Formula one_over_n{"1/n"};
inline constexpr Formula first_random{"u<sub>1</sub>"};
inline constexpr Formula second_random{"u<sub>2</sub>"};
inline constexpr Formula root_n{"1/√N"};

}  // namespace crescent::film::formulas
