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
#include "compare/open_file.h"
#include "compare/passes.h"
#include "compare/plan.h"

namespace crescent::inline comparison {

namespace {

struct Magic {
    std::string_view bytes;
    const char* name;
};
/// Formats of pictures for display: 8 bits, tone-mapped, gamma-encoded.
constexpr Magic picture_formats[] = {{"\x89PNG", "PNG"}, {"\xff\xd8\xff", "JPEG"}, {"GIF8", "GIF"}, {"BM", "BMP"},
    {"RIFF", "WebP"}, {"II*", "TIFF"}, {"MM", "TIFF"}, {"P6", "PPM"}};

}  // namespace

Render::Render(std::string path, int w, int h, Empty)
    : file(std::move(path)), width(w), height(h), data{0, 0, w - 1, h - 1}, display(data) {}

Render::Render(std::string path, int w, int h) : Render(std::move(path), w, h, empty) {
    for (std::vector<float>* plane : {&r, &g, &b}) plane->resize(data.pixels());
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
        render.r[i] = static_cast<float>(out[0]), render.g[i] = static_cast<float>(out[1]),
        render.b[i] = static_cast<float>(out[2]);
    }
}

Render read_render(const std::string& path, const std::string& layer) {
    const OpenFile file(path);
    std::array<char, 16> first{};
    const std::string_view head(first.data(), file.read_some(0, first));
    const auto with_state = [&](Render render) {
        file.expect_unchanged();
        render.state = file.state();
        return render;
    };
    if (head.starts_with("\x76\x2f\x31\x01")) return with_state(read_exr(file, layer));
    if (head.starts_with("PF") || head.starts_with("Pf")) return with_state(read_pfm(file));
    if (head.starts_with("#?")) return with_state(read_radiance_hdr(file));
    if (head.starts_with("\x93NUMPY")) return with_state(read_npy(file));
    for (const Magic& picture : picture_formats)
        if (head.starts_with(picture.bytes))
            file.fail(
                fmt::format("expected linear radiance (OpenEXR, PFM, Radiance HDR or NPY), found a {}: it is "
                            "tone-mapped, so radiance cannot be recovered from it",
                    picture.name));
    file.fail(head.empty() ? "expected OpenEXR, PFM, Radiance HDR or NPY, found an empty file"
                           : "expected OpenEXR, PFM, Radiance HDR or NPY, found something else");
}

// ---- Reads every render twice: means first, then the statistics of each render in each region, mask and tile.

