// Faults that any sampler can have, by size, and faults with a cause that can be named. The right sampler is a member
// of a family; the fault is applied to its functions.
#pragma once

#include <array>

#include "tests/calibration/sampler.h"
#include "tests/calibration/streams.h"

namespace crescent::calibration {

/// The kinds of a fault; the comments define `size`.
enum class FaultKind {
    none,
    constant,          // the pdf is 1 + size times the density of the draws
    leak,              // share of the draws that are uniform over the domain; not in the pdf
    hole,              // mass of a cap that is never drawn, pdf positive there; its draws are repeated
    blind,             // mass of a cap that is drawn, with pdf(w) 0 there
    rotation,          // draws rotated by an angle in rad about an axis perpendicular to their mean
    exponent,          // draws follow p^(1 + size), except for the highest thousandth of p
    mismatch,          // draws use the family's parameter times 1 + size, pdf does not
    nan,               // share of the draws whose pdf is NaN
    negative,          // share of the draws whose pdf is negative
    length,            // share of the draws that are 1 % too long
    factor,            // the pdf is `size` times the density of the draws
    cos_missing,       // pdf / |cos theta_i|
    cos_twice,         // pdf * |cos theta_i|
    sin_missing,       // pdf * sin theta_i
    jacobian_missing,  // pdf * 4 w_o.m
    normal_missing,    // pdf / n.m
    one_number,        // u[1] is u[0]
    no_azimuth,        // u[1] is not used
    frame_mirrored,    // draws for w_o with y negated
    nan_in_plane,      // NaN directions for w_o with z = 0
    nan_near_pole,     // NaN directions for w_o within 1e-3 rad of n, but not at n
    nan_at_horizon,    // pdf(w) is NaN for w_i with z = 0
    nan_at_zero,       // NaN directions where u[0] is 0
    broken             // inside the family: Fault::inner
};

struct Fault {
    FaultKind kind = FaultKind::none;
    double size = 0;
    Broken inner = Broken::none;
};

/// The name of a fault in records and tables: "leak", "transposed table".
std::string_view word(const Fault& fault);
/// The cause of a fault, for names_cause(); "" if it has none that must be named.
std::string_view cause_of(const Fault& fault);
/// Whether a text of an engine is true of a fault without a cause that must be named. A leak out of a bounded domain
/// and a light of another size leave a constant times p inside.
bool is_true_of(std::string_view kind, std::string_view family, std::string_view text);
/// Whether one of the texts that an engine gives as causes names `cause`: it contains one of its words, or the cause
/// itself.
bool names_cause(std::string_view cause, const std::vector<std::string>& texts);

/// A member of a family with a fault. `wo`: the tested w_o; caps and axes are chosen for each. `key` determines the
/// random parts of the fault.
Sampler faulty(const Family& family, const Member& member, Real real, const Fault& fault, std::span<const Vec3d> wo,
    const StreamKey& key);

/// The choices for one w_o: the axis of the rotation, the cap with its 1 - cos, and the 99.9th percentile of p.
struct PlaceOfFault {
    Vec3d wo, turn, cap;
    double gap = 0, high = 0;
};
std::vector<PlaceOfFault> places_of(
    const Sampler& right, const Fault& fault, std::span<const Vec3d> wo, const StreamKey& key);

}  // namespace crescent::calibration
