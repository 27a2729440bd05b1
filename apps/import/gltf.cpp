// glTF 2.0 and GLB (Khronos Group 2021, "glTF 2.0 Specification"): the triangles of the scene, placed by its nodes.
// Every offset, size and index is checked before it is used. Integers as positions are KHR_mesh_quantization.
// Draco: draco.h. EXT_meshopt_compression: meshopt.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "draco.h"
#include "little_endian.h"
#include "meshopt.h"
#include "model.h"

namespace crescent::importer {

namespace {

using Json = nlohmann::json;

/// A place in the file: "meshes[0].primitives[1]".
std::string member_place(const std::string& place, std::string_view key) {
    return place.empty() ? std::string(key) : fmt::format("{}.{}", place, key);
}
std::string element_place(std::string_view list, std::size_t index) { return fmt::format("{}[{}]", list, index); }

[[noreturn]] void fail(const std::string& place, const std::string& message) {
    throw ModelError(fmt::format("{}: {}", place, message));
}

std::optional<std::size_t> whole_number(const Json& json, const char* key, const std::string& place) {
    const auto member = json.find(key);
    if (member == json.end()) return std::nullopt;
    if (!member->is_number_unsigned()) fail(member_place(place, key), "expected a whole number");
    return member->get<std::size_t>();
}

std::size_t needed(const Json& json, const char* key, const std::string& place) {
    const std::optional<std::size_t> value = whole_number(json, key, place);
    if (!value) fail(place, fmt::format("expected '{}'", key));
    return *value;
}

template <std::size_t n>
std::optional<std::array<double, n>> numbers(const Json& json, const char* key, const std::string& place) {
    const auto member = json.find(key);
    if (member == json.end()) return std::nullopt;
    std::array<double, n> out{};
    if (!member->is_array() || member->size() != n)
        fail(member_place(place, key), fmt::format("expected {} numbers", n));
    for (std::size_t k = 0; k < n; ++k) {
        if (!(*member)[k].is_number()) fail(member_place(place, key), fmt::format("expected {} numbers", n));
        out[k] = (*member)[k].template get<double>();
    }
    return out;
}

std::string text(const Json& json, const char* key) {
    const auto member = json.find(key);
    return member != json.end() && member->is_string() ? member->get<std::string>() : "";
}

/// Replaces %XX by the character with this code (RFC 3986).
std::string percent_decoded(std::string_view uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10 : -1;
    };
    std::string out;
    for (std::size_t k = 0; k < uri.size(); ++k) {
        const bool is_code = uri[k] == '%' && k + 2 < uri.size() && digit(uri[k + 1]) >= 0 && digit(uri[k + 2]) >= 0;
        out += is_code ? static_cast<char>(16 * digit(uri[k + 1]) + digit(uri[k + 2])) : uri[k];
        if (is_code) k += 2;
    }
    return out;
}

/// Base64 (RFC 4648); nothing if some other character is in it.
std::optional<std::string> base64_decoded(std::string_view text) {
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    std::uint32_t bits = 0;
    int count = 0;
    while (text.ends_with('=')) text.remove_suffix(1);
    for (const char c : text) {
        const std::size_t value = alphabet.find(c);
        if (value == alphabet.npos) return std::nullopt;
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        out += static_cast<char>(bits >> count & 255);
    }
    return out;
}

/// The parts of a .glb file: JSON, and a buffer.
struct Container {
    std::string_view json;
    std::optional<std::string_view> buffer;
    std::size_t other_parts = 0, trailing_bytes = 0;  // trailing_bytes: bytes behind the last one
};

Container container_of(std::string_view file) {
    constexpr std::string_view magic = "glTF";
    constexpr std::uint32_t json_chunk = 0x4E4F534A, buffer_chunk = 0x004E4942;
    if (!file.starts_with(magic)) return {file, std::nullopt};
    if (file.size() < 12 || little_endian<std::uint32_t>(file.data() + 4) != 2)
        throw ModelError("expected version 2 of GLB");
    Container out;
    std::size_t place = 12;
    while (place + 8 <= file.size()) {
        const auto size = little_endian<std::uint32_t>(file.data() + place),
                   kind = little_endian<std::uint32_t>(file.data() + place + 4);
        if (size > file.size() - place - 8)
            throw ModelError(fmt::format("byte {}: a part of {} bytes, beyond the end of the file", place, size));
        const std::string_view bytes = file.substr(place + 8, size);
        if (kind == json_chunk && out.json.empty()) out.json = bytes;
        else if (kind == buffer_chunk && !out.buffer) out.buffer = bytes;
        else ++out.other_parts;
        place += 8 + (std::size_t{size} + 3) / 4 * 4;
    }
    out.trailing_bytes = file.size() - std::min(place, file.size());
    return out;
}

/// Numbers of one kind in a buffer.
struct Array {
    std::string place;
    std::size_t count = 0, components = 1, stride = 0;
    std::size_t type = 0;
    bool normalized = false;
    std::string_view bytes;  // of the first number on; empty: all are 0
    const Json* sparse = nullptr;
};

constexpr std::size_t type_i8 = 5120, type_u8 = 5121, type_i16 = 5122, type_u16 = 5123, type_u32 = 5125,
                      type_f32 = 5126;

std::size_t bytes_of_type(std::size_t type, const std::string& place) {
    switch (type) {
        case type_i8:
        case type_u8: return 1;
        case type_i16:
        case type_u16: return 2;
        case type_u32:
        case type_f32: return 4;
        default: fail(place, fmt::format("expected a componentType of 5120 to 5126, not {}", type));
    }
}

double value_at(const char* bytes, std::size_t type, bool normalized) {
    switch (type) {
        case type_i8: {
            const double v = little_endian<std::int8_t>(bytes);
            return normalized ? std::max(v / 127, -1.0) : v;
        }
        case type_u8: {
            const double v = little_endian<std::uint8_t>(bytes);
            return normalized ? v / 255 : v;
        }
        case type_i16: {
            const double v = little_endian<std::int16_t>(bytes);
            return normalized ? std::max(v / 32767, -1.0) : v;
        }
        case type_u16: {
            const double v = little_endian<std::uint16_t>(bytes);
            return normalized ? v / 65535 : v;
        }
        case type_f32: return static_cast<double>(little_endian<float>(bytes));
        default: return little_endian<std::uint32_t>(bytes);
    }
}

/// Which texture coordinates a texture takes, and their transform (KHR_texture_transform): uv' = offset + R S uv.
struct UvUse {
    std::size_t set = 0;
    std::array<double, 2> offset{0, 0}, scale{1, 1};
    double rotation = 0;
    bool operator==(const UvUse&) const = default;
};

constexpr const char* meshopt_name = "EXT_meshopt_compression";

class GltfReader {
public:
    Model model;

