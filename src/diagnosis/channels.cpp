// Channels of the weight that are taken for one another, or off by factors of their own.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "diagnosis/diagnosis.h"
#include "stats/quantiles.h"

namespace crescent::inline diagnosis {

namespace {

constexpr double close_to = 2e-3;  // relative

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
        if (!(std::fabs(a[c] - b[c]) <= close_to * std::max(std::fabs(a[c]), std::fabs(b[c])))) return false;
    return true;
}

/// Weights with the draws, and f cos / p at them.
struct Weights {
    Channels said, due;
};

std::vector<Weights> weights_of(const TrialContext& work, const SampleBatch& b, std::size_t most) {
    std::vector<Weights> out;
    if (work.traits.channels != 3 || b.f_channels.size() != b.draws.size()) return out;
    for (std::size_t i = 0; i < std::min(most, b.draws.size()); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0) || !d.weight || !work.counts(d.wi)) continue;
        const Vec3d f = b.f_channels[i] * (std::fabs(d.wi.z) / d.pdf);
        out.push_back({{d.weights.x, d.weights.y, d.weights.z}, {f.x, f.y, f.z}});
    }
    return out;
}

/// The factor that one channel's weights have; none where nine of ten do not have it to 0.2 %.
std::optional<double> factor_of(std::span<const Weights> all, std::size_t c) {
    std::vector<double> ratios;
    for (const Weights& w : all)
        if (w.due[c] > 0 && w.said[c] > 0) ratios.push_back(w.said[c] / w.due[c]);
    if (10 * ratios.size() < 9 * all.size()) return {};
    const double factor = median_of(ratios);
    const auto near =
        std::count_if(ratios.begin(), ratios.end(), [&](double r) { return std::fabs(r / factor - 1) <= close_to; });
    return 10 * static_cast<std::size_t>(near) >= 9 * ratios.size() ? std::optional(factor) : std::nullopt;
}

}  // namespace

std::optional<Diagnosis> scaled_channels(const TrialContext& work, const SampleBatch& b, std::size_t most) {
    const std::vector<Weights> all = weights_of(work, b, most);
    if (all.size() < 100) return {};
    Diagnosis out{"", 1, 1, "", {}};
    std::size_t off = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::optional<double> factor = factor_of(all, c);
        if (!factor) return {};
        if (std::fabs(*factor - 1) <= close_to) continue;
        if (off++ > 0 && std::fabs(*factor / out.constant - 1) > close_to) return {};  // more than one fault
        out.constant = *factor;
        out.name += fmt::format("{}{}", out.name.empty() ? "channel " : " and ", c + 1);
    }
    if (off == 0 || off == 3) return {};
    out.means =
        fmt::format("the weight of {} is f cos / p times {}", out.name, factor_text(work, "a constant", out.constant));
    return out;
}

bool channels_differ(const TrialContext& work, const SampleBatch& b, std::size_t most) {
    const std::vector<Weights> all = weights_of(work, b, most);
    const auto differs = [](const Weights& w) {
        const double middle = w.said[1] / w.due[1];
        return w.due[0] > 0 && w.due[1] > 0 && w.due[2] > 0 &&
            !(std::fabs(w.said[0] / w.due[0] - middle) <= close_to * middle &&
                std::fabs(w.said[2] / w.due[2] - middle) <= close_to * middle);
    };
    return 10 * static_cast<std::size_t>(std::count_if(all.begin(), all.end(), differs)) > all.size();
}

std::optional<Diagnosis> exchanged_channels(const TrialContext& work, const SampleBatch& b, std::size_t most) {
    std::array<std::size_t, std::size(exchanges)> same{};
    std::size_t tried = 0, plain = 0;
    for (const auto& [said, due] : weights_of(work, b, most)) {
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

}  // namespace crescent::inline diagnosis
