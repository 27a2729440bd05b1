// What a lobe is: f = rho_d / pi + rho_s * lobe, Fresnel apart. A number in 1/sr without the cosine, in the local frame
// (n = +z), of a surface's s and alpha.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "math/functions.h"
#include "math/simd/frame.h"

namespace crescent::inline lobes {

// ---- What a lobe says of itself, beside its value: the names, formulas and widths from which the schema, the
// reference, verdicts and report are made. A lobe's file states it as `static constexpr LobeDoc manual`; see
// lobes/all.h.

/// Which of a surface's two numbers shapes a lobe: the exponent s, or the roughness alpha.
enum class LobeParameter { s, alpha };

struct LobeDoc {
    std::string_view label = "";    // in verdicts and in the report
    std::string_view summary = "";  // one line, for `crescent list brdfs`
    std::string_view formula = "";  // in 1/sr without rho_s: TeX as base/formula.h reads it
    LobeParameter parameter = LobeParameter::s;
    bool about_mirror = false;      // it peaks about R; else it is about the half vector, a streak at grazing w_o
    std::string_view own_arm = "";  // the arm of arms/all.h that draws from it
    double checked_from = 0;        // the least alpha that verdicts are given at; 0: any
};

/// Where a lobe's height lies, as angles from its peak in the plane across that of incidence, rad.
struct LobeWidth {
    double width = 1;  // it keeps its height within
    double reach = 0;  // nothing of it is left beyond
};

/// A place in the list of lobes; none: Lambert alone.
enum class LobeKind : int { none = -1 };

/// A built-in lobe. Its s and alpha are those of its surface, though it may read but one of them.
struct LobeInfo : LobeDoc {
    std::string_view name;  // the word for it in files
    LobeKind kind = LobeKind::none;
    double (*exponent)(double s, double alpha) = nullptr;  // of the cosine power that is as wide
    LobeWidth (*width)(double s, double alpha) = nullptr;
};

/// The lobes in the order of the list in all.h.
const std::vector<LobeInfo>& lobe_infos();
/// The words that a shape may use for its lobe.
std::vector<std::string> lobe_names();
/// `kind` is not none.
const LobeInfo& lobe_info(LobeKind kind);
/// A lobe by its word, which names a built-in one; "" is none.
LobeKind lobe_named(std::string_view name);

/// rho_s = 0: nothing but Lambert.
template <class F> struct NoLobe {
    static constexpr std::string_view name = "lambert";
    static constexpr bool present = false;
    NoLobe(F, F) {}
    F operator()(Vec3<F>, Vec3<F>) const { return number<F>(0); }
};

/// f where wo and wi are above the horizon, else 0: half vectors mean nothing below it.
template <class F> CRESCENT_INLINE F both_above(Vec3<F> wo, Vec3<F> wi, F f) {
    return select((wo.z > number<F>(0)) & (wi.z > number<F>(0)), f, number<F>(0));
}

// A lobe about the half vector m states, for the table of its albedo (reference/lobe_albedo.h), how its own
// distribution draws m about n, in double: struct Normals with Normals(s, alpha),
//   height(u)   the cosine (n.m) that u in [0, 1] draws,
//   below(cos)  the u that draws an m of that cosine,
//   density(cos)  of m at that cosine, 1/sr.
// Any other lobe states static double albedo(s, alpha, cos_o, integrate), integrate(f, a, b) being an adaptive rule.

}  // namespace crescent::inline lobes
