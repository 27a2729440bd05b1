// Pictures of a comparison, by file name without .png, and the parts that they share.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/results.h"
#include "output/tone_map.h"
#include "report/plates/canvas.h"
#include "report/plates/plates.h"
#include "report/plates/raster.h"
#include "scene/scene_data.h"

namespace crescent::plates {

// ---- Parts of the plates of a comparison: header and caption, blocks of pixels, colour bars.

inline constexpr double bar_room = 116;

/// The header of a sheet; finish() sets caption and footer.
void header(Canvas& c, bool backend, const std::string& label);
void finish(Canvas& c, const std::string& caption, const std::string& note);
/// The same; returns the picture.
Picture finished(Canvas& c, const std::string& caption, const std::string& note);

/// Blue for t < 0, orange for t > 0, grey in the middle; t in [-1, 1]. NaN: the ground, which is another grey.
Srgb8 diverging(double t, Theme theme);

/// Draws value(x, y) of the box through diverging(); if it is reduced, the mean over the pixels of each cell.
Block diverging_block(const Box& box, const Fit& fit, Theme theme, const std::function<double(int, int)>& value);
/// Draws colour(x, y) of the nearest pixel of the box.
Block nearest_block(const Box& box, const Fit& fit, const std::function<Srgb8(int, int)>& colour);

/// Paints the block at the top centre of the slot, with a frame, and returns its place.
Rect framed(Canvas& c, const Block& block, const Rect& slot);

using Ticks = std::vector<std::pair<double, std::string>>;  // share of the bar, label
/// Draws a vertical bar of colour(t), t from 0 at the bottom to 1 at the top.
void bar(Canvas& c, const Rect& rect, const std::function<Srgb8(double)>& colour, const Ticks& ticks);
/// Returns diverging() as colours of a bar.
std::function<Srgb8(double)> signed_colours(Theme theme);

}  // namespace crescent::plates

namespace crescent {

/// Returns the plates renders, errors, ladders, bias-A-B and noise-A-B that have data. Throws OutputError without the
/// font.
std::map<std::string, Picture> compare_plates(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result);

struct BiasPair;
/// The signed difference of two means; the tiles and pixels in which it is significant; the ratio of two variances.
Picture difference_plate(const BiasPair& sides, const std::string& a, const std::string& b, Theme theme);
Picture bias_plate(const BiasPair& sides, const BiasResult& bias, Theme theme);
Picture noise_plate(const RenderStats& stats, const NoiseResult& noise, Theme theme);
/// Requires a ladder.
Picture ladders_plate(const CompareResult& result, Theme theme);
std::string ladders_svg(const CompareResult& result, Theme theme);

}  // namespace crescent
