// What the built-in arms are tried on, and which verdicts are expected of them.
#pragma once

#include <map>

#include "subjects/builtin.h"
#include "subjects/subject.h"
#include "subjects/users_trials.h"

namespace crescent::inline subjects {

/// Values given with --set: "s", "alpha", "rho_d", "rho_s".
using Settings = std::map<std::string, double>;

/// Directions from the normal to 89 deg, each at its own azimuth.
Grid wo_grid(bool full);
/// Every trial of one arm, or of all where the name is empty, over `grid` in place of wo_grid where it is not empty.
/// Throws InputError for an unknown name.
std::vector<Trial> trials_of(const std::string& arm, const Settings& settings, bool full, const Grid& grid = {});

/// Built-in arm `name` on the surface, light and w_o of each of these trials; with A's f where A is not built in.
std::vector<Trial> arm_against(const std::string& name, std::span<const Trial> a);
/// Another sampler at the w_o of each of these trials.
std::vector<Trial> sampler_against(const std::shared_ptr<const JudgedSampler>& b, std::span<const Trial> a);

/// The arm of the list named `name` as it is on a trial's surface, under its light, at its w_o.
std::shared_ptr<const JudgedSampler> arm_on(const std::string& name, const Trial& trial);

/// One surface and light to try an arm on.
struct TrialSetup {
    SurfaceSetup surface;
    TrialLight light;
    std::string brdf, lighting;
    bool tells_s = false, tells_alpha = false;
};
/// A surface and light of the built-in list: lobe, with a Lambert part or without, under "fill", "disk" or both.
TrialSetup trial_setup(LobeKind lobe, bool lambert, const std::string& lighting, double s_or_alpha);
/// The trial of `subject` on such a surface at one w_o, theory not yet filled in.
Trial trial_on(const TrialSetup& setup, double theta, double azimuth, std::string arm,
    std::shared_ptr<const JudgedSampler> subject);

}  // namespace crescent::inline subjects
