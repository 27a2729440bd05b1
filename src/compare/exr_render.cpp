// OpenEXR as renderers write it: scanlines or tiles, half or float, one part or many, layers with dotted names,
// luminance and chroma, XYZ. Deep parts and data other than radiance (Cryptomatte, normals, depth, ...) are skipped.
#include "compare/exr_render.h"

#include "compare/exr_extra.h"
#include "compare/renders.h"
#include "images/exr_file.h"
#include "images/exr_layers.h"

namespace crescent {

namespace {

void set_primaries(Render& out, const ExrPart& part) {
    if (!part.primaries) return;
    out.primaries = *part.primaries;
    out.weights = luminance_weights_of(*part.primaries);
}

/// Returns the render without pixels, with the attributes of the part.
Render render_of(const ExrPart& part, const OpenFile& file, const ExrLayer& layer) {
    Render out(file.path(), static_cast<int>(part.data.width()), static_cast<int>(part.data.height()), Render::empty);
    out.layer = layer.name;
    out.data = part.data;
    out.display = part.display;
    out.spp =
        exr_attribute(file.path(), part, "samples a pixel", {"spp", "samples", "samplesperpixel", "samplecount", "n"});
    out.seconds = exr_attribute(file.path(), part, "seconds", {"rendertime", "seconds", "time", "rendertimes"});
    const bool half = layer.kind == ExrLayer::Kind::luminance_chroma || part.channel(layer.channels[0])->half;
    if (half) out.rounding = 0x1p-11;
    return out;
}

}  // namespace

Render read_exr(const OpenFile& file, const std::string& layer_name, const ReadingOptions& options) {
    const ExrFile exr(file);
    const ExrLayer layer = options.channel.empty() ? chosen_layer(exr, file.path(), layer_name)
                                                   : layer_of_channel(exr, file.path(), options.channel);
    const ExrPart& part = exr.parts()[static_cast<std::size_t>(layer.part)];
    Render out = render_of(part, file, layer);
    set_primaries(out, part);
    const ExrExtra extra = options.channel.empty() ? exr_extra(part) : ExrExtra{};
    if (options.channels == TestedChannels::rgba && options.channel.empty()) {
        const std::string alpha = alpha_of(part, layer);
        if (alpha.empty()) file.fail("channels = \"rgba\": expected an alpha channel, found none");
        out.alpha = std::move(exr.read(part, {alpha})[0]);
    }
    std::vector<std::string> channels;
    if (layer.kind == ExrLayer::Kind::luminance_chroma) {
        auto rgb = exr.read_luminance_chroma(part, layer.prefix);
        out.r = std::move(rgb[0]);
        out.g = std::move(rgb[1]);
        out.b = std::move(rgb[2]);
    } else {
        channels = layer.channels;
    }
    const std::size_t colours = channels.size();
    channels.insert(channels.end(), extra.spread.begin(), extra.spread.end());
    if (!extra.samples.empty()) channels.push_back(extra.samples);
    if (channels.empty()) return out;
    std::vector<std::vector<float>> planes = exr.read(part, channels);
    std::vector<float> samples;
    if (!extra.samples.empty()) {
        samples = std::move(planes.back());
        planes.pop_back();
    }
    std::vector<float>* to[] = {&out.r, &out.g, &out.b};
    for (std::size_t c = 0; c < colours; ++c) *to[c] = std::move(planes[c]);
    planes.erase(planes.begin(), planes.begin() + static_cast<std::ptrdiff_t>(colours));
    if (colours == 1) out.g = out.b = out.r;
    if (layer.kind == ExrLayer::Kind::xyz) from_xyz(out);
    set_variance(out, extra, planes);
    if (!extra.samples.empty()) set_samples(out, extra, samples);
    return out;
}

}  // namespace crescent
