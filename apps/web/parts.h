// Work in parts of bounded size: a page without workers answers to its reader between two of them. Work is counted in
// samples of a pixel; a part of a film, of a reference, of a tail, of what a lesson asks, of the verdicts on a sampler
// (pause.h) has at most most_of_part.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "api.h"

namespace crescent::web {

inline constexpr std::uint64_t most_of_part = 100'000;
/// What a pixel of a reference counts: one in a penumbra takes twice what the others do, by the rates in docs/speed.md.
inline constexpr std::uint64_t reference_cost = 2000;
/// What a pixel counts in films beside its samples, put into its place, measured, for the scale of maps, as a colour.
inline constexpr std::uint64_t film_cost = 30, put_cost = 2, metric_cost = 1, scale_cost = 3, colour_cost = 10;
/// Pixels of a plane that count one where it is hashed, or takes its memory.
inline constexpr std::uint64_t hashed = 10;
/// And a sample that is looked at by itself, for a tail.
inline constexpr std::uint64_t tail_cost = 4;
/// And a step of what is computed between two questions, or for a lobe's albedo.
inline constexpr std::uint64_t step_cost = 10;
/// And a sample of a furnace, which fills one lane of a pack; to look at it for the tail.
inline constexpr std::uint64_t furnace_cost = 1;

/// What "box": [x0, y0, x1, y1] of a request means, both ends inside.
Box requested_box(const ordered_json& query);
TileBox tile_of(const Box& box);
std::uint64_t pixels_of(const TileBox& box);

/// Adds to what was done since the page asked last.
void count_work(std::uint64_t samples);
double work_of_part();

/// A box in boxes whose pixels cost at most most_of_part together, row by row from the bottom.
std::vector<TileBox> parts_of(const TileBox& box, std::uint64_t cost_of_pixel);

using Parts = std::vector<std::function<void()>>;
/// Does the first part of a question, says how many are left, {"more": ...}, and keeps them for go_on(); the last part
/// says the answer. What was kept before is dropped.
void begin(Parts parts);

/// The film of a box alone: a sampler of the list at n samples.
Film film_over(const TileBox& box, const std::string& sampler, std::uint64_t n, std::uint32_t seed);
/// What one of its pixels counts.
std::uint64_t cost_of(const std::string& sampler, std::uint64_t n);
/// What a reference needs of the lobes, where it is not made yet; pauses (pause.h).
void prepare_reference();
/// The pixels of a box into a reference of the scene's size.
void reference_over(const TileBox& box, ReferenceFilm& film);

}  // namespace crescent::web
