// Films and the reference, tile by tile: computed in any instance, assembled in one, measured there.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "parts.h"
#include "user_sampler.h"

namespace crescent::web {

namespace {

TileBox box_of(int x0, int y0, int x1, int y1) { return {x0, y0, x1, y1}; }

/// Rows of a box, from or to a plane of the image's width; 4 bytes per pixel.
template <class Move> void each_row(const TileBox& box, std::size_t width, Move&& move) {
    const std::size_t row_bytes = static_cast<std::size_t>(box.x1 - box.x0) * 4;
    for (int j = box.y0; j < box.y1; ++j)
        move(static_cast<std::size_t>(j - box.y0) * row_bytes,
            (static_cast<std::size_t>(j) * width + static_cast<std::size_t>(box.x0)) * 4, row_bytes);
}

/// The planes of a film as one block: those of the box, one after another.
template <class F> void put_planes(F& film, const TileBox& box, const std::byte* from) {
    for (const std::span<std::byte> plane : film.planes()) {
        each_row(box, static_cast<std::size_t>(film.width), [&](std::size_t offset, std::size_t to, std::size_t size) {
            std::memcpy(&plane[to], from + offset, size);
        });
        from += pixels_of(box) * 4;
    }
}
template <class F> std::vector<std::byte>& all_planes(F& film) {
    std::vector<std::byte>& out = scratch<std::byte>();
    out.clear();
    for (const std::span<std::byte> plane : film.planes()) out.insert(out.end(), plane.begin(), plane.end());
    return out;
}

}  // namespace

/// The arm at n samples over a box: the nine planes of a film, which shape each pixel sees, and the number of NaN
/// samples (as one count).
CRESCENT_EXPORT(tile)(int arm, double n, int x0, int y0, int x1, int y1)->const void* {
    Bench& b = bench();
    const TileBox box = box_of(x0, y0, x1, y1);
    const SamplerRef sampler = sampler_of(b.experiment.arms.at(static_cast<std::size_t>(arm)));
    Film film = film_over(box, sampler, static_cast<std::uint64_t>(n), b.experiment.seed);
    std::vector<std::byte>& out = all_planes(film);
    std::vector<std::int32_t> tail;
    for (int j = y0; j < y1; ++j)
        for (int i = x0; i < x1; ++i)
            tail.push_back(b.shapes.shape[static_cast<std::size_t>(j) * b.width() + std::size_t(i)]);
    tail.push_back(static_cast<std::int32_t>(film.invalid));
    const auto* bytes = reinterpret_cast<const std::byte*>(tail.data());
    out.insert(out.end(), bytes, bytes + tail.size() * sizeof tail[0]);
    return out.data();
}

/// The reference over a box: five planes.
CRESCENT_EXPORT(reference_tile)(int x0, int y0, int x1, int y1)->const void* {
    Bench& b = bench();
    if (b.reference.size() == 0)
        b.reference = ReferenceFilm(b.experiment.image.width, b.experiment.image.height, b.scene.s());
    const TileBox box = box_of(x0, y0, x1, y1);
    reference_over(box, b.reference);
    std::vector<std::byte>& out = scratch<std::byte>();
    out.clear();
    for (const std::span<std::byte> plane : b.reference.planes())
        each_row(box, b.width(), [&](std::size_t, std::size_t offset, std::size_t size) {
            out.insert(
                out.end(), plane.begin() + std::ptrdiff_t(offset), plane.begin() + std::ptrdiff_t(offset + size));
        });
    return out.data();
}

/// Allocates `size` bytes for a tile, for put().
CRESCENT_EXPORT(tile_buffer)(std::size_t size)->void* {
    scratch<std::byte>().resize(size);
    return scratch<std::byte>().data();
}

/// Allocates film `index`, the reference for -1; its contents stay if it has the size of the image. Returns {}.
CRESCENT_EXPORT(film_buffer)(int index)->void {
    Bench& b = bench();
    const int width = b.experiment.image.width, height = b.experiment.image.height;
    if (index < 0) {
        if (b.reference.size() != b.pixels()) b.reference = ReferenceFilm(width, height, b.scene.s());
    } else {
        const auto position = static_cast<std::size_t>(index);
        if (b.slots.size() <= position) b.slots.resize(position + 1);
        if (b.slots[position].film.y.size() != b.pixels()) b.slots[position].film = Film(width, height, 0);
    }
    respond(ordered_json::object());
}

/// Assigns film `index` to this arm at n; its old contents stay until tiles overwrite them.
CRESCENT_EXPORT(begin)(int index, int arm, double n)->void {
    Bench& b = bench();
    const auto position = static_cast<std::size_t>(index);
    if (b.slots.size() <= position) b.slots.resize(position + 1);
    const ArmPlan& plan = b.experiment.arms.at(static_cast<std::size_t>(arm));
    Slot& s = b.slots[position];
    const auto samples = static_cast<std::uint64_t>(n);
    const bool has_planes =
        std::ranges::all_of(s.film.planes(), [&](auto plane) { return plane.size() == 4 * b.pixels(); });
    if (!has_planes) s.film = Film(b.experiment.image.width, b.experiment.image.height, samples);
    s.film.n = samples;
    s.film.invalid = 0;
    const SampleCost cost = cost_of_sample(sampler_of(plan));
    s.film.directions = cost.directions;
    s.film.evaluations = cost.f;
    s.key = {plan.name, samples, b.scene.s(), b.experiment.seed};
}

/// Copies the tile in tile_buffer() to its place in film `index`.
CRESCENT_EXPORT(put)(int index, int x0, int y0, int x1, int y1)->void {
    Bench& b = bench();
    Film& film = slot(index).film;
    const TileBox box = box_of(x0, y0, x1, y1);
    const std::byte* from = scratch<std::byte>().data();
    put_planes(film, box, from);
    const std::byte* shape_bytes = from + pixels_of(box) * 4 * film.planes().size();
    b.shapes.width = film.width;
    b.shapes.height = film.height;
    b.shapes.shape.resize(b.pixels(), -1);
    for (int j = y0; j < y1; ++j)
        for (int i = x0; i < x1; ++i, shape_bytes += 4) {
            std::int32_t shape = 0;
            std::memcpy(&shape, shape_bytes, 4);
            b.shapes.shape[static_cast<std::size_t>(j) * b.width() + std::size_t(i)] = static_cast<std::int16_t>(shape);
        }
    std::int32_t invalid_count = 0;
    std::memcpy(&invalid_count, shape_bytes, 4);
    film.invalid += static_cast<std::uint64_t>(invalid_count);
}

CRESCENT_EXPORT(put_reference)(int x0, int y0, int x1, int y1)->void {
    ensure(bench().reference.size() == bench().pixels(), "film_buffer(-1) came before");
    const TileBox box = box_of(x0, y0, x1, y1);
    put_planes(bench().reference, box, scratch<std::byte>().data());
}

/// Returns the hash of film `index`, of the reference for -1.
CRESCENT_EXPORT(hash_of)(int index)->void { respond(index < 0 ? hash(bench().reference) : hash(slot(index).film)); }

}  // namespace crescent::web
