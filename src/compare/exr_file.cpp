// Headers.
#include "compare/exr_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.h"
#include "compare/exr_chunks.h"

namespace crescent::inline comparing {

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
    const Chromaticities out{
        point(c.red_x, c.red_y), point(c.green_x, c.green_y), point(c.blue_x, c.blue_y), point(c.white_x, c.white_y)};
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
        ExrAttribute attribute{a->name, {}, ""};
        if (a->type == EXR_ATTR_INT) attribute.number = a->i;
        if (a->type == EXR_ATTR_FLOAT) attribute.number = static_cast<double>(a->f);
        if (a->type == EXR_ATTR_DOUBLE) attribute.number = a->d;
        if (a->type == EXR_ATTR_STRING && a->string->str)
            attribute.text.assign(a->string->str, static_cast<std::size_t>(std::max(0, a->string->length)));
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

const ExrChannel* ExrPart::channel(const std::string& wanted) const {
    const auto at =
        std::find_if(channels.begin(), channels.end(), [&](const ExrChannel& c) { return c.name == wanted; });
    return at == channels.end() ? nullptr : &*at;
}

bool ExrPart::subsampled() const {
    return std::any_of(
        channels.begin(), channels.end(), [](const ExrChannel& c) { return c.x_sampling != 1 || c.y_sampling != 1; });
}

ExrFile::ExrFile(const OpenFile& file) : file_(file) {
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_message;
    start.user_data = const_cast<OpenFile*>(&file);
    start.read_fn = read_bytes, start.size_fn = file_size;
    start.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    forget_messages();
    expect_success(file, exr_start_read(&context_, file.path().c_str(), &start));
    try {
        expect_silence(file);
        int count = 0;
        expect_success(file, exr_get_count(context_, &count));
        for (int i = 0; i < count; ++i) parts_.push_back(part_of(file, context_, i));
    } catch (...) {
        exr_finish(&context_);
        throw;
    }
}

ExrFile::~ExrFile() { exr_finish(&context_); }

}  // namespace crescent::inline comparing