namespace {

void add_set(RenderStats& all, PixelSet set, const SourceLocation& at) {
    if (set.pixels.empty()) throw InputError(at, set.name + ": expected a pixel above 0, found none");
    const auto bad = [&](std::uint32_t i) { return all.bad[i]; };
    std::copy_if(set.pixels.begin(), set.pixels.end(), std::back_inserter(set.left_out), bad);
    std::erase_if(set.pixels, bad);
    all.regions.push_back(std::move(set));
}

PixelSet boxed(const std::string& name, const Box& box, int width) {
    PixelSet set{name, box, {}, {}};
    for (int j = box.y0; j <= box.y1; ++j)
        for (int i = box.x0; i <= box.x1; ++i) set.pixels.push_back(static_cast<std::uint32_t>(j * width + i));
    return set;
}

PixelSet masked(CommonView& view, const MaskPlan& plan) {
    const Render mask = view.read_mask(plan.file);
    PixelSet set{plan.name, {}, {}, {}};
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (mask.y(i) > 0) set.pixels.push_back(static_cast<std::uint32_t>(i));
    return set;
}

void regions(const ComparePlan& plan, RenderStats& all, CommonView& view) {
    for (const Region& r : plan.regions) {
        if (r.box.x1 >= all.width || r.box.y1 >= all.height)
            throw InputError(r.at,
                fmt::format("regions.{}.box: expected a box on the image, x from 0 to {} and y from 0 to {}, found "
                            "[{}, {}, {}, {}]",
                    r.name, all.width - 1, all.height - 1, r.box.x0, r.box.y0, r.box.x1, r.box.y1));
        add_set(all, boxed(r.name, r.box, all.width), r.at);
    }
    for (const MaskPlan& m : plan.masks) add_set(all, masked(view, m), m.at);
    add_set(all, boxed(whole_frame, all.frame(), all.width), {plan.file, 0, 0});
}

/// Y alone if every render is grey.
std::size_t quantities_of(const RenderStats& all) {
    const auto in_colour = [](const ArmStats& arm) { return arm.film.planes.size() > 1; };
    const bool any = std::any_of(all.arms.begin(), all.arms.end(), in_colour);
    return any || (all.reference && in_colour(*all.reference)) ? colour_quantities : 1;
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

Render in_rec709(const RenderStats& all, Render render) {
    if (!same_primaries(all.primaries, {})) convert(render, conversion(all.primaries, {}));
    render.primaries = {}, render.weights = luminance_weights_of({});
    return render;
}

Render in_rec709(const RenderStats& all, const MeanFilm& film) {
    Render out("", all.width, all.height, Render::empty);
    out.r = film.radiance(0), out.g = film.radiance(1), out.b = film.radiance(2);
    return in_rec709(all, std::move(out));
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
    for (const RenderArm& arm : plan.arms) out.arms.push_back(source.expand(arm.files, arm.at));
    if (!plan.reference.empty()) out.reference = source.expand(plan.reference, {plan.file, 0, 0});
    for (const auto& files : out.arms) out.total += files.size();
    out.total += out.reference.size();
    return out;
}

void share_windows(CommonView& view, const ComparePlan& plan, const Files& files, ProgressMonitor& monitor) {
    monitor.begin("data windows", static_cast<double>(files.total));
    const auto each = [&](const std::vector<std::string>& paths, const std::string& layer) {
        for (const std::string& path : paths) monitor.check(), view.share(path, layer), monitor.advance(1);
    };
    for (std::size_t a = 0; a < files.arms.size(); ++a) each(files.arms[a], plan.arms[a].layer);
    each(files.reference, plan.reference_layer);
}

}  // namespace

RenderStats read_all(const ComparePlan& plan, ProgressMonitor& monitor, const RenderSource& source) {
    RenderStats all;
    const Files files = files_of(plan, source);
    const auto view = std::make_shared<CommonView>(plan, source.read);
    if (plan.crop) share_windows(*view, plan, files, monitor);
    all.source = source;
    all.source.read = [view](const std::string& path, const std::string& layer) { return view->read(path, layer); };
    monitor.begin("first pass: means", static_cast<double>(files.total));
    FirstPass first(all, monitor);
    all.arms.resize(plan.arms.size());
    for (std::size_t a = 0; a < plan.arms.size(); ++a)
        if (plan.arms[a].moments) first.moments(all.arms[a], files.arms[a].front());
        else first.arm(all.arms[a], files.arms[a], plan.arms[a].layer, plan.arms[a].name, plan.arms[a].spp);
    if (!files.reference.empty())
        first.arm(all.reference.emplace(), files.reference, plan.reference_layer, "the reference", {});
    first.report_warnings();
    all.primaries = view->primaries();
    all.tiles = Tiles(all.width, all.height);
    all.bad_pixels = static_cast<std::uint64_t>(std::count(all.bad.begin(), all.bad.end(), true));
    all.quantities = quantities_of(all);
    regions(plan, all, *view);
    if (plan.find_outliers && !plan.arms[0].moments && !plan.arms[1].moments)
        all.outliers = find_outliers(all, {plan.arms[0].layer, plan.arms[1].layer}, monitor);
    monitor.begin("second pass: statistics of each render", static_cast<double>(files.total));
    const MeanFilm* truth = all.reference ? &all.reference->film : nullptr;
    for (std::size_t a = 0; a < plan.arms.size(); ++a)
        if (plan.arms[a].moments) read_moments_regions(files.arms[a].front(), plan, all, all.arms[a]);
        else second_pass(plan, all, all.source, all.arms[a], plan.arms[a].layer, truth, monitor);
    if (all.reference) second_pass(plan, all, all.source, *all.reference, plan.reference_layer, nullptr, monitor);
    return all;
}

// ---- PFM (Debevec) and NPY: consecutive floats after a header, read a row at a time.

namespace {

float float_at(const char* at, bool swap) {
    char bytes[sizeof(float)];
    std::memcpy(bytes, at, sizeof bytes);
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
            const char* at = bytes.data() + x * h.channels * sizeof(float);
            float* planes[3] = {&out.r[i], &out.g[i], &out.b[i]};
            for (std::size_t c = 0; c < 3; ++c)
                *planes[c] = float_at(at + (h.channels == 3 ? sizeof(float) * c : 0), h.swap);
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
    std::vector<float>* planes[3] = {&out.r, &out.g, &out.b};
    const std::size_t block = std::min<std::size_t>(total, 1u << 16);
    std::vector<char> bytes(block * h.bytes);
    for (std::size_t begin = 0; begin < total; begin += block) {
        const std::size_t n = std::min(block, total - begin);
        file.read(h.end + begin * h.bytes, std::span(bytes).first(n * h.bytes));
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t at = begin + k;  // by rows: (row, column, channel); by columns: the reverse
            const std::size_t row = h.by_column ? at % rows : at / channels / columns;
            const std::size_t column = h.by_column ? at / rows % columns : at / channels % columns;
            const std::size_t channel = h.by_column ? at / rows / columns : at % channels;
            if (channel < 3)
                (*planes[channel])[(rows - 1 - row) * columns + column] =
                    static_cast<float>(npy_number(h, bytes.data() + k * h.bytes));
        }
    }
    if (channels == 1) out.g = out.b = out.r;
    return out;
}

// ---- Radiance HDR (Ward 1991, "Real Pixels"): RGBE or XYZE, scanlines flat or run-length encoded in the old or the
// new format. Memory grows with the scanlines that are read.

namespace {

using Rgbe = std::array<unsigned char, 4>;

struct HdrHeader {
    int width = 0, height = 0;
    bool from_the_top = true, xyz = false;
    Rgb unit{1, 1, 1};  // factor of a stored value
    std::optional<Chromaticities> primaries;
    std::size_t end = 0;
};

/// Returns exactly n numbers from the text after "KEY=".
template <std::size_t n>
std::array<double, n> numbers_of(const TextHeader& in, std::string_view text, const char* what) {
    std::array<double, n> out{};
    const std::vector<std::string_view> words = split_words(text);
    bool good = words.size() == n;
    for (std::size_t i = 0; good && i < n; ++i) good = parse_number(words[i], out[i]) && std::isfinite(out[i]);
    if (!good) in.fail(fmt::format("expected {}", what));
    return out;
}

void read_variable(TextHeader& in, std::string_view line, HdrHeader& out) {
    const std::size_t equals = line.find('=');
    const std::string_view key = line.substr(0, equals);
    const std::string_view value = equals == std::string_view::npos ? "" : line.substr(equals + 1);
    if (key == "FORMAT") {
        const std::vector<std::string_view> words = split_words(value);
        const std::string_view format = words.size() == 1 ? words[0] : "";
        out.xyz = format == "32-bit_rle_xyze";
        if (!out.xyz && format != "32-bit_rle_rgbe")
            in.fail("expected FORMAT=32-bit_rle_rgbe or FORMAT=32-bit_rle_xyze");
    } else if (key == "EXPOSURE") {
        const double by = numbers_of<1>(in, value, "EXPOSURE= and a number above 0")[0];
        if (!(by > 0)) in.fail("expected EXPOSURE= and a number above 0");
        for (double& unit : out.unit) unit /= by;
    } else if (key == "COLORCORR") {
        const auto by = numbers_of<3>(in, value, "COLORCORR= and three numbers above 0");
        for (std::size_t c = 0; c < 3; ++c) {
            if (!(by[c] > 0)) in.fail("expected COLORCORR= and three numbers above 0");
            out.unit[c] /= by[c];
        }
    } else if (key == "PRIMARIES") {
        const auto p = numbers_of<8>(in, value, "PRIMARIES= and eight numbers");
        out.primaries = Chromaticities{{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}, {p[6], p[7]}};
        if (!is_valid(*out.primaries)) in.fail("expected PRIMARIES= of three colours and a white point");
    }
}

HdrHeader hdr_header(const OpenFile& file) {
    TextHeader in(file);
    HdrHeader out;
    for (std::string_view line = in.line(); !split_words(line).empty(); line = in.line()) read_variable(in, line, out);
    const std::vector<std::string_view> size = split_words(in.line());
    const bool known = size.size() == 4 && (size[0] == "-Y" || size[0] == "+Y") && size[2] == "+X" &&
        parse_number(size[1], out.height) && parse_number(size[3], out.width);
    if (!known) in.fail("expected a resolution such as '-Y 540 +X 960'");
    in.check_size(out.width, out.height);
    for (const double unit : out.unit)
        if (!(unit > 0 && std::isfinite(unit))) in.fail("expected an EXPOSURE and a COLORCORR that a float can hold");
    out.from_the_top = size[0] == "-Y";
    out.end = in.end();
    return out;
}

/// Reads pixels from the file, through a buffer.
class Scanlines {
public:
    Scanlines(const OpenFile& file, std::size_t from) : file_(file), next_(from) {}

