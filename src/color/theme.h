// The two grounds that plates are drawn on.
#pragma once

namespace crescent::inline color {

/// Ground and inks of plates: light ink on a dark ground, or dark on paper.
enum class Theme { dark, light };

}  // namespace crescent::inline color
