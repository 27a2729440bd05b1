// Text inside XML and XHTML-compatible HTML.
#pragma once

#include <string>
#include <string_view>

namespace crescent {

/// & < > " ' as references; control characters that XML 1.0 forbids, and broken UTF-8, as U+FFFD.
std::string escape(std::string_view text);

}  // namespace crescent
