// What requests share: boxes of a request, films and references of a box, cut into parts.
#pragma once

#include <string>
#include <vector>

#include "api.h"

namespace crescent::web {

/// The most samples, or work of equal cost, of a box that parts_of() returns.
inline constexpr std::uint64_t most_of_part = 100'000;
/// The cost of a pixel of the experiment's reference. By quadrature: one in a penumbra takes twice that of the others,
/// by the rates in docs/speed.md. Of two estimates: five samplers at most, in scalar code that traces meshes.
std::uint64_t reference_cost(const Experiment& experiment);
/// The cost of a pixel in films without its samples.
inline constexpr std::uint64_t film_cost = 30;

/// Returns "box": [x0, y0, x1, y1] of a request, both ends inclusive.
Box requested_box(const ordered_json& query);
/// The same with the object of "region", if that is a region of the experiment's and has one.
Area requested_area(const ordered_json& query);
/// The surfaces that the camera sees in the whole image, traced once.
const ShapeMap& all_shapes();
TileBox tile_of(const Box& box);
std::uint64_t pixels_of(const TileBox& box);

/// Cuts a box into boxes whose pixels cost at most most_of_part together, row by row from the bottom.
std::vector<TileBox> parts_of(const TileBox& box, std::uint64_t cost_of_pixel);

/// Returns the film of a box alone: a sampler at n samples.
Film film_over(const TileBox& box, const SamplerRef& sampler, std::uint64_t n, std::uint32_t seed);
/// Returns the cost of one of its pixels.
std::uint64_t cost_of(const SamplerRef& sampler, std::uint64_t n);
/// Prepares what a reference needs of the lobes, if not done yet.
void prepare_reference();
/// Writes the pixels of a box into a reference of the scene's size.
void reference_over(const TileBox& box, ReferenceFilm& film);

}  // namespace crescent::web
