// Finite doubles go in as JSON numbers, others as the words of shortest(); nlohmann::json writes them.
#include "pages/json_number.h"

#include <cmath>

#include "pages/numbers.h"

namespace crescent::inline pages {

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(shortest(x)); }

Json numbers(const std::vector<double>& all) {
    Json out = Json::array();
    for (const double x : all) out.push_back(number(x));
    return out;
}

std::string text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace crescent::inline pages