    void read(std::vector<Rgbe>& row) {
        const Rgbe first = pixel();
        const std::size_t w = row.size();
        if (first[0] == 2 && first[1] == 2 && first[2] < 128 && w >= 8 && w < 32768) {
            if ((std::size_t{first[2]} << 8 | first[3]) != w)
                fail(fmt::format("expected a scanline of {} pixels, found one of {}", w, first[2] << 8 | first[3]));
            for (std::size_t c = 0; c < 4; ++c) read_channel(row, c);
        } else {
            read_flat(row, first);
        }
    }

private:
    /// Reads uncompressed pixels; 1, 1, 1, n repeats the previous pixel n times; n of the next such pixel is multiplied
    /// by 256.
    void read_flat(std::vector<Rgbe>& row, Rgbe next) {
        unsigned shift = 0;
        for (std::size_t i = 0; i < row.size();) {
            if (i > 0 || shift > 0) next = pixel();
            const bool run = next[0] == 1 && next[1] == 1 && next[2] == 1;
            const std::size_t n = run ? (shift < 24 ? std::size_t{next[3]} << shift : row.size() + 1) : 1;
            if (run && i == 0) fail("expected a pixel, found a run of the pixel before the first");
            if (i + n > row.size()) fail("a run of pixels is longer than its scanline");
            const Rgbe value = run ? row[i - 1] : next;
            std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(i), n, value);
            i += n, shift = run ? shift + 8 : 0;
        }
    }
    void read_channel(std::vector<Rgbe>& row, std::size_t c) {
        for (std::size_t i = 0; i < row.size();) {
            const unsigned count = byte();
            const bool run = count > 128;
            const std::size_t n = run ? count - 128 : count;
            if (n == 0 || i + n > row.size()) fail("a run of pixels is empty, or longer than its scanline");
            const unsigned char value = run ? byte() : static_cast<unsigned char>(0);
            for (std::size_t k = 0; k < n; ++k, ++i) row[i][c] = run ? value : byte();
        }
    }
    Rgbe pixel() {
        Rgbe out;
        for (unsigned char& c : out) c = byte();
        return out;
    }
    unsigned char byte() {
        if (at_ == buffer_.size()) {
            buffer_.resize(1u << 16);
            buffer_.resize(file_.read_some(next_, buffer_));
            if (buffer_.empty()) fail("the file is cut off: expected more scanlines");
            next_ += buffer_.size(), at_ = 0;
        }
        return static_cast<unsigned char>(buffer_[at_++]);
    }
    [[noreturn]] void fail(const std::string& message) const {
        file_.fail(fmt::format("byte {}: {}", next_ - buffer_.size() + at_, message));
    }