    GltfReader(std::string_view file, std::filesystem::path folder, const ReadingScope& scope)
        : folder_(std::move(folder)),
          scope_(scope),
          container_(container_of(file)),
          root_(Json::parse(container_.json, nullptr, false)) {
        if (!root_.is_object()) throw ModelError("expected JSON, or GLB");
        if (root_.contains("asset") && !text(root_["asset"], "version").starts_with("2"))
            fail("asset.version", "expected glTF 2");
        look_at_extensions();
        for (std::size_t k = 0; k < size_of("materials"); ++k) add_material(k);
        place_scene();
        model.leave_out(container_.other_parts, "part[s] of the file of an unknown kind");
        model.leave_out(container_.trailing_bytes, "byte[s] after the last part of the file");
        model.leave_out(points_and_lines_, "primitive[s] of points or lines, or without positions");
        model.leave_out(size_of("skins"), "skin[s]");
        model.leave_out(size_of("animations"), "animation[s]");
        model.leave_out(targets_, "primitive[s] with morph targets");
        for (const auto& [what, count] : dropped_) model.leave_out(count, what);
        for (const auto& [name, count] : attributes_)
            model.left_out.push_back(fmt::format("the attribute {} of {}", name, counted(count, "primitive[s]")));
    }

private:
    std::size_t size_of(const char* list) const {
        const auto member = root_.find(list);
        return member != root_.end() && member->is_array() ? member->size() : 0;
    }
    const Json& element(const char* list, std::size_t index, const std::string& from) const {
        if (index >= size_of(list))
            fail(from, fmt::format("expected an index below {}, the number of {}, not {}", size_of(list), list, index));
        const Json& out = root_[list][index];
        if (!out.is_object()) fail(element_place(list, index), "expected an object");
        return out;
    }

    /// Extensions that place or shape nothing are left out and named; the others are needed, so they are refused by
    /// name.
    void look_at_extensions() {
        const auto names = [&](const char* key) {
            std::set<std::string> out;
            if (!root_.contains(key)) return out;
            if (!root_[key].is_array()) fail(key, "expected an array of names");
            for (const Json& name : root_[key]) {
                if (!name.is_string()) fail(key, "expected an array of names");
                out.insert(name.get<std::string>());
            }
            return out;
        };
        const auto is_read = [](const std::string& name) {
            return name == "KHR_mesh_quantization" || name == "KHR_texture_transform" ||
                name == "KHR_materials_emissive_strength" || name == "KHR_materials_pbrSpecularGlossiness" ||
                (name == "KHR_draco_mesh_compression" && can_read_draco()) ||
                (name == meshopt_name && can_read_meshopt());
        };
        const auto shapes_nothing = [](const std::string& name) {
            return name.starts_with("KHR_materials_") || name == "KHR_lights_punctual" ||
                name == "KHR_texture_basisu" || name == "EXT_texture_webp" || name.starts_with("KHR_xmp");
        };
        std::set<std::string> left_out = names("extensionsUsed");
        for (const std::string& name : names("extensionsRequired")) {
            if (!is_read(name) && !shapes_nothing(name))
                fail("extensionsRequired", fmt::format("the extension '{}' is not supported", name));
            left_out.insert(name);
        }
        // Extensions that the file does not declare are left out too.
        std::map<std::string, std::size_t> places;
        count_extensions(root_, places);
        for (const auto& [name, count] : places) left_out.insert(name);
        for (const std::string& name : left_out)
            if (!is_read(name))
                model.left_out.push_back(
                    fmt::format("the extension {}, in {}", name, counted(places[name], "place[s]")));
    }
    /// Adds how many objects of the file have each extension, to a depth that glTF does not reach.
    static void count_extensions(const Json& json, std::map<std::string, std::size_t>& to, int depth = 0) {
        if (!json.is_structured() || depth > 32) return;
        if (const Json* extensions = json.is_object() ? object(json, "extensions") : nullptr)
            for (const auto& [name, value] : extensions->items()) ++to[name];
        for (const auto& [key, value] : json.items())
            if (key != "extras") count_extensions(value, to, depth + 1);
    }

