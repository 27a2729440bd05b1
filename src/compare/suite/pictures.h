// The pictures of a view in the report: photographs of the means of both sides and a map of their relative difference.
#pragma once

#include "compare/suite/suite.h"

namespace crescent::inline comparison {

/// Of a view with renders of one side only.
void picture_one_side(const Suite& suite, const SuiteView& view, const RenderSource& source, ViewResult& out);
/// Of a view with both. The size follows from the number of views, larger if the view may have changed.
void picture_both_sides(const Suite& suite, const RenderStats& all, const BiasResult& means, ViewResult& out);

}  // namespace crescent::inline comparison
