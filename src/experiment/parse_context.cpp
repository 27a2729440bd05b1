// Mistakes found so far, each under the path of the value that it spoils.
#include "experiment/parse_context.h"

namespace crescent::inline experiment {

void ParseContext::report(const std::string& path, const SourceLocation& at, const std::string& message) {
    diagnostics.push_back({at, message});
    invalid_paths.insert(path);
}

void ParseContext::report(const std::string& path, const std::string& message) {
    report(path, e.place_of(path), message);
}

}  // namespace crescent::inline experiment