    void add_material(std::size_t index) {
        const std::string place = element_place("materials", index);
        const Json& from = element("materials", index, place);
        Material to{text(from, "name")};
        if (const auto emission = numbers<3>(from, "emissiveFactor", place))
            to.emission = narrow({(*emission)[0], (*emission)[1], (*emission)[2]});
        if (const Json* strength = extension(from, "KHR_materials_emissive_strength"))
            to.emission = static_cast<float>(number(*strength, "emissiveStrength", 1, place)) * to.emission;
        if (from.contains("emissiveTexture")) {
            to.emission = {};
            ++dropped_["image[s] of emission, with the emission"];
        }
        to.two_sided = from.value("doubleSided", Json(false)) == Json(true);
        to.rho_d = {1, 1, 1};
        uv_uses_.emplace_back();
        if (const Json* gloss = extension(from, "KHR_materials_pbrSpecularGlossiness"))
            add_gloss(*gloss, member_place(place, "extensions.KHR_materials_pbrSpecularGlossiness"), to);
        else add_metal(from, place, to);
        dropped_["normal map[s]"] += from.contains("normalTexture");
        dropped_["image[s] of occlusion"] += from.contains("occlusionTexture");
        dropped_["material[s] with transparency"] +=
            text(from, "alphaMode") == "MASK" || text(from, "alphaMode") == "BLEND";
        model.materials.push_back(std::move(to));
    }

    /// Metal and roughness: 0.04 is the reflectance of other surfaces than metals towards the normal.
    void add_metal(const Json& from, const std::string& place, Material& to) {
        to.rho_s = {0.04f, 0.04f, 0.04f};
        to.metal = to.alpha = 1;
        const auto member = from.find("pbrMetallicRoughness");
        if (member == from.end()) return;
        const std::string inner = member_place(place, "pbrMetallicRoughness");
        if (!member->is_object()) fail(inner, "expected an object");
        if (const auto colour = numbers<4>(*member, "baseColorFactor", inner))
            to.rho_d = narrow({(*colour)[0], (*colour)[1], (*colour)[2]});
        to.metal = static_cast<float>(number(*member, "metallicFactor", 1, inner));
        to.alpha = alpha_of(number(*member, "roughnessFactor", 1, inner));
        if (const Json* texture = object(*member, "baseColorTexture"))
            add_colours(*texture, member_place(inner, "baseColorTexture"), to);
        if (const Json* texture = object(*member, "metallicRoughnessTexture")) {
            const std::string texture_place = member_place(inner, "metallicRoughnessTexture");
            const UvUse use = uv_use(*texture, texture_place);
            if (!to.colours) uv_uses_.back() = use;
            if (use == uv_uses_.back()) to.surface = picture(*texture, texture_place);
            else ++dropped_["image[s] of roughness, placed otherwise than the colours"];
        }
    }
    /// The older extension: two colours and a glossiness, of which the image is left out.
    void add_gloss(const Json& from, const std::string& place, Material& to) {
        if (const auto colour = numbers<4>(from, "diffuseFactor", place))
            to.rho_d = narrow({(*colour)[0], (*colour)[1], (*colour)[2]});
        to.rho_s = {1, 1, 1};
        if (const auto colour = numbers<3>(from, "specularFactor", place))
            to.rho_s = narrow({(*colour)[0], (*colour)[1], (*colour)[2]});
        to.alpha = alpha_of(1 - number(from, "glossinessFactor", 1, place));
        if (const Json* texture = object(from, "diffuseTexture"))
            add_colours(*texture, member_place(place, "diffuseTexture"), to);
        dropped_["image[s] of gloss"] += from.contains("specularGlossinessTexture");
    }
    void add_colours(const Json& texture, const std::string& place, Material& to) {
        uv_uses_.back() = uv_use(texture, place);
        to.texture = this->texture(texture, place);
        to.colours = picture(texture, place);
    }

    static const Json* object(const Json& json, const char* key) {
        const auto member = json.find(key);
        return member != json.end() && member->is_object() ? &*member : nullptr;
    }
    static const Json* extension(const Json& json, const char* name) {
        const Json* extensions = object(json, "extensions");
        return extensions ? object(*extensions, name) : nullptr;
    }
    static double number(const Json& json, const char* key, double fallback, const std::string& place) {
        const auto member = json.find(key);
        if (member == json.end()) return fallback;
        if (!member->is_number()) fail(member_place(place, key), "expected a number");
        return member->get<double>();
    }
    /// The square of a roughness, with its sign.
    static float alpha_of(double roughness) { return static_cast<float>(roughness * std::fabs(roughness)); }

    UvUse uv_use(const Json& texture, const std::string& place) {
        UvUse out{.set = whole_number(texture, "texCoord", place).value_or(0)};
        const Json* transform = extension(texture, "KHR_texture_transform");
        if (!transform) return out;
        const std::string inner = member_place(place, "extensions.KHR_texture_transform");
        out.set = whole_number(*transform, "texCoord", inner).value_or(out.set);
        out.offset = numbers<2>(*transform, "offset", inner).value_or(out.offset);
        out.scale = numbers<2>(*transform, "scale", inner).value_or(out.scale);
        out.rotation = number(*transform, "rotation", 0, inner);
        return out;
    }

