// A sampler that the page's user writes in JavaScript: an arm `exec = "page"`, and an adapter for `check`.
#pragma once

#include <memory>
#include <string_view>

#include "api.h"

namespace crescent::web {

/// The value of the key `exec` of an arm that the page answers for.
inline constexpr std::string_view exec_of_page = "page";

/// Draws by the functions of the page, api.user_sample and api.user_pdf; for every experiment.
std::shared_ptr<const SamplerAdapter> page_sampler();

}  // namespace crescent::web
