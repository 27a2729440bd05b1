// What is said of a word that is none of those that are known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace crescent::inline base {

/// "; did you mean 'phong'?" for the word of `valid` that is nearest; "" where none is near, or `word` is one of them.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& valid);

/// "expected one of uniform, cosine, phong, not 'phonk'; did you mean 'phong'?"; control characters are taken out of
/// `word`.
std::string expected_one_of(const std::vector<std::string>& valid, std::string_view word);

}  // namespace crescent::inline base
