// Colours of an experiment are albedos: rho_d and rho_s are in [0, 1] in each channel, and so is their sum.
#include "import_material.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "import.h"

namespace crescent::cli {

namespace {

/// Below it, a lobe is narrower than the error of single precision (budget).
constexpr double least_roughness = 1e-3;

Rgb colour_of(const Json& from) { return {from[0].get<double>(), from[1].get<double>(), from[2].get<double>()}; }

/// A colour that an experiment takes as an albedo.
Rgb albedo(Rgb c) {
    for (double& x : c) x = std::clamp(x, 0.0, 1.0);
    return std::ranges::max(c) < 1e-6 ? Rgb{} : c;
}

/// Averages squares of texels, until no side is longer than a texture's.
RgbImage shrunk(RgbImage image) {
    while (std::max(image.width, image.height) > widest_texture) {
        RgbImage half;
        half.width = std::max(image.width / 2, 1);
        half.height = std::max(image.height / 2, 1);
        half.rgb.resize(3 * half.texels());
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x)
                for (std::size_t c = 0; c < 3; ++c) {
                    float sum = 0;
                    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
                        const int column = std::min(2 * x + dx, image.width - 1);
                        const int row = std::min(2 * y + dy, image.height - 1);
                        sum += image.rgb[3 *
                                (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(column)) +
                            c];
                    }
                    half.rgb[3 *
                            (static_cast<std::size_t>(y) * static_cast<std::size_t>(half.width) +
                                static_cast<std::size_t>(x)) +
                        c] = sum / 4;
                }
        image = std::move(half);
    }
    return image;
}

}  // namespace

Rgb mean_of(const RgbImage& image) {
    Rgb sum{};
    for (std::size_t k = 0; k < image.rgb.size(); ++k) sum[k % 3] += static_cast<double>(image.rgb[k]);
    for (double& x : sum) x /= static_cast<double>(image.texels());
    return sum;
}

double least_imported_alpha() { return least_roughness; }

ImportedMaterial material_of(const Json& from, const Rgb& mean_colour, double mean_metal, Counts& cuts) {
    constexpr double rounding = 1 + 1e-6;  // of single precision
    const Rgb colour = colour_of(from["rho_d"]), lobe_colour = colour_of(from["rho_s"]);
    const double metal = std::min(from["metal"].get<double>(), 1.0) * mean_metal;
    ImportedMaterial to{.emission = colour_of(from["emission"])};
    to.alpha = std::clamp(from["alpha"].get<double>(), least_roughness, 1.0);
    if (std::ranges::max(to.emission) < 1e-9) to.emission = {};
    for (std::size_t c = 0; c < 3; ++c) {
        to.rho_d[c] = (1 - metal) * colour[c];
        to.rho_s[c] = (1 - metal) * lobe_colour[c] + metal * colour[c] * mean_colour[c];
    }
    const auto count = [&](bool holds, const char* what) {
        if (holds) ++cuts[what];
    };
    count(std::ranges::max(colour) > rounding, "material[s] with colours (Kd) above 1, to 1");
    count(std::ranges::max(lobe_colour) > rounding, "material[s] with colours of the lobe (Ks) above 1, to 1");
    count(from["metal"].get<double>() > rounding, "material[s] with metal above 1, to 1");
    count(from["alpha"].get<double>() > rounding, "material[s] with roughness above 1, to 1");
    count(from["alpha"].get<double>() < least_roughness, "material[s] with alpha below 0.001, to 0.001");
    to.rho_d = albedo(to.rho_d);
    to.rho_s = albedo(to.rho_s);
    bool exceeds = false;
    for (std::size_t c = 0; c < 3; ++c) {
        exceeds = exceeds || to.rho_d[c] + to.rho_s[c] > rounding;
        to.rho_s[c] = std::min(to.rho_s[c], 1 - to.rho_d[c]);
    }
    count(exceeds, "material[s] with rho_s above 1 - rho_d, to it: together they reflect more than all light");
    to.rho_s = albedo(to.rho_s);
    return to;
}

std::string cut_lines(const Counts& cuts) {
    std::string out;
    for (const auto& [what, count] : cuts) out += fmt::format("# cut: {}\n", counted(count, what));
    return out;
}

std::string left_out_images(
    const std::map<std::size_t, std::string>& missing_images, const std::map<std::size_t, std::string>& unread_images) {
    std::string out;
    for (const auto& [names, what] :
        {std::pair{&missing_images, "image[s] that [is|are] not in the model or its folder"},
            {&unread_images, "image[s], damaged or of a format that is not read"}}) {
        if (names->empty()) continue;
        constexpr std::size_t most_names = 3, longest_name = 100;
        std::string list;
        std::size_t count = 0;
        for (const auto& [index, name] : *names)
            if (!name.empty() && ++count <= most_names)
                list += (list.empty() ? ": " : ", ") + printable(name, longest_name);
        if (count > most_names) list += fmt::format(" and {} more", count - most_names);
        out += fmt::format("# left out: {}{}\n", counted(names->size(), what), list);
    }
    return out;
}

/// PNG 1.2, sections 4.2.2 and 11.3.3: an image has the chunk sRGB, or states another curve by gAMA or iCCP.
bool states_other_encoding(std::string_view bytes) {
    constexpr std::size_t signature = 8;
    constexpr std::uint32_t gamma_of_srgb = 45455;  // 1e5 / 2.2
    if (!bytes.starts_with("\x89PNG")) return false;
    const auto number = [&](std::size_t begin) {
        std::uint32_t out = 0;
        for (std::size_t k = 0; k < 4; ++k) out = out << 8 | static_cast<unsigned char>(bytes[begin + k]);
        return out;
    };
    bool is_other = false;
    for (std::size_t place = signature; place + 12 <= bytes.size();) {
        const std::size_t size = number(place);
        const std::string_view kind = bytes.substr(place + 4, 4);
        if (kind == "sRGB") return false;
        if (kind == "IDAT" || size > bytes.size() - place - 12) break;
        is_other = is_other || kind == "iCCP" || (kind == "gAMA" && size == 4 && number(place + 8) != gamma_of_srgb);
        place += size + 12;
    }
    return is_other;
}

std::optional<RgbImage> decoded_image(
    std::string_view bytes, const std::string& name, bool is_linear, const std::string& scratch) {
    const std::string file = (std::filesystem::path(scratch) / "picture").string() +
        std::filesystem::path(name).extension().string().substr(0, 8);
    write_whole(file, std::string(bytes));
    try {
        const Render render = read_render(
            file, {}, {.encoding = is_linear ? ImageEncoding::linear : ImageEncoding::automatic, .channel = {}});
        RgbImage out;
        out.width = render.width;
        out.height = render.height;
        out.rgb.resize(3 * out.texels());
        const std::vector<float>* planes[] = {&render.r, &render.g, &render.b};
        const auto width = static_cast<std::size_t>(out.width), height = static_cast<std::size_t>(out.height);
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width; ++x)
                for (std::size_t c = 0; c < 3; ++c)
                    out.rgb[3 * (y * width + x) + c] =
                        std::clamp((*planes[c])[(height - 1 - y) * width + x], 0.0f, 1.0f);
        return shrunk(std::move(out));
    } catch (const InputError&) { return std::nullopt; }
}

}  // namespace crescent::cli
