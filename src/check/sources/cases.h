// What the built-in samplers are checked on, and which verdicts are expected of them.
#pragma once

#include <map>

#include "check/sources/builtin.h"
#include "check/sources/user_cases.h"

namespace crescent::inline sources {

/// Values given with --set: "s", "alpha", "rho_d", "rho_s".
using Settings = std::map<std::string, double>;

/// Directions from the normal to 89 deg, each at its own azimuth.
Grid wo_grid(bool full);
/// Every case of one arm, or of all where the name is empty, over `grid` in place of wo_grid where it is not empty.
/// Throws InputError for an unknown name.
std::vector<CheckCase> make_cases(const std::string& arm, const Settings& settings, bool full, const Grid& grid = {});

/// Built-in arm `name` on the surface, light and w_o of each of these cases; with A's f where A is not built in.
std::vector<CheckCase> sampler_named_against(const std::string& name, std::span<const CheckCase> a);
/// Another sampler at the w_o of each of these cases.
std::vector<CheckCase> sampler_against(const std::shared_ptr<const SamplerAdapter>& b, std::span<const CheckCase> a);

/// The arm of the list named `name` as it is on a case's surface, under its light, at its w_o.
std::shared_ptr<const SamplerAdapter> sampler_on(const std::string& name, const CheckCase& check_case);

/// One surface and light to try an arm on.
struct CaseSetup {
    SurfaceSetup surface;
    CaseLighting light;
    std::string brdf, lighting;
    bool tells_s = false, tells_alpha = false;
};
/// A surface and light of the built-in list: lobe, with a Lambert part or without, under "fill", "disk" or both.
CaseSetup case_setup(LobeKind lobe, bool lambert, const std::string& lighting, double s_or_alpha);
/// The case of `sampler` on such a surface at one w_o, theory not yet filled in.
CheckCase make_case_on(const CaseSetup& setup, double theta, double azimuth, std::string arm,
    std::shared_ptr<const SamplerAdapter> adapter);

}  // namespace crescent::inline sources
