// Channels of the weight that are taken for one another.
#include <array>
#include <cmath>

#include "verdicts/diagnosis.h"

namespace crescent::inline verdicts {

namespace {

using Channels = std::array<double, 3>;

struct Exchange {
    const char* name;
    Channels (*of)(const Channels&);
};

Channels grey(const Channels& c) {
    const double y = luminance({c[0], c[1], c[2]});
    return {y, y, y};
}

constexpr Exchange exchanges[] = {
    {"channels 1 and 3 exchanged", [](const Channels& c) { return Channels{c[2], c[1], c[0]}; }},
    {"channels 1 and 2 exchanged", [](const Channels& c) { return Channels{c[1], c[0], c[2]}; }},
    {"channels 2 and 3 exchanged", [](const Channels& c) { return Channels{c[0], c[2], c[1]}; }},
    {"channels moved by one", [](const Channels& c) { return Channels{c[1], c[2], c[0]}; }},
    {"channels moved by two", [](const Channels& c) { return Channels{c[2], c[0], c[1]}; }},
    {"luminance in every channel", grey}};

bool alike(const Channels& a, const Channels& b) {
    for (std::size_t c = 0; c < 3; ++c)
        if (!(std::fabs(a[c] - b[c]) <= 2e-3 * std::max(std::fabs(a[c]), std::fabs(b[c])))) return false;
    return true;
}

}  // namespace

std::optional<Diagnosis> exchanged_channels(const TrialContext& work, const SampleBatch& b, std::size_t most) {
    if (work.traits.channels != 3 || b.f_channels.size() != b.draws.size()) return {};
    std::array<std::size_t, std::size(exchanges)> same{};
    std::size_t tried = 0, plain = 0;
    for (std::size_t i = 0; i < std::min(most, b.draws.size()); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0) || !d.weight || !work.counts(d.wi)) continue;
        const Vec3d f = b.f_channels[i] * (std::fabs(d.wi.z) / d.pdf);
        const Channels due = {f.x, f.y, f.z}, said = {d.weights.x, d.weights.y, d.weights.z};
        ++tried;
        plain += alike(said, due);
        for (std::size_t k = 0; k < same.size(); ++k) same[k] += alike(said, exchanges[k].of(due));
    }
    if (tried < 100 || 2 * plain > tried) return {};
    for (std::size_t k = 0; k < same.size(); ++k)
        if (10 * same[k] >= 9 * tried)
            return Diagnosis{exchanges[k].name, 1, static_cast<double>(same[k]) / static_cast<double>(tried),
                std::string("the weight is f cos / p with ") + exchanges[k].name, {}};
    return {};
}

}  // namespace crescent::inline verdicts
