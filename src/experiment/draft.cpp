// Mistakes found so far, each under the path of the value that it spoils.
#include "experiment/draft.h"

namespace crescent {

void Draft::complain(const std::string& path, const Place& at, const std::string& say) {
    complaints.push_back({at, say});
    broken.insert(path);
}

void Draft::complain(const std::string& path, const std::string& say) { complain(path, e.place_of(path), say); }

}  // namespace crescent
