// All renders must have the windows, size and primaries of the first, or are converted to them.
#include "compare/view.h"

#include <algorithm>
#include <fmt/format.h>
#include <xxhash.h>

#include "base/errors.h"

namespace crescent {

namespace {

constexpr std::size_t common_frame = std::size_t{1} << 24;  // pixels: 4096 x 4096
constexpr std::size_t largest_frame_over_data = 64;

std::string shown(const PixelWindow& w) { return fmt::format("({}, {}) to ({}, {})", w.x0, w.y0, w.x1, w.y1); }

/// Returns "(2, 0)", or the differences of both corners if they are not equal.
std::string difference(const PixelWindow& a, const PixelWindow& b) {
    const std::int64_t x0 = a.x0 - b.x0, y0 = a.y0 - b.y0, x1 = a.x1 - b.x1, y1 = a.y1 - b.y1;
    if (x0 == x1 && y0 == y1) return fmt::format("({}, {})", x0, y0);
    return fmt::format("({}, {}) at the top left and ({}, {}) at the bottom right", x0, y0, x1, y1);
}

std::uint64_t hash_of(const Render& render) {
    XXH3_state_t* state = XXH3_createState();
    XXH3_64bits_reset(state);
    for (const std::vector<float>* plane : {&render.r, &render.g, &render.b, &render.alpha})
        XXH3_64bits_update(state, plane->data(), plane->size() * sizeof(float));
    const std::uint64_t hash = XXH3_64bits_digest(state);
    XXH3_freeState(state);
    return hash;
}

/// Returns a plane of window `from` in window `to`: 0 outside.
std::vector<float> placed(const std::vector<float>& plane, const PixelWindow& from, const PixelWindow& to) {
    std::vector<float> out(to.pixels(), 0.0f);
    const PixelWindow overlap = intersection(from, to);
    if (overlap.empty()) return out;
    for (std::int64_t y = overlap.y0; y <= overlap.y1; ++y) {  // rows are bottom-up
        const std::int64_t source = (from.y1 - y) * from.width() + (overlap.x0 - from.x0);
        const std::int64_t target = (to.y1 - y) * to.width() + (overlap.x0 - to.x0);
        std::copy_n(plane.begin() + source, overlap.width(), out.begin() + target);
    }
    return out;
}

void place(Render& render, const PixelWindow& to) {
    if (render.data == to) return;
    for (std::vector<float>* plane : {&render.r, &render.g, &render.b, &render.alpha, &render.variance})
        if (!plane->empty()) *plane = placed(*plane, render.data, to);
    render.width = static_cast<int>(to.width());
    render.height = static_cast<int>(to.height());
}

/// A small file may state a huge display window around a few pixels, which would need its memory.
void check_frame(const Render& render) {
    const std::size_t frame = render.display.pixels(), data = render.data.pixels();
    if (frame > common_frame && frame / largest_frame_over_data > data)
        throw InputError({render.file, 0, 0},
            fmt::format("expected a display window of at most {} times the data window's {} pixels, found {} x {}; "
                        "--crop compares the data window alone",
                largest_frame_over_data, data, render.display.width(), render.display.height()));
}

}  // namespace

void CommonView::share(const std::string& path, const std::string& layer) {
    const Render render = read_(path, layer);
    const Guard guard(lock_);
    const PixelWindow window = intersection(render.data, render.display);
    shared_ = shared_of_.empty() ? window : intersection(shared_, window);
    if (shared_.empty())
        throw InputError({path, 0, 0},
            fmt::format("--crop: expected pixels that all renders have, found none: its data window is {}, those of {} "
                        "and others are elsewhere",
                shown(window), shared_of_.empty() ? path : shared_of_));
    if (shared_of_.empty()) shared_of_ = path;
}

Render CommonView::read_mask(const std::string& path) {
    Render mask = read_(path, "");
    const Guard guard(lock_);
    const PixelWindow &of_mask = mask.display, &frame = first_.display;
    const auto fits = [&](const PixelWindow& w) {
        return of_mask.width() == w.width() && of_mask.height() == w.height();
    };
    const PixelWindow window = crop_ ? shared_ : frame;
    const bool fits_frame = fits(frame);
    if (!fits_frame && !fits(window))
        throw InputError({path, 0, 0},
            fmt::format("expected {} x {} pixels as the renders have, found {} x {}", window.width(), window.height(),
                of_mask.width(), of_mask.height()));
    const PixelWindow& corner = fits_frame ? frame : window;  // the origin of the mask is ignored
    const std::int64_t x = corner.x0 - of_mask.x0, y = corner.y0 - of_mask.y0;
    const PixelWindow data = mask.data;
    mask.data = {data.x0 + x, data.y0 + y, data.x1 + x, data.y1 + y};
    place(mask, window);
    return mask;
}

PixelWindow CommonView::window_for(const Render& render) const {
    if (crop_) return shared_;
    check_frame(render);
    return render.display;
}

void CommonView::check_fits(const Render& render) const {
    const PixelWindow &window = render.display, &other = first_.display;
    if (crop_) {
        if (intersection(shared_, intersection(render.data, window)) == shared_) return;
        throw InputError({render.file, 0, 0},
            fmt::format("expected the pixels {} that the renders share, found {}", shown(shared_), shown(render.data)));
    }
    if (window.width() != other.width() || window.height() != other.height())
        throw InputError({render.file, 0, 0},
            fmt::format("expected {} x {} pixels as in {}, found {} x {}", other.width(), other.height(), first_.file,
                window.width(), window.height()));
    if (align_ == Alignment::display || (window == other && render.data == first_.data)) return;
    const bool data = render.data != first_.data;
    const PixelWindow &a = data ? render.data : window, &b = data ? first_.data : other;
    throw InputError({render.file, 0, 0},
        fmt::format("{} windows differ by {}: expected {} as in {}, found {}; --align display places data windows in "
                    "the display window (pixels outside of one are 0), --crop compares what all data windows share",
            data ? "data" : "display", difference(a, b), shown(b), first_.file, shown(a)));
}

void CommonView::convert_primaries(Render& render) const {
    if (same_primaries(render.primaries, first_.primaries)) return;
    render.notes.push_back(fmt::format("its primaries ({}) are not those of {} ({}): it is converted to the latter",
        to_string(render.primaries), first_.file, to_string(first_.primaries)));
    convert(render, conversion(render.primaries, first_.primaries));
    render.primaries = first_.primaries;
    render.weights = first_.weights;
}

void CommonView::check_unchanged(const Render& render, const std::string& layer) {
    const Reading reading{.state = render.state, .width = render.width, .height = render.height, .hash = render.hash};
    const auto [entry, is_first] = first_readings_.emplace(std::pair{render.file, layer}, reading);
    if (is_first) return;
    const Reading& first_reading = entry->second;
    const FileState &a = first_reading.state, &b = reading.state;
    const std::string what = a.device != b.device || a.inode != b.inode ? "it is another file"
        : a.size != b.size         ? fmt::format("{} bytes, now {}", a.size, b.size)
        : a.modified != b.modified ? "it was written meanwhile"
        : first_reading.width != reading.width || first_reading.height != reading.height ? "its size in pixels"
        : first_reading.hash != reading.hash                                             ? "its pixels"
                                                                                         : "";
    if (!what.empty())
        throw InputError({render.file, 0, 0},
            fmt::format("the file changed since it was first read ({}): compare renders that are complete", what));
}

Render CommonView::read(const std::string& path, const std::string& layer) {
    Render render = read_(path, layer);
    const Guard guard(lock_);
    if (first_.file.empty()) {
        first_ = Render(path, render.width, render.height, Render::empty);
        first_.data = render.data;
        first_.display = render.display;
        first_.primaries = render.primaries;
        first_.weights = render.weights;
    }
    check_fits(render);
    place(render, window_for(render));
    convert_primaries(render);
    render.hash = hash_of(render);
    check_unchanged(render, layer);
    return render;
}

}  // namespace crescent
