// The description of a sampler, in addition to its code: the names, formulas and expectations used by the experiment's
// keys, `crescent list arms`, plates, report, checks and the tests of the GL back end. A sampler's file defines it as
// `static constexpr SamplerDoc manual`; this header needs none of the samplers' code.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crescent {

/// The direction that a density is centred on, if it has one and is symmetric about it.
enum class PdfAxis { none, normal, mirror };

/// A surface and a light on which `crescent check` tests a sampler.
struct CaseSurface {
    std::string_view lobe = "";  // a word of lobes/; "": none
    double sharpness = 32;       // that lobe's s or alpha
    bool lambert = false;        // with rho_d = 0.5 in addition
    std::string_view light =
        "fill";  // "fill", "disk", "overhead disk", "two disks", "sky", "triangles", or fill + these
};

/// The surface and light of one case, the input of a sampler's theory.
struct CasePoint {
    double rho_d = 0, rho_s = 0;
    double s = 0, alpha = 0;
    double fill = 0;       // radiance
    double theta_deg = 0;  // between w_o and the normal, so between R and the normal
};

/// The behaviour that theory predicts for a sampler at such a point.
struct ExpectedBehaviour {
    std::optional<double> lost{};        // fraction of the diffuse part that p cannot reach
    double lost_of = 0;                  // that part's albedo
    std::optional<double> tail_k{};      // Pareto index of f L cos / p
    bool bounded = false;                // the weight has a finite maximum
    std::string underflows{};            // why support may fail: p is less than the smallest double where f is not 0
    std::optional<std::string> wrong{};  // the verdict that is expected to be wrong
    std::string why{};
};

/// Returns why p of a cosine power s is 0 in double where Lambert is not, because the power of the cosine
/// `smallest_cos` is less than 2^-1074; "" if it is not.
std::string power_underflows(const CasePoint& point, double smallest_cos);

/// The light that a sampler finds.
struct Reaches {
    bool fill = true, lights = true, sky = true, triangles = true;
};

/// The allowed difference of a GL film from the CPU's: relative to Y, at one sample per pixel, on a software renderer.
struct GlTolerance {
    double relative = 0;  // 0: this sampler has no GLSL version
    std::string_view reason = "";
};

/// Formulas are TeX as output/formula.h reads it; words may contain formulas between dollar signs.
struct SamplerDoc {
    std::string_view label = "";    // on plates and in the video: contains the sampler's name
    std::string_view summary = "";  // one line: its target
    std::string_view formula = "";  // of the density, or of the weights if two techniques are combined
    std::string_view density = "";  // in 1/sr; empty: same as `formula`
    std::string_view draw = "";     // how u becomes a direction
    std::string_view axis = "";     // the direction from which polar angles are measured
    PdfAxis about = PdfAxis::none;
    bool needs_s = false;          // an experiment without an exponent cannot run it
    bool combines = false;         // it combines several densities
    std::string_view misses = "";  // light that it cannot reach, under which it is biased; empty: none
    Reaches reaches = {};
    std::span<const CaseSurface> check_cases = {};  // empty: every lobe, and Lambert, under the fill
    GlTolerance gl = {};
};

/// A built-in sampler.
struct SamplerInfo : SamplerDoc {
    std::string_view name;  // its name in files, on plates and in the report
    int techniques = 1;     // directions drawn per sample
    ExpectedBehaviour (*theory)(const CasePoint& point) = nullptr;
};

/// Returns the samplers in the order of the list in all.h.
const std::vector<SamplerInfo>& sampler_infos();
/// Returns null if no built-in sampler has that name.
const SamplerInfo* find_arm_info(std::string_view sampler);
/// Returns the names that an experiment may use for samplers.
std::vector<std::string> sampler_names();
/// Returns the directions that a built-in sampler draws per sample.
std::uint64_t directions_per_sample(std::string_view sampler);

}  // namespace crescent
