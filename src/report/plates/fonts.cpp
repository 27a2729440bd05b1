#include "report/plates/fonts.h"

#include <cstdlib>
#include <string>

#include "base/machine.h"

namespace crescent::plates {

void use_fonts_beside_program() {
    static const bool once = [] {
        const std::string config = shared_file("fonts/fonts.conf");
        return !config.empty() && ::setenv("FONTCONFIG_FILE", config.c_str(), 0) == 0;
    }();
    static_cast<void>(once);
}

}  // namespace crescent::plates
