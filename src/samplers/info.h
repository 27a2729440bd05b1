// What an arm says of itself, beside how it draws: the names, formulas and expectations from which the experiment's
// keys, `crescent list arms`, plates, report, verdicts and the law on the GL back end are made. An arm's file states
// it as `static constexpr SamplerDoc manual`; this header needs none of the arms' code.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crescent::inline samplers {

/// The direction that a density is centred on, where it has one and is symmetric about it.
enum class PdfAxis { none, normal, mirror };

/// A surface and a light that `crescent check` checks an arm on.
struct CaseSurface {
    std::string_view lobe = "";       // a word of lobes/; "": none
    double sharpness = 32;            // that lobe's s or alpha
    bool lambert = false;             // with rho_d = 0.5 beside it
    std::string_view light = "fill";  // "fill", "disk", "overhead disk", "two disks", or fill + one of these
};

/// The surface and light of one case, as an arm's theory is asked about them.
struct CasePoint {
    double rho_d = 0, rho_s = 0;
    double s = 0, alpha = 0;
    double fill = 0;       // radiance
    double theta_deg = 0;  // between w_o and the normal, hence between R and the normal
};

/// What a known theory says of an arm at such a point.
struct ExpectedBehaviour {
    std::optional<double> lost{};    // fraction of the diffuse part that p cannot reach
    double lost_of = 0;              // that part's albedo
    std::optional<double> tail_k{};  // Pareto index of f L cos / p
    bool bounded = false;            // the weight has a finite maximum
    std::string underflows{};  // why support may come out wrong: p is less than the smallest double where f is not 0
    std::optional<std::string> wrong{};  // the verdict that is expected to be wrong
    std::string why{};
};

/// Why p of a cosine power s is 0 in double where Lambert is not, `least` being the cosine that the power takes there:
/// less than 2^-1074. "" where it is not so.
std::string power_underflows(const CasePoint& at, double least);

/// How far a GL film may be from the CPU's: relative to Y, at one sample a pixel, on a software renderer.
struct GlTolerance {
    double relative = 0;  // 0: there is no GLSL copy of this arm
    std::string_view reason = "";
};

/// Formulas are TeX as base/formula.h reads it; words may hold formulas between dollar signs.
struct SamplerDoc {
    std::string_view label = "";    // on plates and in the film: holds the arm's name
    std::string_view summary = "";  // one line: what it aims at
    std::string_view formula = "";  // of the density, or of the weights where two techniques are combined
    std::string_view density = "";  // in 1/sr; empty: as `formula`
    std::string_view draw = "";     // how u becomes a direction
    std::string_view axis = "";     // what polar angles are measured from
    PdfAxis about = PdfAxis::none;
    bool needs_s = false;   // an experiment without any exponent cannot run it
    bool combines = false;  // it joins several densities
    std::string_view misses =
        "";  // light that it cannot reach; empty: it reaches all. Where such light shines it is biased
    std::span<const CaseSurface> check_cases = {};  // empty: every lobe, and Lambert, under the fill
    GlTolerance gl = {};
};

/// A built-in arm.
struct SamplerInfo : SamplerDoc {
    std::string_view name;  // the word for it in files, on plates and in the report
    int techniques = 1;     // directions drawn a sample
    ExpectedBehaviour (*theory)(const CasePoint& at) = nullptr;
};

/// The arms in the order of the list in all.h.
const std::vector<SamplerInfo>& sampler_infos();
/// Null where no built-in arm has that name.
const SamplerInfo* find_arm_info(std::string_view sampler);
/// The words that an experiment may use for samplers.
std::vector<std::string> sampler_names();
/// Directions that a built-in arm draws a sample.
std::uint64_t directions_per_sample(std::string_view sampler);

}  // namespace crescent::inline samplers
