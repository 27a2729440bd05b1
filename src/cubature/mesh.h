// Tables: densities that jump along lines of constant height and of constant azimuth. Where such lines are found,
// evenly spaced in cos theta, theta or cos^2 theta, and in phi, the cells between them are integrated one by one: one
// in which p, p sin theta or p / |cos theta| is constant by its value.
#pragma once

#include <optional>

#include "cubature/cubature.h"

namespace crescent::inline cubature {

/// Edges of cells about n: a = 1 - cos theta ascending from 0 to 2, b = phi in turns from 0 to 1.
struct Mesh {
    std::vector<double> a, b;
    std::size_t cells() const { return (a.size() - 1) * (b.size() - 1); }
};

/// Where g jumps along a few meridians and parallels: heights a and azimuths b, as often as they were met.
struct Jumps {
    std::vector<double> a, b;
};
Jumps find_jumps(const Batch& g);
/// Heights at which it jumps on most of the meridians, ascending.
std::vector<double> heights_of(const Jumps& jumps);
/// The mesh that the jumps lie on; none where there is none.
std::optional<Mesh> mesh_of(const Jumps& jumps);

/// Looks for jumps of g(a, b) along parallels and meridians; none where it has none, or where they lie on no common
/// lines.
std::optional<Mesh> find_mesh(const Batch& g);

/// The integral over the mesh, cut at the bins' edges too: rings (ascending a) x sectors. Cells with two unequal values
/// are left to the adaptive cubature, which starts from what `prepare` makes of them; none where they are too many for
/// it. `resolution`: what g is told of a direction is off by so much, as single precision has it.
using Prepare = std::function<std::vector<Rect>(std::vector<Rect>)>;
std::optional<Integral> integrate_mesh(const Mesh& mesh, std::span<const double> rings, int sectors, const Batch& g,
    const Effort& effort, double resolution = 0, const Prepare& prepare = {}, const SamplesPerBin* samples = nullptr);

/// The integral of what has too many cells to sum: points at random, spread over `cells` first and then where g varies
/// most. Its error is three standard errors, of the whole and of each bin. estimates: g is a random estimate, whose
/// variance a cell with few points may not have met; the mean one of all cells is then granted to each bin.
Integral integrate_by_points(
    std::vector<Rect> cells, int bins, const Batch& g, std::size_t evaluations, bool estimates = false);

/// A density at directions, many at once.
using DirectionBatch = std::function<void(std::span<const Vec3d> at, std::span<double> out)>;
/// The sum over the texels of a sky that is an equal-area octahedral map or a cube's faces, or is bilinear in theta x
/// phi or in cos theta x phi, about an axis of the frame; none where p is none of these, or has more texels than
/// `most`. See texels.cpp.
std::optional<Integral> integrate_texels(const DirectionBatch& p, std::size_t most);

}  // namespace crescent::inline cubature
