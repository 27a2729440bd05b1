// Axes of charts, whatever draws them (SVG in pages, Cairo on plates and in the film): what they span, where their
// ticks are, where a value lies, and how names beside a chart are kept apart. No lengths in pixels but those of the
// caller.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

namespace crescent::inline pages {

/// What an axis spans, and where its ticks are.
struct Axis {
    double low = 0, high = 1;  // data at the two ends
    bool log = false;
    std::string label = {};  // plain text
    std::vector<double> ticks = {};

    /// Where x lies on the axis: 0 at low, 1 at high; what a log axis cannot hold, at low.
    double share(double x) const;
    /// Whether x has a place: it is finite, and above 0 on a log axis.
    bool can_hold(double x) const;
};

/// An axis that holds all values and ends at ticks a round step apart. Values that are not finite are passed over;
/// values that are all alike still get an axis of some length.
Axis linear_axis(std::string label, const std::vector<double>& values);
/// A logarithmic axis from the least value / `wider` to the largest x `wider`; only positive finite values count.
Axis log_axis(std::string label, const std::vector<double>& values, double wider = 1.25);

/// Round numbers from `low` to `high`, both above 0: the more decades they span, the fewer a decade. At least one where
/// high / low is 1.4 or more.
std::vector<double> log_ticks(double low, double high);

/// The smallest of `leads` times a power of ten that is `least` (above 0) or more. Leads rise from 1 to below 10.
double round_up(double least, std::initializer_list<double> leads = {1, 2, 5});

/// Places of names along a side, in the order given: pushed up to be `pitch` apart and from `first` on, then down so
/// that none is above `last`.
std::vector<double> moved_apart(const std::vector<double>& places, double pitch, double first, double last);

}  // namespace crescent::inline pages
