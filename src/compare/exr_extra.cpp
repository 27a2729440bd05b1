// By the names that renderers give: pbrt-v4's RelativeVariance layer, Mitsuba's m2_ moments, layers that end in
// variance, error or stddev, channels that count samples. Three deviations of one pixel are added, not squared and
// added: R, G and B of one sample rise and fall together.
#include "compare/exr_extra.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "color/rgb.h"
#include "films/film.h"

namespace crescent::inline comparing {

namespace {

/// A number in an attribute: an int, a float, or text such as "12.5" or "01:02.50" (minutes and seconds, hours before).
std::optional<double> number_of(const Imf::Attribute& attribute) {
    if (const auto* a = dynamic_cast<const Imf::IntAttribute*>(&attribute)) return a->value();
    if (const auto* a = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) return static_cast<double>(a->value());
    if (const auto* a = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) return a->value();
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute);
    if (!text) return {};
    double total = 0;
    std::string_view rest = text->value();
    while (true) {
        double piece = 0;
        const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), piece);
        if (error != std::errc{}) return {};
        total = 60 * total + piece;
        rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
        if (rest.empty() || rest == "s") return total;
        if (rest.front() != ':') return {};
        rest.remove_prefix(1);
    }
}

/// "ViewLayer.Variance" -> variance.
std::string last_of(const std::string& layer) {
    const std::string name = lower(layer);
    const std::size_t at = name.find_last_of("./");
    return at == std::string::npos ? name : name.substr(at + 1);
}

using Colours = std::map<std::string, std::string>;

/// Channels of Y or of R, G and B.
std::vector<std::string> of_light(const Colours& colours) {
    if (const auto y = colours.find("y"); y != colours.end()) return {y->second};
    if (colours.contains("r") && colours.contains("g") && colours.contains("b"))
        return {colours.at("r"), colours.at("g"), colours.at("b")};
    return {};
}

bool counts_samples(std::string name) {
    std::erase_if(name, [](char c) { return c == ' ' || c == '_'; });
    return name == "samples" || name == "samplecount" || name == "debugsamplecount" || name == "nsamples";
}

std::string samples_in(const std::string& layer, const Colours& colours) {
    if (layer.empty()) {
        for (const auto& [name, channel] : colours)
            if (counts_samples(name)) return channel;
        return {};
    }
    return counts_samples(last_of(layer)) ? colours.begin()->second : "";
}

}  // namespace

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::map<std::string, std::map<std::string, std::string>> exr_channels(const Imf::Header& header) {
    std::map<std::string, std::map<std::string, std::string>> out;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        const std::string name = c.name();
        const std::size_t dot = name.rfind('.');
        if (dot == std::string::npos) out[""][lower(name)] = name;
        else out[name.substr(0, dot)][lower(name.substr(dot + 1))] = name;
    }
    return out;
}

ExrExtra exr_extra(const Imf::Header& header, const std::string& part) {
    const auto all = exr_channels(header);
    ExrExtra out;
    const bool pbrt = all.contains("RelativeVariance");
    for (const auto& [layer, colours] : all) {
        const std::string name = last_of(layer.empty() ? part : layer);
        if (const std::string samples = samples_in(layer, colours); !samples.empty()) out.samples = samples;
        using Kind = ExrExtra::Kind;
        Kind kind = Kind::none;
        if (name == "variance" || name == "var" || name.ends_with("_variance"))
            kind = pbrt ? Kind::of_samples : Kind::variance;
        if (name == "error" || name == "stddev") kind = Kind::error;
        if (kind != Kind::none && !of_light(colours).empty()) out.kind = kind, out.spread = of_light(colours);
        const auto mean = layer.starts_with("m2_") ? all.find(layer.substr(3)) : all.end();
        if (mean != all.end() && mean->second.contains("y") && colours.contains("y"))
            out.kind = Kind::moments, out.spread = {colours.at("y"), mean->second.at("y")};
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
        double deviation =
            0;  // R, G and B of one sample rise and fall together: their deviations add, never too little
        for (std::size_t c = 0; c < planes.size() && extra.kind != Kind::moments; ++c) {
            const double x = std::max(0.0, static_cast<double>(planes[c][i]));
            deviation +=
                (planes.size() == 3 ? luminance_weights[c] : 1) * (extra.kind == Kind::error ? x : std::sqrt(x));
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
    double sum = 0, most = 0;
    for (const float n : plane) sum += static_cast<double>(n), most = std::max(most, static_cast<double>(n));
    if (!(most > 1)) return;
    out.sample_channel = extra.samples;
    if (!out.spp) out.spp = sum / static_cast<double>(plane.size());
}

std::optional<double> exr_attribute(const Imf::Header& header, std::initializer_list<const char*> names) {
    for (auto a = header.begin(); a != header.end(); ++a) {
        std::string name = lower(a.name());
        name = name.substr(std::min(name.find_last_of("./") + 1, name.size()));
        std::erase_if(name, [](char c) { return c == '_' || c == ' ' || c == '-'; });
        for (const char* word : names)
            if (name == word)
                if (const auto value = number_of(a.attribute()); value && *value > 0) return value;
    }
    return {};
}

}  // namespace crescent::inline comparing
