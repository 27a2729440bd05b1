// What stands at the end of a judgement's table: the density that draws without pdf(w) imply, and what was not looked
// at.
#pragma once

#include <string>

#include "judgements/verdict.h"

namespace crescent::inline judgements {

/// A line a w_o of the samplers without pdf(w): the implied density in the mean over rings about n, 1/sr, each with its
/// standard error, and where it is highest; "" where every sampler has one.
std::string implied_told(const Judgement& judgement);
/// "Not looked at: reciprocity across the surface, since the index was not told (eta=)."; "" where nothing was left.
std::string not_looked_at_told(const Judgement& judgement);

}  // namespace crescent::inline judgements
