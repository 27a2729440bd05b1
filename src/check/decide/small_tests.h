// Tests beside the principle, at one w_o: numbers at the corners of u, the same u again, p against the derivatives of
// sample(u). Nothing in them is left to chance but where they look.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/verdicts/questions.h"

namespace crescent::check {

/// What is wrong with a draw, in words; none where it can be used.
std::optional<const char*> fault_of(const Draw& d);

/// A small test that failed.
struct SmallFault {
    Family family = Family::corners;
    double times = 0, of = 0;  // how often, of how many
    double size = 0;           // relative, where it has one
    Example first{};
    const char* what = "";
    std::optional<Vec3d> wo{};  // of the first, where it is none of the call's
    std::string place{};        // of the first in a file
};

/// Every row of a file of draws, whichever question it serves.
std::optional<SmallFault> rows_of_file(const Source& source);
/// u at 0, next to 0, at quarters and next to 1, in every two numbers and in every corner: samplers divide by 0 there.
std::optional<SmallFault> corners_of_u(Source& source);
/// The same u in another order, in other batches and alone.
std::optional<SmallFault> same_u_again(Source& source, const StreamKey& key);
/// pdf(w) and f(w) of the same directions in blocks of other sizes: a program may mix up the rows of a block.
std::optional<SmallFault> same_answers_again(Source& source, const StreamKey& key);
/// What the map draws at a few points where its derivatives are known to `jacobian_error`, and p there, both 1/sr.
/// Other u may lead to the same direction, so `drawn` is a part of what is drawn there.
struct MapDensity {
    PrimarySample u;
    Draw draw;
    double p = 0, drawn = 0, error = 0;  // error: of `drawn`, relative
};
std::vector<MapDensity> map_densities(Source& source, const StreamKey& key);
/// p |dw/du| of the branch that a draw takes is at least the probability of that branch.
std::optional<SmallFault> jacobian(Source& source, const StreamKey& key);
/// Numbers of which few bits are used: a draw moves with u at large, and does not move at all with its last bits.
std::optional<SmallFault> few_bits(Source& source, const StreamKey& key);
/// Random numbers that change no draw.
std::vector<int> numbers_without_effect(Source& source, const StreamKey& key);

/// All of them.
std::vector<SmallFault> small_tests(Source& source, const StreamKey& key);

// ---- Where delta parts lead: a smooth boundary mirrors and refracts by the index that is stated (Snell), a thin wall
// lets straight through, and light goes back the way that it came with as much of it (Helmholtz).

/// Against the stated index, where there is one.
std::optional<SmallFault> refraction(const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key);
/// Draws at w_i of a part lead back to w_o, with the power that reciprocity gives.
std::optional<SmallFault> way_back(const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key);

}  // namespace crescent::check
