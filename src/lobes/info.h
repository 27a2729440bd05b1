// What a lobe says of itself, beside its value: the names, formulas and widths from which the schema, the reference,
// verdicts and report are made. A lobe's file states it as `static constexpr LobeManual manual`; see lobes/all.h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace crescent::inline lobes {

/// Which of a surface's two numbers shapes a lobe: the exponent s, or the roughness alpha.
enum class LobeParameter { s, alpha };

struct LobeManual {
    std::string_view label = "";    // in verdicts and in the report
    std::string_view summary = "";  // one line, for `crescent list brdfs`
    std::string_view formula = "";  // in 1/sr without rho_s: TeX as base/formula.h reads it
    LobeParameter parameter = LobeParameter::s;
    bool about_mirror = false;      // it peaks about R; else it is about the half vector, a streak at grazing w_o
    std::string_view own_arm = "";  // the arm of arms/all.h that draws from it
    double judged_from = 0;         // the least alpha that verdicts are given at; 0: any
};

/// Where a lobe's height lies, as angles from its peak in the plane across that of incidence, rad.
struct LobeWidth {
    double width = 1;  // it keeps its height within
    double reach = 0;  // nothing of it is left beyond
};

/// A place in the list of lobes; none: Lambert alone.
enum class LobeKind : int { none = -1 };

/// A built-in lobe. Its s and alpha are those of its surface, though it may read but one of them.
struct LobeInfo : LobeManual {
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

}  // namespace crescent::inline lobes
