// Three bytes make 24 bits and four digits; one or two left over make two or three digits, and "=" fills up.
#include "pages/base64.h"

#include <algorithm>
#include <cstdint>

namespace crescent::inline pages {

std::string base64(const std::vector<unsigned char>& bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out((bytes.size() + 2) / 3 * 4, '=');
    char* to = out.data();
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
        const unsigned word = bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
        for (std::size_t k = 0; k <= left; ++k) to[k] = digits[word >> (18 - 6 * k) & 63];
        to += 4;
    }
    return out;
}

}  // namespace crescent::inline pages
