// Version, commit and compiler; cmake/provenance.cmake passes them in.
#include "version.h"

namespace crescent {

std::string version() { return CRESCENT_VERSION; }
std::string commit() { return CRESCENT_COMMIT; }
std::string compiler() { return CRESCENT_COMPILER; }

}  // namespace crescent
