// What the plates of a comparison are put together from: header and caption, blocks of pixels, colour bars.
#pragma once

#include <functional>

#include "compare/results.h"
#include "plates/raster.h"
#include "plates/style.h"

namespace crescent::plates {

inline constexpr double bar_room = 116;

/// The header of a sheet; finish() sets caption and footer.
void header(Canvas& c, bool instrument, const std::string& label);
void finish(Canvas& c, const std::string& caption, const std::string& note);
/// The same, and what was drawn.
Picture finished(Canvas& c, const std::string& caption, const std::string& note);

/// Blue below, orange above, towards the ground in the middle; t in [-1, 1], NaN: the ground.
Srgb8 diverging(double t, Theme theme);

/// value(x, y) of the box through diverging(); where it is reduced, means of what a pixel covers.
Block diverging_block(const Box& box, const Fit& fit, Theme theme, const std::function<double(int, int)>& value);
/// colour(x, y) of the box, the nearest pixel's.
Block nearest_block(const Box& box, const Fit& fit, const std::function<Srgb8(int, int)>& colour);

/// Painted at the top of the slot, in its middle, with a frame; where it came to stand.
Rect framed(Canvas& c, const Block& block, const Rect& slot);

using Ticks = std::vector<std::pair<double, std::string>>;  // share of the bar, words
/// A vertical bar of colour(t), t from 0 below to 1 above.
void bar(Canvas& c, const Rect& at, const std::function<Srgb8(double)>& colour, const Ticks& ticks);
/// diverging() over such a bar.
std::function<Srgb8(double)> signed_colours(Theme theme);

}  // namespace crescent::plates
