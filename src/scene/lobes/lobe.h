// A lobe: f = rho_d / pi + rho_s * lobe, without Fresnel. A number in 1/sr without the cosine, in the local frame (n =
// +z), depending on a surface's s and alpha.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "math/functions.h"
#include "math/simd/frame.h"

namespace crescent {

// ---- The documentation of a lobe: the names, formulas and widths from which the schema, the reference, checks and
// report are made; a lobe's file defines it as a `LobeDoc`, see lobes/all.h.

/// The number of a surface that shapes a lobe: the exponent s, or the roughness alpha.
enum class LobeParameter { s, alpha };

struct LobeDoc {
    std::string_view label = "";    // in verdicts and in the report
    std::string_view summary = "";  // one line, for `crescent list brdfs`
    std::string_view formula = "";  // in 1/sr without rho_s: TeX as output/formula.h reads it
    LobeParameter parameter = LobeParameter::s;
    bool about_mirror = false;      // it peaks about R; else about the half vector, a streak at grazing w_o
    std::string_view own_arm = "";  // the sampler of samplers/all.h that draws from it
    double checked_from = 0;        // the smallest alpha that is checked; 0: any
};

/// How far a lobe extends, as angles from its peak in the plane across that of incidence, rad.
struct LobeWidth {
    double width = 1;  // it keeps its height within this angle
    double reach = 0;  // it is negligible beyond
};

/// An index in the list of lobes; none: only Lambert.
enum class LobeKind : int { none = -1 };

/// A built-in lobe. Its s and alpha are those of its surface, though it may read only one of them.
struct LobeInfo : LobeDoc {
    std::string_view name;  // its name in files
    LobeKind kind = LobeKind::none;
    double (*exponent)(double s, double alpha) = nullptr;  // of the cosine power of the same width
    LobeWidth (*width)(double s, double alpha) = nullptr;
};

/// Returns the lobes in the order of the list in all.h.
const std::vector<LobeInfo>& lobe_infos();
/// Returns the names that a shape may use for its lobe.
std::vector<std::string> lobe_names();
/// `kind` is not none.
const LobeInfo& lobe_info(LobeKind kind);
/// Returns the lobe with a name, which must be a built-in one; "" is none.
LobeKind lobe_named(std::string_view name);

/// rho_s = 0: only Lambert.
template <class F> struct NoLobe {
    static constexpr std::string_view name = "lambert";
    static constexpr bool present = false;
    NoLobe(F, F) {}
    F operator()(Vec3<F>, Vec3<F>) const { return number<F>(0); }
};

/// Returns f if wo and wi are above the horizon, else 0: half vectors are meaningless below it.
template <class F> CRESCENT_INLINE F both_above(Vec3<F> wo, Vec3<F> wi, F f) {
    return select((wo.z > number<F>(0)) & (wi.z > number<F>(0)), f, number<F>(0));
}

// A lobe about the half vector m states, for the table of its albedo (reference/lobe_albedo.h), how its own
// distribution draws m about n, in double: struct Normals with Normals(s, alpha),
//   height(u)   the cosine (n.m) that u in [0, 1] draws,
//   below(cos)  the u that draws an m of that cosine,
//   density(cos)  of m at that cosine, 1/sr.
// Any other lobe states static double albedo(s, alpha, cos_o, integrate), integrate(f, a, b) being an adaptive rule.

}  // namespace crescent