    const OpenFile& file_;
    std::uint64_t next_;
    std::vector<char> buffer_;
    std::size_t at_ = 0;
};

/// Reverses the order of rows.
void flip_rows(std::vector<float>& plane, std::size_t width) {
    for (std::size_t low = 0, high = plane.size() / width - 1; low < high; ++low, --high)
        std::swap_ranges(plane.begin() + static_cast<std::ptrdiff_t>(low * width),
            plane.begin() + static_cast<std::ptrdiff_t>((low + 1) * width),
            plane.begin() + static_cast<std::ptrdiff_t>(high * width));
}

}  // namespace

Render read_radiance_hdr(const OpenFile& file) {
    const HdrHeader h = hdr_header(file);
    file.expect_bytes(h.end, std::uint64_t{4} * static_cast<std::uint64_t>(h.height),
        fmt::format("the header promises {} scanlines", h.height));
    Render out(file.path(), h.width, h.height, Render::empty);
    out.rounding = 0x1p-8;
    Scanlines in(file, h.end);
    std::vector<Rgbe> row(static_cast<std::size_t>(h.width));
    std::vector<float>* planes[3] = {&out.r, &out.g, &out.b};
    for (int line = 0; line < h.height; ++line) {
        in.read(row);
        for (const Rgbe& pixel : row) {
            const double scale = pixel[3] ? std::ldexp(1, pixel[3] - 136) : 0;
            for (std::size_t c = 0; c < 3; ++c)
                planes[c]->push_back(static_cast<float>(pixel[c] * (h.unit[c] * scale)));
        }
    }
    if (h.from_the_top)
        for (std::vector<float>* plane : planes) flip_rows(*plane, row.size());
    if (h.xyz) from_xyz(out);
    else if (h.primaries) out.primaries = *h.primaries, out.weights = luminance_weights_of(*h.primaries);
    return out;
}

}  // namespace crescent::inline comparison
