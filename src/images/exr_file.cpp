// The headers of OpenEXR files, and their chunks.
#include "images/exr_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/parallel.h"

namespace crescent {

namespace {

int64_t read_bytes(
    exr_const_context_t, void* file, void* to, uint64_t size, uint64_t from, exr_stream_error_func_ptr_t) {
    try {
        return static_cast<int64_t>(
            static_cast<const OpenFile*>(file)->read_some(from, {static_cast<char*>(to), size}));
    } catch (const InputError&) { return -1; }
}

int64_t file_size(exr_const_context_t, void* file) {
    return static_cast<int64_t>(static_cast<const OpenFile*>(file)->size());
}

PixelWindow window_of(const exr_attr_box2i_t& box) { return {box.min.x, box.min.y, box.max.x, box.max.y}; }

void check_window(const OpenFile& file, const char* attribute, const PixelWindow& w) {
    if (w.empty() || w.width() > most_pixels_a_side || w.height() > most_pixels_a_side)
        file.fail(fmt::format("attribute '{}': expected 1 to {} pixels a side, found {} x {}", attribute,
            most_pixels_a_side, w.width(), w.height()));
}

std::optional<Chromaticities> primaries_of(const OpenFile& file, const exr_attribute_t& attribute) {
    const exr_attr_chromaticities_t& c = *attribute.chromaticities;
    const auto point = [](float x, float y) {
        return std::array<double, 2>{static_cast<double>(x), static_cast<double>(y)};
    };
    const Chromaticities out{.red = point(c.red_x, c.red_y),
        .green = point(c.green_x, c.green_y),
        .blue = point(c.blue_x, c.blue_y),
        .white = point(c.white_x, c.white_y)};
    if (!is_valid(out))
        file.fail(fmt::format(
            "attribute '{}': expected three primaries and a white point, found {}", attribute.name, to_string(out)));
    return out;
}

void read_attributes(const OpenFile& file, exr_const_context_t context, ExrPart& part) {
    std::int32_t count = 0;
    expect_success(file, exr_get_attribute_count(context, part.index, &count));
    for (std::int32_t i = 0; i < count; ++i) {
        const exr_attribute_t* a = nullptr;
        expect_success(file, exr_get_attribute_by_index(context, part.index, EXR_ATTR_LIST_FILE_ORDER, i, &a));
        ExrAttribute attribute{a->name, {}, "", {}};
        if (a->type == EXR_ATTR_INT) attribute.number = a->i;
        if (a->type == EXR_ATTR_FLOAT) attribute.number = static_cast<double>(a->f);
        if (a->type == EXR_ATTR_DOUBLE) attribute.number = a->d;
        if (a->type == EXR_ATTR_STRING && a->string->str)
            attribute.text.assign(a->string->str, static_cast<std::size_t>(std::max(0, a->string->length)));
        if (a->type == EXR_ATTR_FLOAT_VECTOR && a->floatvector->arr)
            attribute.numbers.assign(
                a->floatvector->arr, a->floatvector->arr + std::max<std::int32_t>(0, a->floatvector->length));
        if (a->type == EXR_ATTR_CHROMATICITIES && attribute.name == "chromaticities")
            part.primaries = primaries_of(file, *a);
        part.attributes.push_back(std::move(attribute));
    }
}

void read_channels(const OpenFile& file, exr_const_context_t context, ExrPart& part) {
    const exr_attr_chlist_t* list = nullptr;
    expect_success(file, exr_get_channels(context, part.index, &list));
    for (int i = 0; i < list->num_channels; ++i) {
        const exr_attr_chlist_entry_t& c = list->entries[i];
        if (c.x_sampling < 1 || c.y_sampling < 1)
            file.fail(fmt::format("channel '{}': expected a sampling of 1 or more, found {} x {}", c.name.str,
                c.x_sampling, c.y_sampling));
        part.channels.push_back(
            {c.name.str, c.pixel_type == EXR_PIXEL_HALF, c.pixel_type == EXR_PIXEL_UINT, c.x_sampling, c.y_sampling});
    }
}

ExrPart part_of(const OpenFile& file, exr_const_context_t context, int index) {
    ExrPart part;
    part.index = index;
    const char* name = nullptr;
    if (exr_get_name(context, index, &name) == EXR_ERR_SUCCESS && name) part.name = name;
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    expect_success(file, exr_get_storage(context, index, &storage));
    part.deep = storage == EXR_STORAGE_DEEP_SCANLINE || storage == EXR_STORAGE_DEEP_TILED;
    part.tiled = storage == EXR_STORAGE_TILED || storage == EXR_STORAGE_DEEP_TILED;
    expect_success(file, exr_get_compression(context, index, &part.compression));
    exr_attr_box2i_t box{};
    expect_success(file, exr_get_data_window(context, index, &box));
    part.data = window_of(box);
    expect_success(file, exr_get_display_window(context, index, &box));
    part.display = window_of(box);
    check_window(file, "dataWindow", part.data);
    check_window(file, "displayWindow", part.display);
    read_channels(file, context, part);
    read_attributes(file, context, part);
    return part;
}

}  // namespace

const ExrChannel* ExrPart::channel(const std::string& channel_name) const {
    const auto match =
        std::find_if(channels.begin(), channels.end(), [&](const ExrChannel& c) { return c.name == channel_name; });
    return match == channels.end() ? nullptr : &*match;
}

ExrFile::ExrFile(const OpenFile& file) : file_(file) {
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_message;
    start.user_data = const_cast<OpenFile*>(&file);
    start.read_fn = read_bytes;
    start.size_fn = file_size;
    start.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    clear_message();
    expect_success(file, exr_start_read(&context_, file.path().c_str(), &start));
    try {
        expect_no_message(file);
        int count = 0;
        expect_success(file, exr_get_count(context_, &count));
        for (int i = 0; i < count; ++i) parts_.push_back(part_of(file, context_, i));
    } catch (...) {
        exr_finish(&context_);
        throw;
    }
}

ExrFile::~ExrFile() { exr_finish(&context_); }

// ---- Chunk by chunk: OpenEXR's table of offsets, the least size of each chunk, and its contents.

namespace {

thread_local std::string last_message;

/// Returns the largest number of bytes that one byte of a chunk can decode to. RLE: two bytes give 128. zlib: 1032 (its
/// authors' bound); PXR24 drops one byte of four before it. PIZ: a run of 255 half values needs at least 9 bits. B44:
/// three bytes give 32. DWA: a block of 64 pixels has at least one half value, compressed by zlib.
double most_per_byte(exr_compression_t compression) {
    switch (compression) {
        case EXR_COMPRESSION_NONE: return 1;
        case EXR_COMPRESSION_RLE: return 64;
        case EXR_COMPRESSION_ZIPS:
        case EXR_COMPRESSION_ZIP: return 1032;
        case EXR_COMPRESSION_PXR24: return 1376;
        case EXR_COMPRESSION_PIZ: return 512;
        case EXR_COMPRESSION_B44:
        case EXR_COMPRESSION_B44A: return 11;
        default: return 64 * 1032;
    }
}

/// A tile may be larger than the picture up to this number of pixels: 1024 x 1024.
constexpr std::size_t large_tile = std::size_t{1} << 20;

std::int64_t in_steps(std::int64_t size, std::int64_t step) { return (size + step - 1) / step; }

/// Destroys the decoder and its buffers.
struct Decoder {
    exr_const_context_t context;
    exr_decode_pipeline_t pipeline{};
    ~Decoder() { exr_decoding_destroy(context, &pipeline); }
};

}  // namespace

void keep_message(exr_const_context_t, exr_result_t, const char* message) { last_message = message ? message : ""; }

void clear_message() { last_message.clear(); }

void expect_success(const OpenFile& file, exr_result_t result) {
    if (result == EXR_ERR_SUCCESS) return;
    if (last_message.empty()) last_message = exr_get_default_error_message(result);
    expect_no_message(file);
}

void expect_no_message(const OpenFile& file) {
    if (last_message.empty()) return;
    const std::string why = std::move(last_message);
    last_message.clear();
    file.fail("expected an OpenEXR file that can be read: " + why);
}

ExrChunks::ExrChunks(const OpenFile& file, exr_const_context_t context, const ExrPart& part)
    : file_(file), context_(context), part_(part) {
    std::uint32_t w = static_cast<std::uint32_t>(part.data.width()), h = 0;
    std::int32_t rows = 0;
    exr_tile_level_mode_t levels{};
    exr_tile_round_mode_t rounding{};
    if (part.tiled) expect_success(file, exr_get_tile_descriptor(context, part.index, &w, &h, &levels, &rounding));
    else {
        expect_success(file, exr_get_scanlines_per_chunk(context, part.index, &rows));
        h = static_cast<std::uint32_t>(std::max(0, rows));
    }
    const PixelWindow chunk{0, 0, std::int64_t{w} - 1, std::int64_t{h} - 1};
    const bool has_valid_size = !chunk.empty() && w <= most_pixels_a_side && h <= most_pixels_a_side;
    if (!has_valid_size || (part.tiled && chunk.pixels() > std::max(large_tile, 4 * part.data.pixels())))
        file.fail(fmt::format("attribute 'tiles': expected tiles that fit {} x {} pixels, found {} x {}",
            part.data.width(), part.data.height(), w, h));
    width_ = w;
    height_ = h;
    columns_ = in_steps(part.data.width(), w);
    count_ = columns_ * in_steps(part.data.height(), h);
}

exr_chunk_info_t ExrChunks::info(std::int64_t chunk) const {
    exr_chunk_info_t out{};
    expect_success(file_,
        part_.tiled ? exr_read_tile_chunk_info(context_, part_.index, static_cast<int>(chunk % columns_),
                          static_cast<int>(chunk / columns_), 0, 0, &out)
                    : exr_read_scanline_chunk_info(
                          context_, part_.index, static_cast<int>(part_.data.y0 + chunk * height_), &out));
    return out;
}

PixelWindow ExrChunks::window(std::int64_t chunk) const {
    const std::int64_t x = part_.data.x0 + chunk % columns_ * width_, y = part_.data.y0 + chunk / columns_ * height_;
    return intersection(part_.data, {x, y, x + width_ - 1, y + height_ - 1});
}

std::size_t ExrChunks::samples(int sampling, std::int64_t first, std::int64_t pixels) {
    const auto samples_below = [&](std::int64_t x) {
        return static_cast<std::int64_t>(std::ceil(static_cast<double>(x) / sampling));
    };
    return static_cast<std::size_t>(samples_below(first + pixels) - samples_below(first));
}

std::uint64_t ExrChunks::unpacked_size(const PixelWindow& w) const {
    std::uint64_t bytes = 0;
    for (const ExrChannel& c : part_.channels)
        bytes += samples(c.x_sampling, w.x0, w.width()) * samples(c.y_sampling, w.y0, w.height()) * c.bytes();
    return bytes;
}

void ExrChunks::check() const {
    std::uint64_t packed = 0;
    const double largest_ratio = most_per_byte(part_.compression);
    for (std::int64_t k = 0; k < count_; ++k) {
        const exr_chunk_info_t chunk = info(k);
        const PixelWindow w = window(k);
        const std::uint64_t unpacked = unpacked_size(w);
        packed += chunk.packed_size;
        const bool is_uncompressed = part_.compression == EXR_COMPRESSION_NONE;
        if (is_uncompressed ? chunk.packed_size != unpacked
                            : static_cast<double>(chunk.packed_size) * largest_ratio < static_cast<double>(unpacked))
            file_.fail(fmt::format(
                "block {} of {} at byte {}: expected {}{} bytes for {} x {} pixels of {} channels, "
                "found {}",
                k + 1, count_, chunk.data_offset, is_uncompressed ? "" : "at least ",
                is_uncompressed ? unpacked
                                : static_cast<std::uint64_t>(std::ceil(static_cast<double>(unpacked) / largest_ratio)),
                w.width(), w.height(), part_.channels.size(), chunk.packed_size));
    }
    if (packed > file_.size())
        file_.fail(fmt::format("blocks overlap: they have {} bytes, the file {}", packed, file_.size()));
}

void ExrChunks::each(const std::function<void(const PixelWindow&, std::span<const char>)>& use) const {
    parallel_for(std::int64_t{0}, count_, [&](std::int64_t k) {
        const exr_chunk_info_t chunk = info(k);
        const std::uint64_t size = unpacked_size(window(k));
        if (chunk.packed_size == size) {  // stored uncompressed, because compression would not make it smaller
            std::vector<char> bytes(size);
            expect_success(file_, exr_read_chunk(context_, part_.index, &chunk, bytes.data()));
            return use(window(k), bytes);
        }
        if (size != chunk.unpacked_size)
            file_.fail(fmt::format(
                "block {} of {}: expected {} bytes of pixels, found {}", k + 1, count_, size, chunk.unpacked_size));
        Decoder decoder{context_};
        exr_decode_pipeline_t& p = decoder.pipeline;
        expect_success(file_, exr_decoding_initialize(context_, part_.index, &chunk, &p));
        expect_success(file_, exr_decoding_choose_default_routines(context_, part_.index, &p));
        p.unpack_and_convert_fn = nullptr;  // OpenEXR 3.1 writes through null pointers of channels that are not read
        expect_success(file_, exr_decoding_run(context_, part_.index, &p));
        use(window(k), {static_cast<const char*>(p.unpacked_buffer), static_cast<std::size_t>(size)});
    });
}

}  // namespace crescent
