// Ground and inks of plates.
#pragma once

namespace crescent::plates {

enum class Theme { dark, light };

}  // namespace crescent::plates

namespace crescent {
using plates::Theme;
}  // namespace crescent
