// The figures of the HTML page, each with its axes: maps of bins, roses of p over f L cos.
#pragma once

#include <string>
#include <vector>

#include "check/verdict.h"

namespace crescent::inline results {

/// Observed, expected and standardised difference, painted by the page's script; the worst bin has a frame. Of an
/// implied density one map.
std::string map_figures(const BinHistogram& map);
/// Nothing where there is no p.
std::string rose_figure(const WeightHistogram& weights);
/// The table of the density that the draws imply, by rings about n; "" of any other verdict.
std::string implied_html(const Verdict& verdict);

}  // namespace crescent::inline results
