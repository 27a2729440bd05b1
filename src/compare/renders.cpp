// Finds the format of a file by its first bytes.
#include "compare/renders.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <future>
#include <memory>
#include <string_view>

#include "base/errors.h"
#include "base/npy.h"
#include "compare/exr_render.h"
#include "compare/moments_reading.h"
#include "compare/passes.h"
#include "compare/plan.h"
#include "compare/view.h"
#include "images/open_file.h"
#include "output/tone_map.h"

namespace crescent {

Render::Render(std::string path, int w, int h, Empty)
    : file(std::move(path)), width(w), height(h), data{0, 0, w - 1, h - 1}, display(data) {}

Render::Render(std::string path, int w, int h) : Render(std::move(path), w, h, empty) {
    for (std::vector<float>* plane : {&r, &g, &b}) plane->resize(data.pixels());
}

bool Render::is_uniform() const {
    const auto is_constant = [](const std::vector<float>& plane) {
        return std::all_of(plane.begin(), plane.end(), [&](float value) { return value == plane[0]; });
    };
    return is_constant(r) && is_constant(g) && is_constant(b);
}

bool Render::is_finite(std::size_t i) const {
    return std::isfinite(r[i]) && std::isfinite(g[i]) && std::isfinite(b[i]) &&
        (alpha.empty() || std::isfinite(alpha[i]));
}

float Render::y(std::size_t i) const {
    const double rgb[3] = {static_cast<double>(r[i]), static_cast<double>(g[i]), static_cast<double>(b[i])};
    return static_cast<float>(weights[0] * rgb[0] + weights[1] * rgb[1] + weights[2] * rgb[2]);
}

void from_xyz(Render& render) {
    const Matrix3 m = xyz_to_rgb({});
    convert(render, m);
    render.primaries = {};
    render.weights = luminance_weights_of({});
}

void convert(Render& render, const Matrix3& m) {
    for (std::size_t i = 0; i < render.size(); ++i) {
        const Rgb out = transformed(
            m, {static_cast<double>(render.r[i]), static_cast<double>(render.g[i]), static_cast<double>(render.b[i])});
        render.r[i] = static_cast<float>(out[0]);
        render.g[i] = static_cast<float>(out[1]);
        render.b[i] = static_cast<float>(out[2]);
    }
}

namespace {

/// Returns the render with the channels that are tested: all of a file's, or one alone.
Render kept(Render render, const ReadingOptions& options) {
    if (!options.channel.empty()) {
        const std::vector<std::pair<std::string, std::vector<float>*>> channels = {
            {"R", &render.r}, {"G", &render.g}, {"B", &render.b}, {"A", &render.alpha}};
        const auto match = std::find_if(
            channels.begin(), channels.end(), [&](const auto& channel) { return channel.first == options.channel; });
        if (match == channels.end() || match->second->empty())
            throw InputError({render.file, 0, 0},
                fmt::format(
                    "no channel '{}': expected one of R, G, B{}", options.channel, render.alpha.empty() ? "" : ", A"));
        if (options.channel == "A") render.steps.srgb = false;
        const std::vector<float> plane = *match->second;
        render.r = render.g = render.b = plane;
    }
    if (options.channels == TestedChannels::rgb || !options.channel.empty()) render.alpha.clear();
    else if (render.alpha.empty())
        throw InputError({render.file, 0, 0}, "channels = \"rgba\": expected an alpha channel, found none");
    return render;
}

}  // namespace

Render read_render(const std::string& path, const std::string& layer, const ReadingOptions& options) {
    const OpenFile file(path);
    std::array<char, lfs_pointer.size()> first{};
    const std::string_view head(first.data(), file.read_some(0, first));
    const auto with_state = [&](Render render) {
        file.expect_unchanged();
        render.state = file.state();
        return render;
    };
    if (head.starts_with("\x76\x2f\x31\x01")) return with_state(read_exr(file, layer, options));
    const bool is_read = head.starts_with("PF") || head.starts_with("Pf") || head.starts_with("\x93NUMPY");
    if (!layer.empty() && (is_read || is_image(file, head)))
        file.fail(
            fmt::format("no layer '{}': only OpenEXR files have layers; leave out --layer, or the key layer, of "
                        "this arm",
                layer));
    if (head.starts_with("PF") || head.starts_with("Pf")) return with_state(kept(read_pfm(file), options));
    if (head.starts_with("\x93NUMPY")) return with_state(kept(read_npy(file), options));
    if (is_image(file, head)) return with_state(kept(read_image(file, options), options));
    file.fail(fmt::format("expected {}, found {}", readable_formats,
        head.empty()              ? "an empty file"
            : head == lfs_pointer ? "a pointer of Git LFS: run git lfs pull"
                                  : "something else"));
}

RenderSource files_read_with(const ReadingOptions& options) {
    RenderSource out;
    out.read = [options](
                   const std::string& path, const std::string& layer) { return read_render(path, layer, options); };
    return out;
}

// ---- Reads every render twice: means first, then the statistics of each render in each region, mask and tile.

namespace {

void add_set(RenderStats& stats, PixelSet set, const SourceLocation& place) {
    if (set.pixels.empty()) throw InputError(place, set.name + ": expected a pixel above 0, found none");
    const auto is_bad = [&](std::uint32_t i) { return stats.bad[i]; };
    std::copy_if(set.pixels.begin(), set.pixels.end(), std::back_inserter(set.left_out), is_bad);
    std::erase_if(set.pixels, is_bad);
    stats.regions.push_back(std::move(set));
}

PixelSet boxed(const std::string& name, const Box& box, int width) {
    PixelSet set{name, box, {}, {}};
    for (int j = box.y0; j <= box.y1; ++j)
        for (int i = box.x0; i <= box.x1; ++i) set.pixels.push_back(static_cast<std::uint32_t>(j * width + i));
    return set;
}

PixelSet masked(CommonView& view, const MaskPlan& plan) {
    const Render mask = view.read_mask(plan.file);
    PixelSet set{.name = plan.name, .box = {}, .pixels = {}, .left_out = {}};
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (mask.y(i) > 0) set.pixels.push_back(static_cast<std::uint32_t>(i));
    return set;
}

void regions(const ComparePlan& plan, RenderStats& stats, CommonView& view) {
    for (const Region& r : plan.regions) {
        if (r.box.x1 >= stats.width || r.box.y1 >= stats.height)
            throw InputError(r.location,
                fmt::format(
                    "{}expected a box on the images of {} x {} pixels{}, x from 0 to {} and y from 0 to {}, found "
                    "[{}, {}, {}, {}]",
                    r.location.line > 0 ? fmt::format("regions.{}.box: ", r.name) : "", stats.width, stats.height,
                    stats.arms[0].files.empty() ? "" : fmt::format(" ({})", stats.arms[0].files[0].path),
                    stats.width - 1, stats.height - 1, r.box.x0, r.box.y0, r.box.x1, r.box.y1));
        add_set(stats, boxed(r.name, r.box, stats.width), r.location);
    }
    for (const MaskPlan& m : plan.masks) add_set(stats, masked(view, m), m.location);
    add_set(stats, boxed(whole_frame, stats.frame(), stats.width), {plan.file, 0, 0});
}

/// Y alone if every render is grey.
std::size_t quantities_of(const RenderStats& stats) {
    const auto in_colour = [](const ArmStats& arm) { return arm.film.planes.size() > 1; };
    const bool has_colour = std::any_of(stats.arms.begin(), stats.arms.end(), in_colour);
    if (!stats.arms.empty() && stats.arms[0].film.planes.size() == most_quantities) return most_quantities;
    return has_colour || (stats.reference && in_colour(*stats.reference)) ? colour_quantities : 1;
}

}  // namespace

void each_render(const RenderSource& source, const std::vector<std::string>& paths, const std::string& layer,
    ProgressMonitor& monitor, const std::function<void(const Render&)>& use) {
    const auto start = [&](std::size_t k) {
        return std::async(std::launch::async, [&source, &layer, path = paths[k]] { return source.read(path, layer); });
    };
    std::future<Render> next = start(0);
    for (std::size_t k = 0; k < paths.size(); ++k) {
        const Render render = next.get();
        monitor.check();
        if (k + 1 < paths.size()) next = start(k + 1);
        use(render);
        monitor.advance(1);
    }
}

Render in_rec709(const RenderStats& stats, Render render) {
    if (!same_primaries(stats.primaries, {})) convert(render, conversion(stats.primaries, {}));
    render.primaries = {};
    render.weights = luminance_weights_of({});
    return render;
}

Render in_rec709(const RenderStats& stats, const MeanFilm& film) {
    Render out("", stats.width, stats.height, Render::empty);
    out.r = film.radiance(0);
    out.g = film.radiance(1);
    out.b = film.radiance(2);
    if (stats.displayed)
        for (std::vector<float>* plane : {&out.r, &out.g, &out.b})
            for (float& value : *plane) value = static_cast<float>(srgb_decode(static_cast<double>(value)));
    return in_rec709(stats, std::move(out));
}

namespace {

/// The files of every arm, then those of the reference.
struct Files {
    std::vector<std::vector<std::string>> arms;
    std::vector<std::string> reference;
    std::size_t total = 0;
};

Files files_of(const ComparePlan& plan, const RenderSource& source) {
    Files out;
    for (const RenderArm& arm : plan.arms) out.arms.push_back(source.expand(arm.files, arm.location));
    if (!plan.reference.empty()) out.reference = source.expand(plan.reference, {plan.file, 0, 0});
    for (const auto& files : out.arms) out.total += files.size();
    out.total += out.reference.size();
    return out;
}

void share_windows(CommonView& view, const ComparePlan& plan, const Files& files, ProgressMonitor& monitor) {
    monitor.begin("data windows", static_cast<double>(files.total));
    const auto share_files = [&](const std::vector<std::string>& paths, const std::string& layer) {
        for (const std::string& path : paths) {
            monitor.check();
            view.share(path, layer);
            monitor.advance(1);
        }
    };
    for (std::size_t a = 0; a < files.arms.size(); ++a) share_files(files.arms[a], plan.arms[a].layer);
    share_files(files.reference, plan.reference_layer);
}

}  // namespace

RenderStats read_all(const ComparePlan& plan, ProgressMonitor& monitor) {
    return read_all(plan, monitor, files_read_with(plan.reading()));
}

RenderStats read_all(const ComparePlan& plan, ProgressMonitor& monitor, const RenderSource& source) {
    RenderStats stats;
    const Files files = files_of(plan, source);
    const auto view = std::make_shared<CommonView>(plan, source.read);
    if (plan.crop) share_windows(*view, plan, files, monitor);
    stats.source = source;
    stats.source.read = [view](const std::string& path, const std::string& layer) { return view->read(path, layer); };
    monitor.begin("first pass: means", static_cast<double>(files.total));
    FirstPass first(stats, monitor);
    stats.arms.resize(plan.arms.size());
    for (std::size_t a = 0; a < plan.arms.size(); ++a)
        if (plan.arms[a].moments) first.moments(stats.arms[a], files.arms[a].front());
        else first.arm(stats.arms[a], files.arms[a], plan.arms[a].layer, plan.arms[a].name, plan.arms[a].spp);
    if (!files.reference.empty())
        first.arm(stats.reference.emplace(), files.reference, plan.reference_layer, "the reference", {});
    first.report_warnings();
    stats.primaries = view->primaries();
    stats.tiles = Tiles(stats.width, stats.height);
    stats.bad_pixels = static_cast<std::uint64_t>(std::count(stats.bad.begin(), stats.bad.end(), true));
    stats.quantities = quantities_of(stats);
    regions(plan, stats, *view);
    if (plan.find_outliers && !plan.arms[0].moments && !plan.arms[1].moments)
        stats.outliers = find_outliers(stats, {plan.arms[0].layer, plan.arms[1].layer}, monitor);
    monitor.begin("second pass: statistics of each render", static_cast<double>(files.total));
    const MeanFilm* truth = stats.reference ? &stats.reference->film : nullptr;
    for (std::size_t a = 0; a < plan.arms.size(); ++a)
        if (plan.arms[a].moments) read_moments_regions(files.arms[a].front(), plan, stats, stats.arms[a]);
        else second_pass(plan, stats, stats.source, stats.arms[a], plan.arms[a].layer, truth, monitor);
    if (stats.reference)
        second_pass(plan, stats, stats.source, *stats.reference, plan.reference_layer, nullptr, monitor);
    return stats;
}

// ---- PFM (Debevec) and NPY: consecutive floats after a header, read a row at a time.

namespace {

float float_at(const char* bytes_in, bool swap) {
    char bytes[sizeof(float)];
    std::memcpy(bytes, bytes_in, sizeof bytes);
    if (swap) std::reverse(bytes, bytes + sizeof bytes);
    float out;
    std::memcpy(&out, bytes, sizeof out);
    return out;
}

struct PfmHeader {
    int width = 0, height = 0;
    std::size_t channels = 1, end = 0;
    bool swap = false;
};

PfmHeader pfm_header(const OpenFile& file) {
    TextHeader in(file);
    PfmHeader out;
    const std::vector<std::string_view> kind = split_words(in.line());
    if (kind.size() != 1 || (kind[0] != "PF" && kind[0] != "Pf")) in.fail("expected 'PF' (colour) or 'Pf' (grey)");
    out.channels = kind[0] == "PF" ? 3 : 1;
    std::vector<std::string_view> size = split_words(in.line());
    if (size.size() == 1)  // width and height on two lines
        for (const std::string_view word : split_words(in.line())) size.push_back(word);
    if (size.size() != 2 || !parse_number(size[0], out.width) || !parse_number(size[1], out.height))
        in.fail("expected a width and a height in pixels, such as '960 540'");
    in.check_size(out.width, out.height);
    const std::vector<std::string_view> last = split_words(in.line());
    double scale = 0;
    if (last.size() != 1 || !parse_number(last[0], scale) || scale == 0 || !std::isfinite(scale))
        in.fail("expected a scale that is not 0, such as '-1.0'");
    out.swap = (scale > 0) == (std::endian::native == std::endian::little);  // positive: big-endian
    out.end = in.end();
    return out;
}

}  // namespace

Render read_pfm(const OpenFile& file) {
    const PfmHeader h = pfm_header(file);
    const std::size_t row = static_cast<std::size_t>(h.width) * h.channels * sizeof(float);
    file.expect_bytes(h.end, row * static_cast<std::size_t>(h.height),
        fmt::format("the header promises {} x {} pixels of {} floats", h.width, h.height, h.channels));
    Render out(file.path(), h.width, h.height);
    std::vector<char> bytes(row);
    for (std::size_t j = 0, i = 0; j < static_cast<std::size_t>(h.height); ++j) {
        file.read(h.end + j * row, bytes);
        for (std::size_t x = 0; x < static_cast<std::size_t>(h.width); ++x, ++i) {
            const char* source = bytes.data() + x * h.channels * sizeof(float);
            float* planes[3] = {&out.r[i], &out.g[i], &out.b[i]};
            for (std::size_t c = 0; c < 3; ++c)
                *planes[c] = float_at(source + (h.channels == 3 ? sizeof(float) * c : 0), h.swap);
        }
    }
    return out;
}

Render read_npy(const OpenFile& file) {
    std::string first(longest_npy_header, '\0');
    first.resize(file.read_some(0, first));
    const NpyHeader h = read_npy_header(file.path(), first);
    const bool colour = h.shape.size() == 3;
    const std::uint64_t channels = colour ? h.shape[2] : 1;
    if (!(colour || h.shape.size() == 2) || !(channels == 1 || channels == 3 || channels == 4))
        file.fail(
            fmt::format("NPY header: expected a shape of height x width, or height x width x 1, 3 or 4, rows from "
                        "the top, found ({})",
                fmt::join(h.shape, ", ")));
    for (const std::uint64_t side : {h.shape[0], h.shape[1]})
        if (side < 1 || side > static_cast<std::uint64_t>(most_pixels_a_side))
            file.fail(fmt::format("NPY header: expected 1 to {} pixels a side, found {} x {}", most_pixels_a_side,
                h.shape[1], h.shape[0]));
    const std::size_t rows = h.shape[0], columns = h.shape[1], total = rows * columns * channels;
    file.expect_bytes(h.end, total * h.bytes,
        fmt::format("the header promises {} x {} x {} floats of {} bytes", rows, columns, channels, h.bytes));
    Render out(file.path(), static_cast<int>(columns), static_cast<int>(rows));
    if (h.bytes == 2) out.rounding = 0x1p-11;
    if (channels == 4) out.alpha.resize(out.data.pixels());
    std::vector<float>* planes[4] = {&out.r, &out.g, &out.b, &out.alpha};
    const std::size_t block = std::min<std::size_t>(total, 1u << 16);
    std::vector<char> bytes(block * h.bytes);
    for (std::size_t begin = 0; begin < total; begin += block) {
        const std::size_t n = std::min(block, total - begin);
        file.read(h.end + begin * h.bytes, std::span(bytes).first(n * h.bytes));
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t index = begin + k;  // by rows: (row, column, channel); by columns: the reverse
            const std::size_t row = h.by_column ? index % rows : index / channels / columns;
            const std::size_t column = h.by_column ? index / rows % columns : index / channels % columns;
            const std::size_t channel = h.by_column ? index / rows / columns : index % channels;
            (*planes[channel])[(rows - 1 - row) * columns + column] =
                static_cast<float>(npy_number(h, bytes.data() + k * h.bytes));
        }
    }
    if (channels == 1) out.g = out.b = out.r;
    return out;
}

}  // namespace crescent