    /// The image of a texture; nothing if it has none, or if images are not read.
    const Json* image_of(const Json& from, const std::string& place, std::size_t& index) const {
        const std::size_t texture_index = needed(from, "index", place);
        const Json& texture = element("textures", texture_index, member_place(place, "index"));
        const std::optional<std::size_t> source =
            whole_number(texture, "source", element_place("textures", texture_index));
        if (!source) return nullptr;
        index = *source;
        return &element("images", *source, member_place(element_place("textures", texture_index), "source"));
    }
    /// Whether the image of a texture repeats in both directions.
    bool repeats(const Json& from, const std::string& place) const {
        const std::size_t index = needed(from, "index", place);
        const std::string texture_place = element_place("textures", index);
        const Json& texture = element("textures", index, member_place(place, "index"));
        const std::optional<std::size_t> sampler_index = whole_number(texture, "sampler", texture_place);
        if (!sampler_index) return true;
        const Json& sampler = element("samplers", *sampler_index, member_place(texture_place, "sampler"));
        constexpr std::size_t repeat = 10497;  // of OpenGL
        return std::ranges::all_of(std::array{"wrapS", "wrapT"}, [&](const char* key) {
            return whole_number(sampler, key, element_place("samplers", *sampler_index)).value_or(repeat) == repeat;
        });
    }
    std::string texture(const Json& from, const std::string& place) const {
        std::size_t index = 0;
        const Json* image = image_of(from, place, index);
        if (!image) return "";
        const std::string uri = text(*image, "uri");
        return uri.empty() || uri.starts_with("data:") ? "within the model" : percent_decoded(uri);
    }
    std::optional<std::size_t> picture(const Json& from, const std::string& place) {
        std::size_t index = 0;
        const Json* image = image_of(from, place, index);
        if (!image) ++dropped_["image[s] in a format of an extension"];
        if (!image || !scope_.images) return std::nullopt;
        dropped_["image[s] that [is|are] clamped or mirrored at [its|their] ends, and repeat[s|] here"] +=
            !repeats(from, place);
        const auto [picture, is_new] = picture_of_image_.try_emplace(index, model.pictures.size());
        if (!is_new) return picture->second;
        const std::string image_place = element_place("images", index), uri = text(*image, "uri");
        Picture out{text(*image, "name"), {}};
        if (const std::optional<std::size_t> view = whole_number(*image, "bufferView", image_place))
            out.bytes = this->view(*view, 0, member_place(image_place, "bufferView")).first;
        else if (uri.starts_with("data:")) {
            const std::size_t comma = uri.find(";base64,");
            auto bytes = comma == uri.npos ? std::nullopt : base64_decoded(std::string_view(uri).substr(comma + 8));
            if (!bytes) fail(member_place(image_place, "uri"), "expected base64");
            out.bytes = std::move(*bytes);
        } else {
            std::string name = percent_decoded(uri);
            std::optional<FoundFile> file = file_named(name, std::array{folder_}, folder_);
            if (!file) file = file_named(uri, std::array{folder_}, folder_);
            if (file && file->is_other)
                model.assumed.push_back(
                    fmt::format("'{}' is '{}' of another folder", file->path.filename().string(), name));
            // One that is not there is counted by who writes the images.
            if (file) out.bytes = bytes_of(file->path);
            out.name = file ? file->path.filename().string() : std::move(name);
        }
        model.pictures.push_back(std::move(out));
        return picture->second;
    }

    // ---- Buffers.

    std::string_view buffer(std::size_t index, const std::string& from) {
        const Json& entry = element("buffers", index, from);
        const std::string place = element_place("buffers", index);
        const std::size_t size = needed(entry, "byteLength", place);
        const auto [slot, is_new] = buffers_.try_emplace(index);
        if (is_new) slot->second = bytes_of_buffer(entry, index, place);
        const std::string_view bytes = entry.contains("uri") ? slot->second : *container_.buffer;
        if (bytes.size() < size) fail(place, fmt::format("expected {} bytes, found {}", size, bytes.size()));
        return bytes.substr(0, size);
    }
    std::string bytes_of_buffer(const Json& entry, std::size_t index, const std::string& place) const {
        if (!entry.contains("uri")) {
            if (index != 0 || !container_.buffer) fail(place, "expected 'uri'");
            return "";
        }
        const std::string uri = text(entry, "uri");
        if (uri.starts_with("data:")) {
            const std::size_t comma = uri.find(";base64,");
            auto out = comma == uri.npos ? std::nullopt : base64_decoded(std::string_view(uri).substr(comma + 8));
            if (!out) fail(member_place(place, "uri"), "expected base64");
            return std::move(*out);
        }
        const std::filesystem::path path = folder_ / percent_decoded(uri);
        if (!is_inside(folder_, path))
            fail(member_place(place, "uri"), "expected a file in the folder of the model or below it");
        try {
            return bytes_of(path);
        } catch (const ModelError& error) { fail(member_place(place, "uri"), error.what()); }
    }

