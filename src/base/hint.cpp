// The nearest word is that of nearest(); a word of more than 64 characters is near to none.
#include "base/hint.h"

#include "base/errors.h"
#include "base/text.h"

namespace crescent::inline base {

std::string did_you_mean(std::string_view word, const std::vector<std::string>& valid) {
    const std::string near = word.size() > 64 ? "" : nearest(word, valid);
    return near.empty() || near == word ? "" : "; did you mean '" + near + "'?";
}

std::string expected_one_of(const std::vector<std::string>& valid, std::string_view word) {
    std::string all;
    for (const std::string& one : valid) all += (all.empty() ? "" : ", ") + one;
    return "expected one of " + all + ", not '" + printable(std::string(word)) + "'" + did_you_mean(word, valid);
}

}  // namespace crescent::inline base
