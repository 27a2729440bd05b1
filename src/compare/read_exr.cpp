// OpenEXR as renderers write it: scanlines or tiles, half or float, one part or many, layers with dotted names, a data
// window smaller or larger than the display window. The image is the display window; what lies outside the data window
// is 0. Deep parts and what is not radiance (Cryptomatte, normals, depth, ...) are passed by.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors.h"
#include "base/hint.h"
#include "compare/exr_extra.h"
#include "compare/render.h"

namespace crescent::inline comparing {

namespace {

/// A set of channels that make a picture: R, G, B, or one Y.
struct Layer {
    int part = 0;
    std::string name;                   // "part/layer", as --layer takes it
    std::string alone;                  // the same where the file has one part, which need not be named
    std::vector<std::string> channels;  // 3 or 1
};

std::string joined(const std::string& part, const std::string& layer) {
    return part.empty() || layer.empty() ? part + layer : part + "/" + layer;
}

/// What an instrument or a mask wrote, by its name: no radiance.
bool is_data(const std::string& layer) {
    static constexpr const char* words[] = {"crypto", "normal", "depth", "position", "variance", "motion", "vector",
        "uv", "albedo", "error", "second_moment", "largest", "horizon", "hits", "stddev", "samplecount", "denois"};
    const std::string name = lower(layer);
    return std::any_of(
        std::begin(words), std::end(words), [&](const char* word) { return name.find(word) != std::string::npos; });
}

std::vector<Layer> layers_of(Imf::MultiPartInputFile& file) {
    std::vector<Layer> out;
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header& header = file.header(part);
        if (header.hasType() && Imf::isDeepData(header.type())) continue;
        const std::string own_name = header.hasName() ? header.name() : "";
        const std::string part_name = file.parts() > 1 ? own_name : "";
        for (auto& [layer, colours] : exr_channels(header)) {
            if (is_data(layer) || (layer.empty() && is_data(part_name))) continue;
            const std::string name = joined(part_name, layer), alone = joined(own_name, layer);
            if (colours.contains("r") && colours.contains("g") && colours.contains("b"))
                out.push_back({part, name, alone, {colours["r"], colours["g"], colours["b"]}});
            else if (colours.contains("y") && !colours.contains("ry") && lower(layer) != "luminance")
                out.push_back({part, name, alone, {colours["y"]}});
        }
    }
    return out;
}

std::string names_of(const std::vector<Layer>& layers) {
    std::string out;
    for (const Layer& layer : layers)
        out += (out.empty() ? "" : ", ") + (layer.name.empty() ? "(R, G, B)" : "'" + layer.name + "'");
    return out;
}

/// The beauty, by the names that renderers give it, the most certain first.
const Layer* beauty(const std::vector<Layer>& layers) {
    if (layers.size() == 1) return &layers[0];
    static constexpr const char* usual[] = {
        "", "rgba", "rgb", "beauty", "combined", "color", "colour", "default", "composite"};
    for (const char* word : usual) {
        std::vector<const Layer*> found;
        for (const Layer& layer : layers) {
            const std::string name = lower(layer.name);
            const std::size_t at = name.find_last_of("./");
            if ((at == std::string::npos ? name : name.substr(at + 1)) == word) found.push_back(&layer);
        }
        if (found.size() == 1) return found[0];
    }
    return nullptr;
}

const Layer& chosen(const std::string& path, const std::vector<Layer>& layers, const std::string& wanted) {
    if (layers.empty())
        throw InputError({path, 0, 0}, "expected channels R, G and B, or Y, found none that hold radiance");
    if (wanted.empty()) {
        if (const Layer* found = beauty(layers)) return *found;
        throw InputError({path, 0, 0}, "several layers hold radiance: say which with --layer: " + names_of(layers));
    }
    for (const Layer& layer : layers)
        if (layer.name == wanted || layer.alone == wanted) return layer;
    std::vector<std::string> names;
    for (const Layer& layer : layers) names.push_back(layer.name);
    throw InputError({path, 0, 0},
        fmt::format("no layer '{}': expected one of {}{}", wanted, names_of(layers), did_you_mean(wanted, names)));
}

/// Planes of the display window, read bottom-up out of the part's data window.
class Planes {
public:
    Planes(Imf::MultiPartInputFile& file, int part) : part_(file, part), header_(file.header(part)) {}

