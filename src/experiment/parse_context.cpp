// Mistakes found so far, each under the path of the value that it spoils.
#include "experiment/parse_context.h"

namespace crescent::inline experiment {

void ParseContext::complain(const std::string& path, const SourceLocation& at, const std::string& say) {
    complaints.push_back({at, say});
    invalid_paths.insert(path);
}

void ParseContext::complain(const std::string& path, const std::string& say) { complain(path, e.place_of(path), say); }

}  // namespace crescent::inline experiment
