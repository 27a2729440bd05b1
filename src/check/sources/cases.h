// The cases of the built-in samplers, and the verdicts that are expected of them.
#pragma once

#include <map>

#include "check/sources/builtin.h"
#include "check/sources/user_cases.h"

namespace crescent::inline sources {

/// Values given with --set: "s", "alpha", "rho_d", "rho_s".
using Settings = std::map<std::string, double>;

/// Directions from the normal to 89 deg, each with its own azimuth.
Grid wo_grid(bool full);
/// Every case of one arm, or of all arms if the name is empty, over `grid` or, if that is empty, wo_grid. Throws
/// InputError for an unknown name.
std::vector<CheckCase> make_cases(const std::string& arm, const Settings& settings, bool full, const Grid& grid = {});

/// Built-in arm `name` on the surface, light and w_o of each of these cases, with A's f if A is not built in.
std::vector<CheckCase> sampler_named_against(const std::string& name, std::span<const CheckCase> a);
/// Another sampler at the w_o of each of these cases.
std::vector<CheckCase> sampler_against(const std::shared_ptr<const SamplerAdapter>& b, std::span<const CheckCase> a);

/// The built-in arm `name` on the surface of a case, under its light, at its w_o.
std::shared_ptr<const SamplerAdapter> sampler_on(const std::string& name, const CheckCase& check_case);

/// A surface and light for a check of an arm.
struct CaseSetup {
    SurfaceSetup surface;
    CaseLighting light;
    std::string brdf, lighting;
    bool has_s = false, has_alpha = false;
};
/// A surface and light of the built-in list: a lobe, with or without a Lambert part, under "fill", "disk" or both.
CaseSetup case_setup(LobeKind lobe, bool lambert, const std::string& lighting, double s_or_alpha);
/// The case of `sampler` on a surface at one w_o, without its expected behaviour.
CheckCase make_case_on(const CaseSetup& setup, double theta, double azimuth, std::string arm,
    std::shared_ptr<const SamplerAdapter> adapter);

}  // namespace crescent::inline sources
