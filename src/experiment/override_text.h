// The two parts of "path=value", as --set accepts it.
#pragma once

#include <string_view>

namespace crescent::inline experiment {

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

}  // namespace crescent::inline experiment
