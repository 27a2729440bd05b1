// Type and inks of the film, in units of the 1920 x 1080 sheet: no text under 27, which is 9 pixels on a phone at 640 x
// 360.
#pragma once

#include "frame.h"

namespace crescent::film {

using plates::alert;
using plates::bright;
using plates::ground;
using plates::instrument_accent;
using plates::muted;
using plates::panel;
using plates::photograph_accent;
using plates::rule;
using plates::with;
using plates::with_lines;
using plates::with_px;

/// The two regions, told apart from every arm.
inline constexpr Colour highlight_ink = plates::series[3], surround_ink = plates::series[4];

inline constexpr double least_px = 27;
inline constexpr Text big_text{96, bright, Weight::semibold, Align::left, Vertical::top, 1, 40};
inline constexpr Text title_text{40, bright, Weight::semibold, Align::left, Vertical::middle, 1, 30};
inline constexpr Text caption_text{44, bright, Weight::medium, Align::centre, Vertical::middle, 2, 34};
inline constexpr Text label_text{36, bright, Weight::medium, Align::left, Vertical::middle, 1, 28};
inline constexpr Text body_text{32, bright, Weight::regular, Align::left, Vertical::top, 1, least_px};
inline constexpr Text small_text{28, muted, Weight::regular, Align::left, Vertical::middle, 1, least_px};
inline constexpr Text number_text{56, bright, Weight::semibold, Align::centre, Vertical::middle, 1, 34};

}  // namespace crescent::film