    /// The bytes of a view from an offset on, and its stride: 0 for none.
    std::pair<std::string_view, std::size_t> view(std::size_t index, std::size_t offset, const std::string& from) {
        const Json& entry = element("bufferViews", index, from);
        const std::string place = element_place("bufferViews", index);
        const Json* extension_json = can_read_meshopt() ? extension(entry, meshopt_name) : nullptr;
        const std::string_view bytes = extension_json
            ? unpacked_view(*extension_json, index, needed(entry, "byteLength", place))
            : bytes_of_view(entry, place);
        const std::size_t size = bytes.size();
        if (offset > size) fail(from, fmt::format("byteOffset {} is beyond the {} bytes of its view", offset, size));
        return {bytes.substr(offset), whole_number(entry, "byteStride", place).value_or(0)};
    }

    /// The bytes of a view, or of the extension of one.
    std::string_view bytes_of_view(const Json& entry, const std::string& place) {
        const std::string_view bytes = buffer(needed(entry, "buffer", place), member_place(place, "buffer"));
        const std::size_t begin = whole_number(entry, "byteOffset", place).value_or(0),
                          size = needed(entry, "byteLength", place);
        if (begin > bytes.size() || size > bytes.size() - begin)
            fail(place, fmt::format("{} bytes from {} on are beyond the {} of its buffer", size, begin, bytes.size()));
        return bytes.substr(begin, size);
    }

    /// The bytes of a compressed view, decoded once. `size`: those that the view states.
    std::string_view unpacked_view(const Json& extension_json, std::size_t index, std::size_t size) {
        const auto [slot, is_new] = unpacked_views_.try_emplace(index);
        if (!is_new) return slot->second;
        const std::string place =
            member_place(element_place("bufferViews", index), fmt::format("extensions.{}", meshopt_name));
        MeshoptView as{.mode = text(extension_json, "mode"),
            .count = needed(extension_json, "count", place),
            .stride = needed(extension_json, "byteStride", place)};
        if (extension_json.contains("filter")) as.filter = text(extension_json, "filter");
        const std::string_view bytes = bytes_of_view(extension_json, place);
        if (as.stride == 0 || size / as.stride != as.count || size % as.stride != 0)
            fail(place,
                fmt::format("{} elements of {} bytes are not the {} bytes of the view", as.count, as.stride, size));
        try {
            slot->second = read_meshopt(bytes, as);
        } catch (const ModelError& error) { fail(place, error.what()); }
        return slot->second;
    }

    Array array(std::size_t index, const std::string& from, std::string_view expected) {
        const Json& entry = element("accessors", index, from);
        Array out;
        out.place = element_place("accessors", index);
        out.type = needed(entry, "componentType", out.place);
        const std::size_t size = bytes_of_type(out.type, out.place);
        if (text(entry, "type") != expected)
            fail(member_place(out.place, "type"),
                fmt::format("expected {} for {}, not '{}'", expected, from, text(entry, "type")));
        out.components = expected == "VEC3" ? 3 : expected == "VEC2" ? 2 : 1;
        out.count = needed(entry, "count", out.place);
        out.normalized = entry.value("normalized", Json(false)) == Json(true);
        out.stride = out.components * size;
        if (const auto place = whole_number(entry, "bufferView", out.place)) {
            const auto [bytes, stride] = view(*place, whole_number(entry, "byteOffset", out.place).value_or(0),
                member_place(out.place, "bufferView"));
            if (stride > 0) out.stride = stride;
            out.bytes = bytes;
            need_bytes(out.place, bytes.size(), out.count, out.stride, out.components * size);
        }
        if (entry.contains("sparse")) out.sparse = &entry["sparse"];
        return out;
    }
    static void need_unsigned(std::size_t type, const std::string& place) {
        if (type != type_u8 && type != type_u16 && type != type_u32)
            fail(member_place(place, "componentType"), fmt::format("expected 5121, 5123 or 5125, not {}", type));
    }
    static void need_bytes(
        const std::string& place, std::size_t have, std::size_t count, std::size_t stride, std::size_t last) {
        if (count == 0) return;
        if (have < last || (stride > 0 && count - 1 > (have - last) / stride))
            fail(place, fmt::format("{} elements are beyond the {} bytes of its view", count, have));
    }

    /// All numbers of an array, row by row.
    std::vector<double> values_of(const Array& from) {
        constexpr std::size_t most_elements = std::size_t{1} << 31;
        if (from.count > most_elements) fail(from.place, "expected at most 2^31 elements");
        std::vector<double> out(from.count * from.components);
        const std::size_t size = bytes_of_type(from.type, from.place);
        if (!from.bytes.empty())
            for (std::size_t k = 0; k < out.size(); ++k)
                out[k] = value_at(from.bytes.data() + k / from.components * from.stride + k % from.components * size,
                    from.type, from.normalized);
        if (from.sparse) add_sparse(from, out);
        return out;
    }
    void add_sparse(const Array& from, std::vector<double>& to) {
        const std::string place = member_place(from.place, "sparse");
        const Json& sparse = *from.sparse;
        if (!sparse.is_object() || !sparse.contains("indices") || !sparse.contains("values") ||
            !sparse["indices"].is_object() || !sparse["values"].is_object())
            fail(place, "expected 'count', 'indices' and 'values'");
        const std::size_t count = needed(sparse, "count", place);
        const auto part = [&](const char* key, std::size_t bytes) {
            const std::string inner = member_place(place, key);
            const std::string_view out = view(needed(sparse[key], "bufferView", inner),
                whole_number(sparse[key], "byteOffset", inner).value_or(0), inner)
                                             .first;
            need_bytes(inner, out.size(), count, bytes, bytes);
            return out;
        };
        const std::size_t type = needed(sparse["indices"], "componentType", member_place(place, "indices"));
        need_unsigned(type, member_place(place, "indices"));
        const std::size_t index_size = bytes_of_type(type, place), size = bytes_of_type(from.type, place);
        const std::string_view indices = part("indices", index_size), values = part("values", from.components * size);
        for (std::size_t k = 0; k < count; ++k) {
            const double row = value_at(indices.data() + k * index_size, type, false);
            if (!(row >= 0 && row < static_cast<double>(from.count)))
                fail(member_place(place, "indices"), fmt::format("{} is beyond the {} elements", row, from.count));
            for (std::size_t c = 0; c < from.components; ++c)
                to[static_cast<std::size_t>(row) * from.components + c] =
                    value_at(values.data() + (k * from.components + c) * size, from.type, from.normalized);
        }
    }

