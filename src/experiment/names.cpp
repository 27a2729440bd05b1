// Where films go.
#include "experiment/names.h"

#include <fmt/format.h>

namespace crescent::inline experiment {

std::string film_file(std::string_view arm, double s, double own_s) {
    return s == own_s ? std::string(arm) : fmt::format("{}-s{}", arm, s);
}

}  // namespace crescent::inline experiment
