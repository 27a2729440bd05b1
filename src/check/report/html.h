// The figures of the HTML page, each with its axes: maps of bins, and polar plots of p and f L cos.
#pragma once

#include <string>
#include <vector>

#include "check/verdict.h"

namespace crescent::inline results {

/// Observed, expected and standardised difference, painted by the script of the page; the worst bin has a frame. For an
/// implied density there is one map.
std::string map_figures(const BinHistogram& map);
/// "" if there is no p.
std::string rose_figure(const WeightHistogram& weights);
/// The table of the density that the draws imply, by rings about n; "" for any other verdict.
std::string implied_html(const Verdict& verdict);

}  // namespace crescent::inline results
