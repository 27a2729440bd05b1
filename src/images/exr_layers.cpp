// A layer is the part of a channel's name before the last '.', '/' or ':' (OpenEXR's own rule has only '.').
#include "images/exr_layers.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <set>

#include "base/errors.h"
#include "base/text.h"

namespace crescent {

namespace {

using Kind = ExrLayer::Kind;

/// "[Red]" -> r; "" if it is not a colour.
std::string colour_of(const std::string& word) {
    std::string name = lower(word);
    std::erase_if(name, [](char c) { return c == '[' || c == ']' || c == '(' || c == ')' || c == ' '; });
    static const std::map<std::string, std::string> words = {{"r", "r"}, {"red", "r"}, {"g", "g"}, {"green", "g"},
        {"b", "b"}, {"blue", "b"}, {"y", "y"}, {"ry", "ry"}, {"by", "by"}, {"x", "x"}, {"z", "z"}};
    const auto entry = words.find(name);
    return entry == words.end() ? "" : entry->second;
}

/// "Combined.R" -> Combined, r; a name that is not a colour is kept in lower case.
std::pair<std::string, std::string> layer_and_colour(const std::string& channel) {
    std::size_t separator = channel.find_last_of("./:");
    if (const std::size_t line = channel.rfind('_');
        separator == std::string::npos && line != std::string::npos && !colour_of(channel.substr(line + 1)).empty())
        separator = line;
    const std::string word = separator == std::string::npos ? channel : channel.substr(separator + 1),
                      colour = colour_of(word);
    return {separator == std::string::npos ? "" : channel.substr(0, separator), colour.empty() ? lower(word) : colour};
}

/// Returns two channels of the layer's part for the same colour, if the layer uses one without OpenEXR's own name.
std::pair<std::string, std::string> doubled(const ExrPart& part, const ExrLayer& layer) {
    for (const std::string& name : layer.channels) {
        const auto [prefix, colour] = layer_and_colour(name);
        std::string upper = colour;
        for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        if (name.ends_with(upper)) continue;
        for (const ExrChannel& other : part.channels)
            if (other.name != name && layer_and_colour(other.name) == std::pair{prefix, colour})
                return {name, other.name};
    }
    return {};
}

std::string joined(const std::string& part, const std::string& layer) {
    return part.empty() || layer.empty() ? part + layer : part + "/" + layer;
}

/// Returns whether the name is that of data of a back end or of a mask, not of radiance.
bool is_data(const std::string& layer) {
    static constexpr const char* words[] = {"crypto", "normal", "depth", "position", "variance", "motion", "vector",
        "uv", "albedo", "error", "second_moment", "largest", "horizon", "hits", "stddev", "samplecount", "denois"};
    const std::string name = lower(layer);
    return std::any_of(
        std::begin(words), std::end(words), [&](const char* word) { return name.find(word) != std::string::npos; });
}

/// Returns whether renderers use this name for the beauty.
bool is_usual(const std::string& layer) {
    static const std::set<std::string> usual = {
        "", "rgba", "rgb", "beauty", "combined", "color", "colour", "default", "composite", "c", "ci"};
    return usual.contains(last_name(layer));
}

/// Returns whether x, y and z of a layer are a colour; more often they are a position or a direction.
bool is_xyz_colour(const std::string& layer) {
    const std::string name = last_name(layer);
    return is_usual(layer) || name == "xyz" || name == "ciexyz" || name == "cie_xyz";
}

void add_layers(std::vector<ExrLayer>& out, const ExrPart& part, bool is_only_part) {
    const std::string part_name = is_only_part ? "" : part.name;
    for (const auto& [prefix, colours] : exr_channels(part)) {
        ExrLayer layer{Kind::rgb, part.index, joined(part_name, prefix), joined(part.name, prefix), prefix, {}, true};
        const auto find_channels = [&](std::initializer_list<const char*> names) {
            std::vector<std::string> channels;
            for (const char* name : names)
                if (const auto entry = colours.find(name); entry != colours.end()) channels.push_back(entry->second);
            return channels.size() == names.size() ? channels : std::vector<std::string>{};
        };
        layer.radiance = !is_data(prefix) && !(prefix.empty() && is_data(part_name));
        if (layer.channels = find_channels({"r", "g", "b"}); !layer.channels.empty()) {
        } else if (layer.channels = find_channels({"x", "y", "z"}); !layer.channels.empty()) {
            layer.kind = Kind::xyz;
            layer.radiance = layer.radiance && is_xyz_colour(layer.name);
        } else if (layer.channels = find_channels({"y", "ry", "by"}); !layer.channels.empty()) {
            layer.kind = Kind::luminance_chroma;
        } else if (layer.channels = find_channels({"y"}); !layer.channels.empty()) {
            layer.kind = Kind::grey;
            const bool vector = colours.contains("x") || (colours.contains("z") && !is_usual(layer.name));
            layer.radiance = layer.radiance && !vector && !colours.contains("ry") && !colours.contains("by") &&
                lower(prefix) != "luminance";
        }
        if (!layer.channels.empty()) out.push_back(std::move(layer));
    }
}

/// The layers of all parts that are not deep.
std::vector<ExrLayer> layers_of(const ExrFile& file) {
    std::vector<ExrLayer> out;
    for (const ExrPart& part : file.parts())
        if (!part.deep) add_layers(out, part, file.parts().size() == 1);
    return out;
}

std::string names_of(const std::vector<ExrLayer>& layers) {
    std::vector<std::string> names;
    for (const ExrLayer& layer : layers)
        if (layer.radiance)
            names.push_back(layer.name.empty() ? "(channels without a layer)" : fmt::format("'{}'", layer.name));
    return fmt::format("{}", fmt::join(names, ", "));
}

std::string channels_found(const ExrFile& file) {
    constexpr std::size_t limit = 40;
    std::vector<std::string> names;
    for (const ExrPart& part : file.parts())
        for (const ExrChannel& c : part.channels)
            names.push_back(printable(file.parts().size() > 1 ? joined(part.name, c.name) : c.name, 80));
    const std::size_t total = names.size();
    names.resize(std::min(total, limit));
    return fmt::format("{}{}", fmt::join(names, ", "), total > limit ? fmt::format(" and {} more", total - limit) : "");
}

/// Returns the beauty: the channels without a layer, else the only layer, else the only one with a usual name; null if
/// it is ambiguous.
const ExrLayer* beauty(const std::vector<ExrLayer>& layers) {
    std::vector<const ExrLayer*> candidates, usual;
    for (const ExrLayer& layer : layers) {
        if (!layer.radiance) continue;
        if (layer.name.empty()) return &layer;
        candidates.push_back(&layer);
        if (is_usual(layer.name)) usual.push_back(&layer);
    }
    if (candidates.size() == 1) return candidates[0];
    return usual.size() == 1 ? usual[0] : nullptr;
}

}  // namespace

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string last_name(const std::string& layer) {
    const std::string name = lower(layer);
    const std::size_t separator = name.find_last_of("./:");
    return separator == std::string::npos ? name : name.substr(separator + 1);
}

std::map<std::string, ColourChannels> exr_channels(const ExrPart& part) {
    std::map<std::string, ColourChannels> out;
    for (const ExrChannel& channel :
        part.channels) {  // of "R" and "red" in one layer the first is kept, capitals first
        const auto [layer, colour] = layer_and_colour(channel.name);
        out[layer].emplace(colour, channel.name);
    }
    return out;
}

ExrLayer chosen_layer(const ExrFile& file, const std::string& path, const std::string& name) {
    const std::vector<ExrLayer> layers = layers_of(file);
    const bool is_deep = std::ranges::any_of(file.parts(), &ExrPart::deep);
    const auto fail = [&](const std::string& why) {
        throw LayerError({path, 0, 0}, fmt::format("{}; channels found: {}", why, channels_found(file)));
    };
    if (is_deep && layers.empty()) fail("deep images are not supported: expected an image of one colour a pixel");
    const auto take = [&](const ExrLayer& layer) {
        const auto [one, other] = doubled(file.parts()[static_cast<std::size_t>(layer.part)], layer);
        if (!one.empty()) fail(fmt::format("'{}' and '{}' are the same colour of one layer", one, other));
        return layer;
    };
    if (name.empty()) {
        if (const ExrLayer* layer = beauty(layers)) return take(*layer);
        if (names_of(layers).empty())
            fail("expected channels R, G and B, or Y, or X, Y and Z, found none that hold radiance");
        fail("several layers contain radiance: choose one with --layer: " + names_of(layers));
    }
    std::vector<const ExrLayer*> matches;
    for (const ExrLayer& layer : layers)
        if (layer.name == name || layer.full_name == name) matches.push_back(&layer);
    if (matches.size() == 1) return take(*matches[0]);
    if (matches.size() > 1) fail(fmt::format("{} layers are called '{}'", matches.size(), name));
    std::vector<std::string> names;
    for (const ExrLayer& layer : layers) names.push_back(layer.name);
    fail(fmt::format("no layer '{}': expected one of {}{}", name, names_of(layers), did_you_mean(name, names)));
    return {};
}

ExrLayer layer_of_channel(const ExrFile& file, const std::string& path, const std::string& channel) {
    std::vector<std::string> names;
    for (const ExrPart& part : file.parts()) {
        if (part.deep) continue;
        for (const ExrChannel& entry : part.channels) names.push_back(entry.name);
        if (part.channel(channel)) return {ExrLayer::Kind::grey, part.index, channel, channel, "", {channel}, true};
    }
    throw InputError({path, 0, 0},
        fmt::format(
            "no channel '{}'{}; channels found: {}", channel, did_you_mean(channel, names), channels_found(file)));
}

std::string layers_found(const ExrFile& file) { return names_of(layers_of(file)); }

std::string alpha_of(const ExrPart& part, const ExrLayer& layer) {
    const auto channels = exr_channels(part);
    const auto entry = channels.find(layer.prefix);
    if (entry == channels.end()) return "";
    for (const char* name : {"a", "A", "alpha", "Alpha"})
        if (const auto alpha = entry->second.find(name); alpha != entry->second.end()) return alpha->second;
    return "";
}

}  // namespace crescent
