// Bytes as text in a data: address.
#pragma once

#include <string>
#include <vector>

namespace crescent::inline pages {

/// RFC 4648, section 4, with padding.
std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace crescent::inline pages
