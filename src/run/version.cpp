// Version, commit and compiler, passed by cmake/provenance.cmake; commit.h is regenerated at every build.
#include "run/version.h"

#include <commit.h>

namespace crescent {

std::string version() { return CRESCENT_VERSION; }
std::string commit() { return CRESCENT_COMMIT; }
std::string compiler() { return CRESCENT_COMPILER; }

}  // namespace crescent
