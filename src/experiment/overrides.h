// Values that --set replaces: "path=value".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/parser.h"
#include "experiment/tree.h"

namespace crescent {

/// Puts "path=value" overrides into the tree.
void apply_overrides(ParseContext& context, Node& root, const std::vector<std::string>& overrides);
/// Returns the text of a file with these overrides as a file of its own. A value that is not given stays so: another
/// key may decide it.
std::string text_with_overrides(
    std::string_view text, const std::string& name, const std::vector<std::string>& overrides);

/// Returns where the path ends: at the first '=' outside quotes; npos if there is none.
inline std::size_t end_of_path(std::string_view override_text) {
    char quote = 0;
    for (std::size_t i = 0; i < override_text.size(); ++i) {
        const char c = override_text[i];
        if (quote) quote = c == quote ? '\0' : quote;
        else if (c == '"' || c == '\'') quote = c;
        else if (c == '=') return i;
    }
    return std::string_view::npos;
}

}  // namespace crescent
