// Channels by the names that renderers use: pbrt-v4's RelativeVariance layer, Mitsuba's m2_ moments, layers that
// end in variance, error or stddev, channels with sample counts. The deviations of R, G and B of a pixel are added, not
// their squares, because R, G and B of one sample are correlated.
#include "compare/exr_extra.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "base/errors.h"
#include "images/exr_layers.h"

namespace crescent {

namespace {

/// Returns the number in an attribute: an int, a float, or text such as "12.5" or "01:02.50" (minutes and seconds, with
/// hours before them).
std::optional<double> number_of(const ExrAttribute& attribute) {
    if (attribute.number) return attribute.number;
    double total = 0;
    std::string_view text = attribute.text;
    while (true) {
        double piece = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), piece);
        if (error == std::errc::result_out_of_range) piece = HUGE_VAL;
        else if (error != std::errc{}) return {};
        total = 60 * total + piece;
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (text.empty() || text == "s") return total;
        if (text.front() != ':') return {};
        text.remove_prefix(1);
    }
}

/// Returns the channel of Y, or those of R, G and B.
std::vector<std::string> of_light(const ColourChannels& colours) {
    if (const auto y = colours.find("y"); y != colours.end()) return {y->second};
    if (colours.contains("r") && colours.contains("g") && colours.contains("b"))
        return {colours.at("r"), colours.at("g"), colours.at("b")};
    return {};
}

bool counts_samples(std::string name) {
    std::erase_if(name, [](char c) { return c == ' ' || c == '_'; });
    return name == "samples" || name == "samplecount" || name == "debugsamplecount" || name == "nsamples";
}

std::string samples_in(const std::string& layer, const ColourChannels& colours) {
    if (layer.empty()) {
        for (const auto& [name, channel] : colours)
            if (counts_samples(name)) return channel;
        return {};
    }
    return counts_samples(last_name(layer)) ? colours.begin()->second : "";
}

}  // namespace

ExrExtra exr_extra(const ExrPart& part) {
    const auto layers = exr_channels(part);
    ExrExtra out;
    const bool pbrt = layers.contains("RelativeVariance");
    for (const auto& [layer, colours] : layers) {
        const std::string name = last_name(layer.empty() ? part.name : layer);
        if (const std::string samples = samples_in(layer, colours); !samples.empty()) out.samples = samples;
        using Kind = ExrExtra::Kind;
        Kind kind = Kind::none;
        if (name == "variance" || name == "var" || name.ends_with("_variance"))
            kind = pbrt ? Kind::of_samples : Kind::variance;
        if (name == "error" || name == "stddev") kind = Kind::error;
        if (kind != Kind::none && !of_light(colours).empty()) {
            out.kind = kind;
            out.spread = of_light(colours);
        }
        const auto mean = layer.starts_with("m2_") ? layers.find(layer.substr(3)) : layers.end();
        if (mean != layers.end() && mean->second.contains("y") && colours.contains("y")) {
            out.kind = Kind::moments;
            out.spread = {colours.at("y"), mean->second.at("y")};
        }
    }
    return out;
}

void set_variance(Render& out, const ExrExtra& extra, const std::vector<std::vector<float>>& planes) {
    using Kind = ExrExtra::Kind;
    if (extra.kind == Kind::none) return;
    out.variance.resize(out.size());
    out.per_sample = extra.kind == Kind::of_samples || extra.kind == Kind::moments;
    out.variance_channels = fmt::format("{}", fmt::join(extra.spread, ", "));
    for (std::size_t i = 0; i < out.size(); ++i) {
        double deviation = 0;  // R, G and B of one sample are correlated: an upper bound is the sum
        for (std::size_t c = 0; c < planes.size() && extra.kind != Kind::moments; ++c) {
            const double x = std::max(0.0, static_cast<double>(planes[c][i]));
            deviation += (planes.size() == 3 ? out.weights[c] : 1) * (extra.kind == Kind::error ? x : std::sqrt(x));
        }
        double variance = deviation * deviation;
        if (extra.kind == Kind::moments) {
            const double mean = static_cast<double>(planes[1][i]);
            variance = std::max(0.0, static_cast<double>(planes[0][i]) - mean * mean);
        }
        out.variance[i] = static_cast<float>(variance);
    }
}

void set_samples(Render& out, const ExrExtra& extra, const std::vector<float>& plane) {
    double sum = 0, greatest = 0;
    for (const float n : plane) {
        if (!std::isfinite(n) || n < 0)
            throw InputError({out.file, 0, 0},
                fmt::format("channel '{}': expected samples a pixel, 0 or more, found {}", extra.samples, n));
        sum += static_cast<double>(n);
        greatest = std::max(greatest, static_cast<double>(n));
    }
    if (!(greatest > 1)) return;
    out.sample_channel = extra.samples;
    if (!out.spp) out.spp = sum / static_cast<double>(plane.size());
}

std::optional<double> exr_attribute(
    const std::string& path, const ExrPart& part, const char* what, std::initializer_list<const char*> names) {
    for (const ExrAttribute& a : part.attributes) {
        std::string name = last_name(a.name);
        std::erase_if(name, [](char c) { return c == '_' || c == ' ' || c == '-'; });
        if (std::none_of(names.begin(), names.end(), [&](const char* word) { return name == word; })) continue;
        const std::optional<double> value = number_of(a);
        if (value && !(std::isfinite(*value) && *value >= 0))
            throw InputError({path, 0, 0},
                fmt::format("attribute '{}': expected {}, a finite number above 0, found {}", a.name, what, *value));
        if (value && *value > 0) return value;
    }
    return {};
}

}  // namespace crescent