    int width() const { return header_.displayWindow().max.x - header_.displayWindow().min.x + 1; }
    int height() const { return header_.displayWindow().max.y - header_.displayWindow().min.y + 1; }

    /// Asks for a channel; it is there after read().
    void want(const std::string& channel, std::vector<float>& to) {
        const auto& d = header_.dataWindow();
        const auto w = static_cast<std::size_t>(d.max.x - d.min.x + 1),
                   h = static_cast<std::size_t>(d.max.y - d.min.y + 1);
        data_.push_back({&to, std::vector<float>(w * h)});
        char* base = reinterpret_cast<char*>(data_.back().second.data());
        const auto row = static_cast<std::ptrdiff_t>(4 * w);
        base -= row * d.min.y + 4 * static_cast<std::ptrdiff_t>(d.min.x);
        buffer_.insert(channel, Imf::Slice(Imf::FLOAT, base, 4, static_cast<std::size_t>(row)));
    }
    void read() {
        const auto& d = header_.dataWindow();
        part_.setFrameBuffer(buffer_);
        part_.readPixels(d.min.y, d.max.y);
        for (auto& [to, from] : data_) place(from, *to);
    }

private:
    void place(const std::vector<float>& from, std::vector<float>& to) const {
        const auto &data = header_.dataWindow(), &display = header_.displayWindow();
        const int w = width(), h = height(), stride = data.max.x - data.min.x + 1;
        to.assign(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0);
        for (int j = 0; j < h; ++j) {
            const int y = display.max.y - j;  // rows run bottom-up here, top-down in the file
            if (y < data.min.y || y > data.max.y) continue;
            for (int i = 0; i < w; ++i) {
                const int x = display.min.x + i;
                if (x < data.min.x || x > data.max.x) continue;
                to[static_cast<std::size_t>(j) * static_cast<std::size_t>(w) + static_cast<std::size_t>(i)] =
                    from[static_cast<std::size_t>(y - data.min.y) * static_cast<std::size_t>(stride) +
                        static_cast<std::size_t>(x - data.min.x)];
            }
        }
    }

    Imf::InputPart part_;
    Imf::Header header_;
    Imf::FrameBuffer buffer_;
    std::vector<std::pair<std::vector<float>*, std::vector<float>>> data_;
};

Render read_layer(Imf::MultiPartInputFile& file, const std::string& path, const Layer& layer) {
    Planes planes(file, layer.part);
    const Imf::Header& header = file.header(layer.part);
    if (planes.width() > 65536 || planes.height() > 65536)
        throw InputError({path, 0, 0}, "expected at most 65536 pixels a side");
    Render out(path, planes.width(), planes.height());
    out.layer = layer.name;
    std::vector<float>* colours[] = {&out.r, &out.g, &out.b};
    for (std::size_t c = 0; c < layer.channels.size(); ++c) planes.want(layer.channels[c], *colours[c]);
    const ExrExtra extra = exr_extra(header, header.hasName() ? header.name() : "");
    std::vector<std::vector<float>> spreads(extra.spread.size());
    for (std::size_t c = 0; c < spreads.size(); ++c) planes.want(extra.spread[c], spreads[c]);
    std::vector<float> samples;
    if (!extra.samples.empty()) planes.want(extra.samples, samples);
    planes.read();
    if (layer.channels.size() == 1) out.g = out.b = out.r;
    out.spp = exr_attribute(header, {"spp", "samples", "samplesperpixel", "samplecount", "n"});
    out.seconds = exr_attribute(header, {"rendertime", "seconds", "time", "rendertimes"});
    if (header.channels().findChannel(layer.channels[0])->type == Imf::HALF) out.rounding = 0x1p-11;
    set_variance(out, extra, spreads);
    if (!extra.samples.empty()) set_samples(out, extra, samples);
    return out;
}

}  // namespace

Render read_exr(const std::string& path, const std::string& layer) {
    try {
        Imf::MultiPartInputFile file(path.c_str());
        return read_layer(file, path, chosen(path, layers_of(file), layer));
    } catch (const InputError&) { throw; } catch (const std::exception& error) {
        throw InputError({path, 0, 0}, std::string("expected an OpenEXR file that can be read: ") + error.what());
    }
}

}  // namespace crescent::inline comparing
