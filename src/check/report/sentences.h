// What a finding says: what was found, how large with its 95 % interval, where.
#pragma once

#include <string>

#include "check/decide/check_at.h"

namespace crescent::check {

std::string sentence_of(const CheckAt& at, const Finding& finding);
std::string sentence_of(const SmallFault& fault, int numbers);
/// What a right verdict measured; "" of one that says it elsewhere.
std::string sentence_of_right(const CheckAt& at, std::string_view verdict);

}  // namespace crescent::check
