// The pictures of a view in the report: photographs of the means of both sides and a map of their relative difference.
#pragma once

#include "compare/renders.h"
#include "compare/results.h"
#include "compare/suite/suite.h"

namespace crescent {

/// For a view with renders of one side only.
void picture_one_side(const Suite& suite, const SuiteView& view, const RenderSource& source, ViewResult& out);
/// For a view with both. The size follows from the number of views, larger if the view may have changed.
void picture_both_sides(const Suite& suite, const RenderStats& stats, const BiasResult& means, ViewResult& out);
/// Adds the tiles in which the variance of the candidate differs from that of the baseline, if there are any. After the
/// other pictures, whose size it has.
void picture_noise(const RenderStats& stats, const NoiseResult& noise, ViewResult& out);

}  // namespace crescent
