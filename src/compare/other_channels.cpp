// One channel of both files is in memory at a time.
#include "compare/other_channels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <vector>

#include "compare/renders.h"
#include "images/exr_file.h"

namespace crescent {

namespace {

bool is_exr(const OpenFile& file) {
    char first[4]{};
    return file.read_some(0, first) == 4 && std::memcmp(first, "\x76\x2f\x31\x01", 4) == 0;
}

/// Counts the values with other bits: a NaN equals itself.
std::size_t different_values(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size()) return std::max(a.size(), b.size());
    std::size_t out = 0;
    for (std::size_t i = 0; i < a.size(); ++i) out += std::memcmp(&a[i], &b[i], sizeof(float)) != 0;
    return out;
}

void add_channel(std::string& to, const std::string& name, std::size_t count) {
    constexpr std::size_t longest = 200;
    if (count == 0 || to.size() > longest) return;
    to += fmt::format("{}{} in {} pixel{}", to.empty() ? "" : ", ", name, count, count == 1 ? "" : "s");
}

std::string of_exr(const OpenFile& a, const OpenFile& b) {
    const ExrFile one(a), other(b);
    std::string out;
    for (std::size_t p = 0; p < std::min(one.parts().size(), other.parts().size()); ++p) {
        const ExrPart &first = one.parts()[p], &second = other.parts()[p];
        if (first.deep || second.deep || first.data != second.data) continue;
        for (const ExrChannel& channel : first.channels) {
            const ExrChannel* counterpart = second.channel(channel.name);
            const bool is_full_size = channel.x_sampling == 1 && channel.y_sampling == 1;
            if (!counterpart || !is_full_size || counterpart->x_sampling != 1 || counterpart->y_sampling != 1) continue;
            add_channel(out, channel.name,
                different_values(one.read(first, {channel.name})[0], other.read(second, {channel.name})[0]));
        }
    }
    return out;
}

}  // namespace

std::string differing_channels(const std::string& a, const std::string& b, const ReadingOptions& reading) {
    const OpenFile first(a), second(b);
    if (is_exr(first) && is_exr(second)) return of_exr(first, second);
    if (reading.channels == TestedChannels::rgba && reading.channel.empty()) return "";
    ReadingOptions options = reading;
    options.channel = "A";
    const auto read_alpha = [&](const std::string& path) {
        try {
            return read_render(path, "", options).r;
        } catch (const InputError&) { return std::vector<float>(); }  // it has no alpha
    };
    const std::vector<float> ours = read_alpha(a), theirs = read_alpha(b);
    std::string out;
    if (!ours.empty() && !theirs.empty()) add_channel(out, "A", different_values(ours, theirs));
    return out;
}

}  // namespace crescent
