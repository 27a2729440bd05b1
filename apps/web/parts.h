// Work in parts of bounded size: a page without workers handles input between two of them. Work is counted in samples
// of a pixel; a part of a film, of a reference, of a tail, of a lesson's measurement, of a sampler's check (pause.h)
// has at most most_of_part.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "api.h"

namespace crescent::web {

inline constexpr std::uint64_t most_of_part = 100'000;
/// The cost of a pixel of a reference: one in a penumbra takes twice that of the others, by the rates in docs/speed.md.
inline constexpr std::uint64_t reference_cost = 2000;
/// The cost of a pixel in films without its samples: copied to its place, measured, for the scale of maps, as a colour.
inline constexpr std::uint64_t film_cost = 30, put_cost = 2, metric_cost = 1, scale_cost = 3, colour_cost = 10;
/// The number of pixels of a plane with cost one when hashed or allocated.
inline constexpr std::uint64_t hashed = 10;
/// The cost of a sample used for a tail.
inline constexpr std::uint64_t tail_cost = 4;
/// The cost of a step between two queries, or of one for a lobe's albedo.
inline constexpr std::uint64_t step_cost = 10;
/// The cost of a sample of a furnace, which fills one lane of a pack, and of its use for the tail.
inline constexpr std::uint64_t furnace_cost = 1;

/// Returns "box": [x0, y0, x1, y1] of a request, both ends inclusive.
Box requested_box(const ordered_json& query);
TileBox tile_of(const Box& box);
std::uint64_t pixels_of(const TileBox& box);

/// Adds to the work done since the page's last query.
void count_work(std::uint64_t samples);
double work_of_part();

/// Cuts a box into boxes whose pixels cost at most most_of_part together, row by row from the bottom.
std::vector<TileBox> parts_of(const TileBox& box, std::uint64_t cost_of_pixel);

using Parts = std::vector<std::function<void()>>;
/// Does the first part of a request, reports how many are left, {"more": ...}, and keeps them for go_on(); the last
/// part returns the response. Parts kept before are dropped.
void begin(Parts parts);

/// Returns the film of a box alone: a built-in sampler at n samples.
Film film_over(const TileBox& box, const std::string& sampler, std::uint64_t n, std::uint32_t seed);
/// Returns the cost of one of its pixels.
std::uint64_t cost_of(const std::string& sampler, std::uint64_t n);
/// Prepares what a reference needs of the lobes, if not done yet; pauses (pause.h).
void prepare_reference();
/// Writes the pixels of a box into a reference of the scene's size.
void reference_over(const TileBox& box, ReferenceFilm& film);

}  // namespace crescent::web
