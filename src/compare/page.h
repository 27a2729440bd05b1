// A comparison as one page.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "output/format.h"

namespace crescent {

/// One page that works offline, of compare_result_json() or of the file that it was stored in; `plates` are PNG bytes
/// by name. Throws StoredJsonError if the result is something else.
std::string compare_html(const Json& result, const std::map<std::string, std::vector<unsigned char>>& plates);

}  // namespace crescent
