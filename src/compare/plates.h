// Pictures of a comparison, by file name without .png.
#pragma once

#include <functional>
#include <map>

#include "compare/results.h"
#include "report/plates/plates.h"
#include "report/plates/raster.h"
#include "report/plates/sheet.h"

namespace crescent::plates {

// ---- What the plates of a comparison are put together from: header and caption, blocks of pixels, colour bars.

inline constexpr double bar_room = 116;

/// The header of a sheet; finish() sets caption and footer.
void header(Canvas& c, bool backend, const std::string& label);
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

namespace crescent::inline comparison {

/// renders, errors, ladders, bias-A-B, noise-A-B: those that there is something to show for. Throws OutputError without
/// the font.
std::map<std::string, Picture> compare_plates(
    const ComparePlan& plan, const RenderStats& all, const CompareResult& result);

struct BiasPair;
/// Signed difference of two means, tiles and pixels in which it is told, and the ratio of two variances.
Picture difference_plate(const BiasPair& sides, const std::string& a, const std::string& b, Theme theme);
Picture bias_plate(const BiasPair& sides, const BiasResult& found, Theme theme);
Picture noise_plate(const RenderStats& all, const NoiseResult& noise, Theme theme);
/// Needs a ladder.
Picture ladders_plate(const CompareResult& result, Theme theme);
std::string ladders_svg(const CompareResult& result, Theme theme);

}  // namespace crescent::inline comparison
