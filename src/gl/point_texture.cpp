// shading_points_of() finds the shading points tile by tile on all cores; they are stored in one array of floats, layer
// after layer, and uploaded once as RGBA32F. A pixel without a shading point has -1 as its lobe. Lengths in m.
#include "point_texture.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace crescent::gl {

namespace {

constexpr std::size_t layer_of_lobe = 5;

std::vector<TileBox> tiles_in(const TileBox& box) {
    std::vector<TileBox> out;
    for (const TileBox& t : tiles_of(box.x1 - box.x0, box.y1 - box.y0))
        out.push_back({box.x0 + t.x0, box.y0 + t.y0, box.x0 + t.x1, box.y0 + t.y1});
    return out;
}

}  // namespace

PointTexture::PointTexture(const Context& context, const Scene& scene, const TileBox& box, ProgressMonitor& monitor)
    : context_(context), box_(box), image_width_(static_cast<std::size_t>(scene.image().width)) {
    const std::vector<TileBox> tiles = tiles_in(box);
    std::vector<std::vector<ShadingPoints>> tile_groups(tiles.size());
    tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t k) {
        if (!monitor.stop) tile_groups[k] = shading_points_of(scene, tiles[k], nullptr);
    });
    monitor.check();
    for (std::vector<ShadingPoints>& groups : tile_groups)
        for (ShadingPoints& group : groups) groups_.push_back(std::move(group));

    const std::size_t texels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()),
                      layer_count = point_layers(count_lights(scene));
    std::vector<float> layers(4 * texels * layer_count, 0.0f);
    for (std::size_t k = 0; k < texels; ++k) layers[4 * (layer_of_lobe * texels + k) + 3] = -1;
    tbb::parallel_for(std::size_t{0}, groups_.size(), [&](std::size_t g) {
        for (std::size_t i = 0; i < groups_[g].count; ++i) fill_point(layers, groups_[g], i);
    });
    upload(layers, layer_count);
}

PointTexture::~PointTexture() { context_.gl().DeleteTextures(1, &texture_); }

void PointTexture::fill_point(std::vector<float>& layers, const ShadingPoints& s, std::size_t i) const {
    const std::size_t texels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()),
                      index = texel(s, i);
    std::size_t layer = 0;
    const auto put = [&](float x, float y, float z, float w) {
        float* to = layers.data() + 4 * (layer++ * texels + index);
        to[0] = x;
        to[1] = y;
        to[2] = z;
        to[3] = w;
    };
    put(s.wox[i], s.woy[i], s.woz[i], s.s[i]);
    put(s.alpha[i], s.diffuse[i], s.rho_s[i], 0);
    put(s.px[i], s.py[i], s.pz[i], static_cast<float>(s.shape[i]));
    put(s.tx[i], s.ty[i], s.tz[i], s.fill_d[i]);
    put(s.bx[i], s.by[i], s.bz[i], s.fill_s[i]);
    put(s.nx[i], s.ny[i], s.nz[i], static_cast<float>(s.lobe + 1));
    for (const DiskArrays& d : s.disks) {
        put(d.cx[i], d.cy[i], d.cz[i], d.d[i]);
        put(d.nx[i], d.ny[i], d.nz[i], d.s[i]);
    }
    for (const LightArrays& l : s.others) {
        const auto& n = l.numbers;
        put(n[0][i], n[1][i], n[2][i], l.d[i]);
        put(n[3][i], n[4][i], n[5][i], l.s[i]);
        put(n[6][i], n[7][i], n[8][i], n[9][i]);
        put(n[10][i], n[11][i], n[12][i], n[13][i]);
        put(n[14][i], n[15][i], static_cast<float>(l.kind), l.power);
    }
}

void PointTexture::upload(const std::vector<float>& layers, std::size_t layer_count) {
    const Functions& gl = context_.gl();
    gl.GenTextures(1, &texture_);
    bind();
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        gl.TexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
    gl.TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, width(), height(), static_cast<GLsizei>(layer_count), 0, GL_RGBA,
        GL_FLOAT, layers.data());
    context_.check("sending the sites to the device");
}

void PointTexture::bind() const {
    context_.gl().ActiveTexture(GL_TEXTURE0);
    context_.gl().BindTexture(GL_TEXTURE_2D_ARRAY, texture_);
}

std::size_t PointTexture::texel(const ShadingPoints& group, std::size_t i) const {
    const std::size_t x = group.pixel[i] % image_width_, y = group.pixel[i] / image_width_;
    return (y - static_cast<std::size_t>(box_.y0)) * static_cast<std::size_t>(width()) +
        (x - static_cast<std::size_t>(box_.x0));
}

std::vector<int> PointTexture::lobes() const {
    std::vector<int> out;
    for (const ShadingPoints& group : groups_)
        if (std::find(out.begin(), out.end(), group.lobe) == out.end()) out.push_back(group.lobe);
    std::sort(out.begin(), out.end());
    return out;
}

LobePixels PointTexture::pixels_of(int lobe) const {
    const std::size_t columns = static_cast<std::size_t>(width());
    LobePixels out{
        std::vector<std::uint64_t>(static_cast<std::size_t>((height() + strip_rows - 1) / strip_rows)), width(), 0};
    for (const ShadingPoints& group : groups_) {
        for (std::size_t i = 0; group.lobe == lobe && i < group.count; ++i) {
            const std::size_t index = texel(group, i);
            const int x = static_cast<int>(index % columns);
            ++out.strips[index / columns / strip_rows];
            out.x0 = std::min(out.x0, x);
            out.x1 = std::max(out.x1, x + 1);
        }
    }
    return out;
}

LightCounts count_lights(const Scene& scene) {
    return {scene.disk_count(), scene.lights().size() - scene.disk_count()};
}

std::vector<TileBox> rectangles_of(int width, int height, const LightCounts& lights, int largest_texture) {
    const int texels = static_cast<int>((std::size_t{256} << 20) / (16 * point_layers(lights)));
    const int columns = std::min(width, largest_texture);
    const int rows = std::clamp(texels / columns, 1, std::min(height, largest_texture));
    std::vector<TileBox> out;
    for (int y = 0; y < height; y += rows)
        for (int x = 0; x < width; x += columns)
            out.push_back({x, y, std::min(x + columns, width), std::min(y + rows, height)});
    return out;
}

Bodies bodies_of(const std::vector<OccluderF>& occluders) {
    constexpr std::array<std::string_view, 5> order = {"sphere", "box", "quad", "disk", "plane"};
    Bodies out;
    for (const OccluderF& o : occluders)
        if (const std::string_view kind = crescent::Bodies::names[o.kind];
            std::find(order.begin(), order.end(), kind) == order.end())
            throw OutputError("the GL back end has no shadow of a " + std::string(kind) + ": use the cpu");
    for (std::size_t k = 0; k < order.size(); ++k) {
        for (const OccluderF& o : occluders) {
            if (crescent::Bodies::names[o.kind] != order[k]) continue;
            ++out.counts[k];
            out.vectors.push_back({o.a[0], o.a[1], o.a[2], static_cast<float>(o.shape)});
            out.vectors.push_back({o.b[0], o.b[1], o.b[2], o.radius});
            out.vectors.push_back({o.c[0], o.c[1], o.c[2], o.offset});
        }
    }
    return out;
}

}  // namespace crescent::gl