    // ---- The scene.

    static Transform transform_of(const Json& node, const std::string& place) {
        Transform out;
        if (const auto m = numbers<16>(node, "matrix", place)) {
            for (const char* key : {"translation", "rotation", "scale"})
                if (node.contains(key)) fail(place, fmt::format("expected 'matrix' or '{}', found both", key));
            if ((*m)[3] != 0 || (*m)[7] != 0 || (*m)[11] != 0 || (*m)[15] != 1)
                fail(member_place(place, "matrix"), "expected 0, 0, 0 and 1 as the last row");
            for (std::size_t k = 0; k < 3; ++k) out.columns[k] = {(*m)[4 * k], (*m)[4 * k + 1], (*m)[4 * k + 2]};
            out.origin = {(*m)[12], (*m)[13], (*m)[14]};
            return out;
        }
        const auto t = numbers<3>(node, "translation", place).value_or(std::array<double, 3>{0, 0, 0});
        const auto q = numbers<4>(node, "rotation", place).value_or(std::array<double, 4>{0, 0, 0, 1});
        const auto s = numbers<3>(node, "scale", place).value_or(std::array<double, 3>{1, 1, 1});
        const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        constexpr double rounding = 0.01;  // of a byte
        if (!(std::fabs(length - 1) <= rounding))
            fail(member_place(place, "rotation"), fmt::format("expected a quaternion of length 1, not {:.4g}", length));
        const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
        out.columns[0] = s[0] * Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
        out.columns[1] = s[1] * Vec3d{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
        out.columns[2] = s[2] * Vec3d{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
        out.origin = {t[0], t[1], t[2]};
        return out;
    }

    std::vector<std::size_t> children(const Json& json, const char* key, const std::string& place) const {
        std::vector<std::size_t> out;
        if (!json.contains(key)) return out;
        const std::string list = member_place(place, key);
        if (!json[key].is_array()) fail(list, "expected an array");
        for (const Json& entry : json[key]) {
            if (!entry.is_number_unsigned()) fail(list, "expected whole numbers");
            out.push_back(entry.get<std::size_t>());
        }
        return out;
    }

    void place_scene() {
        struct Open {
            std::size_t node;
            Transform parent;
            std::string from;
            std::vector<std::string> names;
        };
        std::vector<Open> open_nodes, mesh_nodes;  // mesh_nodes: meshes with their transforms, in place of a node's
        if (size_of("scenes") > 0) {
            const std::size_t index = whole_number(root_, "scene", "").value_or(0);
            const std::string place = element_place("scenes", index);
            for (const std::size_t node : children(element("scenes", index, "scene"), "nodes", place))
                open_nodes.push_back({node, {}, member_place(place, "nodes"), {}});
        } else {
            std::vector<bool> has_parent(size_of("nodes"));
            for (std::size_t k = 0; k < has_parent.size(); ++k)
                for (const std::size_t child :
                    children(element("nodes", k, "nodes"), "children", element_place("nodes", k)))
                    if (child < has_parent.size()) has_parent[child] = true;
            for (std::size_t k = 0; k < has_parent.size(); ++k)
                if (!has_parent[k]) open_nodes.push_back({k, {}, "nodes", {}});
        }
        std::ranges::reverse(open_nodes);
        std::vector<bool> visited(size_of("nodes"));
        while (!open_nodes.empty()) {
            const Open open_node = std::move(open_nodes.back());
            open_nodes.pop_back();
            const Json& node = element("nodes", open_node.node, open_node.from);
            const std::string place = element_place("nodes", open_node.node);
            if (visited[open_node.node])
                fail(open_node.from, fmt::format("the node {} is placed twice", open_node.node));
            visited[open_node.node] = true;
            const Transform transform = open_node.parent.then(transform_of(node, place));
            std::vector<std::string> names = open_node.names;
            if (const std::string name = text(node, "name"); !name.empty() && scope_.whole_scene) names.push_back(name);
            if (const auto mesh = whole_number(node, "mesh", place))
                mesh_nodes.push_back({*mesh, transform, member_place(place, "mesh"), names});
            if (const auto camera = whole_number(node, "camera", place)) add_camera(*camera, transform, place);
            if (extension(node, "KHR_lights_punctual")) ++dropped_["light[s]"];
            std::vector<std::size_t> inner = children(node, "children", place);
            std::ranges::reverse(inner);
            for (const std::size_t child : inner)
                open_nodes.push_back({child, transform, member_place(place, "children"), names});
        }
        for (std::size_t k = 0; k < visited.size(); ++k)
            dropped_["mesh[es] outside of the scene"] += !visited[k] && element("nodes", k, "nodes").contains("mesh");
        std::map<std::size_t, std::size_t> uses;
        for (const Open& mesh_node : mesh_nodes) ++uses[mesh_node.node];
        std::map<std::size_t, std::pair<std::size_t, std::size_t>> part_ranges;  // the parts of a mesh
        for (const Open& mesh_node : mesh_nodes) {
            const bool is_copied = scope_.whole_scene && uses[mesh_node.node] > 1;
            const auto [parts, is_new] =
                part_ranges.try_emplace(mesh_node.node, model.parts.size(), model.parts.size());
            if (!is_copied) add_mesh(mesh_node.node, mesh_node.parent, mesh_node.from, mesh_node.names);
            else if (is_new) add_mesh(mesh_node.node, {}, mesh_node.from, {});
            if (is_new) parts->second.second = model.parts.size();
            if (is_copied)
                for (std::size_t k = parts->second.first; k < parts->second.second; ++k)
                    model.parts[k].copies.push_back({mesh_node.parent, mesh_node.names});
        }
    }

    void add_camera(std::size_t index, const Transform& transform, const std::string& from) {
        const Json& camera = element("cameras", index, member_place(from, "camera"));
        const Json* lens = object(camera, "perspective");
        if (!lens || model.camera) return void(++dropped_["camera[s]"]);
        const double vfov = number(*lens, "yfov", 0, element_place("cameras", index));
        if (!(vfov > 0 && vfov < pi)) fail(element_place("cameras", index), "expected a 'yfov' between 0 and pi");
        model.camera = {.eye = transform.origin,
            .view = transform.turned({0, 0, -1}),
            .up = transform.turned({0, 1, 0}),
            .vfov_deg = vfov * 180 / pi,
            .aspect = number(*lens, "aspectRatio", 4.0 / 3, element_place("cameras", index))};
    }

    void add_mesh(
        std::size_t index, const Transform& transform, const std::string& from, const std::vector<std::string>& names) {
        const Json& mesh = element("meshes", index, from);
        const std::string place = element_place("meshes", index);
        if (!mesh.contains("primitives") || !mesh["primitives"].is_array()) fail(place, "expected 'primitives'");
        const std::size_t first = model.parts.size();
        for (std::size_t k = 0; k < mesh["primitives"].size(); ++k)
            add_primitive(mesh["primitives"][k], transform, element_place(member_place(place, "primitives"), k));
        for (std::size_t k = first; k < model.parts.size(); ++k) {
            model.parts[k].names = names;
            std::vector<std::string>& part_names = model.parts[k].names;
            if (const std::string name = text(mesh, "name"); !name.empty()) part_names.insert(part_names.begin(), name);
        }
    }

    void add_primitive(const Json& from, const Transform& transform, const std::string& place) {
        constexpr std::size_t list = 4, strip = 5, fan = 6;
        if (!from.is_object() || !from.contains("attributes") || !from["attributes"].is_object())
            fail(place, "expected 'attributes'");
        std::size_t mode = whole_number(from, "mode", place).value_or(list);
        if (mode > fan) fail(member_place(place, "mode"), fmt::format("expected a number from 0 to 6, not {}", mode));
        const Json& attributes = from["attributes"];
        if (mode < list || !attributes.contains("POSITION")) {
            ++points_and_lines_;
            return;
        }
        if (from.contains("targets")) ++targets_;
        Part part;
        part.material = material(from, place);
        const std::string uv = uv_name(part.material);
        for (const auto& [name, index] : attributes.items())
            if (name != "POSITION" && name != "NORMAL" && name != uv) ++attributes_[name];
        const std::optional<DracoMesh> draco_mesh = unpacked(from, place);
        if (draco_mesh) mode = list;
        const std::size_t count =
            add_vertices(attributes, transform, member_place(place, "attributes"), draco_mesh, part);
        const std::vector<std::uint32_t> corners = draco_mesh ? draco_mesh->corners : corners_of(from, place, count);
        if (mode == list && corners.size() % 3 != 0)
            fail(place, fmt::format("expected three indices for each triangle, found {}", corners.size()));
        const bool is_mirrored = transform.determinant() < 0;
        for (std::size_t k = 0; k + 2 < corners.size(); k += mode == list ? 3 : 1) {
            Triangle triangle{corners[k], corners[k + 1], corners[k + 2]};
            if (mode == strip && k % 2 == 1) std::swap(triangle[1], triangle[2]);
            if (mode == fan) triangle = {corners[k + 1], corners[k + 2], corners[0]};
            if (is_mirrored) std::swap(triangle[1], triangle[2]);
            part.triangles.push_back(triangle);
        }
        model.parts.push_back(std::move(part));
    }

    std::size_t material(const Json& primitive, const std::string& place) {
        const std::optional<std::size_t> index = whole_number(primitive, "material", place);
        if (index) return (void)element("materials", *index, member_place(place, "material")), *index;
        if (model.materials.size() == size_of("materials")) model.materials.push_back({});
        return size_of("materials");
    }

    /// The texture coordinates that a material takes.
    std::string uv_name(std::size_t material) const {
        return fmt::format("TEXCOORD_{}", material < uv_uses_.size() ? uv_uses_[material].set : 0);
    }

    /// Returns a compressed primitive; nothing if it is not compressed.
    std::optional<DracoMesh> unpacked(const Json& primitive, const std::string& place) {
        const Json* from = extension(primitive, "KHR_draco_mesh_compression");
        if (!from || !can_read_draco()) return std::nullopt;
        const std::string inner = member_place(place, "extensions.KHR_draco_mesh_compression");
        std::map<std::string, std::size_t> ids;
        if (const Json* attributes = object(*from, "attributes"))
            for (const auto& [name, id] : attributes->items())
                if (id.is_number_unsigned()) ids[name] = id.get<std::size_t>();
        if (!ids.contains("POSITION")) fail(inner, "expected 'attributes' with POSITION");
        try {
            return read_draco(view(needed(*from, "bufferView", inner), 0, inner).first, ids);
        } catch (const ModelError& error) { fail(inner, error.what()); }
    }

    /// Returns the number of vertices.
    std::size_t add_vertices(const Json& attributes, const Transform& transform, const std::string& place,
        const std::optional<DracoMesh>& draco_mesh, Part& to) {
        const auto read = [&](const char* name, std::string_view type) -> std::optional<std::vector<double>> {
            const std::optional<std::size_t> index = whole_number(attributes, name, place);
            if (!index) return std::nullopt;
            if (draco_mesh && draco_mesh->values.contains(name)) {
                const std::size_t components = type == "VEC3" ? 3 : 2;
                if (draco_mesh->values.at(name).size() != components * draco_mesh->count)
                    fail(member_place(place, name), fmt::format("expected {} numbers a vertex", components));
                return draco_mesh->values.at(name);
            }
            const Array array = this->array(*index, member_place(place, name), type);
            if (!to.positions.empty() && array.count != to.positions.size())
                fail(member_place(place, name),
                    fmt::format("expected {} elements, as POSITION has, not {}", to.positions.size(), array.count));
            return values_of(array);
        };
        const std::vector<double> positions = *read("POSITION", "VEC3");
        for (std::size_t k = 0; k < positions.size(); k += 3)
            to.positions.push_back(transform.placed({positions[k], positions[k + 1], positions[k + 2]}));
        if (to.positions.empty()) return 0;
        if (const auto normals = read("NORMAL", "VEC3")) {
            for (std::size_t k = 0; k < normals->size(); k += 3) {
                const Vec3d n = transform.turned_normal({(*normals)[k], (*normals)[k + 1], (*normals)[k + 2]});
                const double length = std::sqrt(dot(n, n));
                to.normals.push_back(length > 0 ? narrow((1 / length) * n) : Vec3f{});
            }
        }
        if (const auto uv = read(uv_name(to.material).c_str(), "VEC2")) {
            const UvUse use = to.material < uv_uses_.size() ? uv_uses_[to.material] : UvUse{};
            const double c = math::cos(use.rotation), s = math::sin(use.rotation);
            for (std::size_t k = 0; k < uv->size(); k += 2) {
                const double u = use.scale[0] * (*uv)[k], v = use.scale[1] * (*uv)[k + 1];
                // v of glTF goes down the image.
                to.uv.push_back({static_cast<float>(use.offset[0] + c * u + s * v),
                    static_cast<float>(1 - (use.offset[1] - s * u + c * v))});
            }
        }
        return to.positions.size();
    }

    std::vector<std::uint32_t> corners_of(const Json& primitive, const std::string& place, std::size_t vertices) {
        std::vector<std::uint32_t> out;
        const std::optional<std::size_t> index = whole_number(primitive, "indices", place);
        if (!index) {
            for (std::size_t k = 0; k < vertices; ++k) out.push_back(static_cast<std::uint32_t>(k));
            return out;
        }
        const Array array = this->array(*index, member_place(place, "indices"), "SCALAR");
        need_unsigned(array.type, array.place);
        const std::vector<double> values = values_of(array);
        for (std::size_t k = 0; k < values.size(); ++k) {
            if (!(values[k] >= 0 && values[k] < static_cast<double>(vertices)) || values[k] != std::floor(values[k]))
                fail(member_place(place, "indices"),
                    fmt::format("number {} of {} is {}, beyond the {} vertices", k, array.place, values[k], vertices));
            out.push_back(static_cast<std::uint32_t>(values[k]));
        }
        return out;
    }

    std::filesystem::path folder_;
    ReadingScope scope_;
    Container container_;
    Json root_;
    std::map<std::size_t, std::string> buffers_, unpacked_views_;
    std::size_t points_and_lines_ = 0, targets_ = 0;
    std::vector<UvUse> uv_uses_;                               // of each material of the file
    std::map<std::size_t, std::size_t> picture_of_image_;      // indices of the model's pictures
    std::map<std::string, std::size_t> attributes_, dropped_;  // what is left out, and how often
};

}  // namespace

Model read_gltf(const std::filesystem::path& file, const ReadingScope& scope) {
    return GltfReader(bytes_of(file), std::filesystem::absolute(file).parent_path(), scope).model;
}

}  // namespace crescent::importer
