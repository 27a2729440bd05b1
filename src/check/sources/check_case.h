// A case of `crescent check`: one sampler at one w_o with one BRDF under one light; and the cases of a user's sampler.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "check/sources/case_lighting.h"
#include "samplers/info.h"
#include "samplers/sampler_adapter.h"
#include "scene/lobes/all.h"

namespace crescent {

/// Channel 0, 1 or 2 of a colour.
inline double channel_of(Vec3d c, int channel) { return channel == 0 ? c.x : channel == 1 ? c.y : c.z; }

/// A direction w_i, or the point of the domain, in words: "w_i = (0, 0, 1)", "entry 17".
std::string place_text(const Traits& traits, Vec3d w);

/// Adds the device of a sampler, if it names one that is not in the list.
void add_device(const std::string& arm, const SamplerAdapter& sampler, DevicesByArm& to);

/// The surface of a case: f = rho_d / pi + rho_s lobe.
struct SurfaceSetup {
    LobeKind lobe = LobeKind::none;
    double rho_d = 0, rho_s = 0;
    double s = 32, alpha = 0.3;
};

/// Named parameter values, in the order in which they are printed.
using Parameters = std::vector<std::pair<std::string, double>>;

/// One sampler at one w_o with one BRDF under one light.
struct CheckCase {
    std::string arm, brdf, lighting;
    Vec3d wo{};
    double theta_deg = 0, azimuth_deg = 0;
    Parameters parameters;
    SurfaceSetup surface{.rho_d = 0.5};  // on which a built-in sampler draws
    CaseLighting light;
    ExpectedBehaviour theory;
    bool baseline = false;  // used only for ranks of efficiency
    std::shared_ptr<const SamplerAdapter> adapter;
    std::string text() const;  // "w_o 60 deg, s=32, Lambert + Phong, fill"
};

/// The text of a case without w_o, and of one that failed before its check.
inline constexpr std::string_view without_wo = "no w_o";
inline constexpr std::string_view before_any_case = "start";

/// The direction at theta from n and phi from x, in degrees.
Vec3d tilt(double theta_deg, double azimuth_deg = 0);

// ---- The cases of a user's sampler; cases.h has those of the built-in arms.

/// User-defined w_o: theta and azimuth in degrees.
using Grid = std::vector<std::pair<double, double>>;

/// A user's sampler over the grid of w_o under a uniform light, with uniform and cosine as baselines if it has a BRDF.
/// A sampler without BRDF whose draws and p do not depend on w_o, such as that of an environment light, is checked
/// once.
std::vector<CheckCase> make_user_cases(
    const std::shared_ptr<const SamplerAdapter>& adapter, bool is_full, const Grid& grid = {});
/// The same at one w_o.
CheckCase make_user_case(const std::shared_ptr<const SamplerAdapter>& adapter, double theta, double azimuth);

}  // namespace crescent
