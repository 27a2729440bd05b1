// One sampler judged at one w_o, and one of its verdicts by name: what tests of verdicts share.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "check/check.h"
#include "check/sources/cases.h"

namespace crescent {

inline CheckResult judged_alone(const CheckCase& trial, const TestSettings& settings) {
    ProgressMonitor monitor;
    return judge({&trial, 1}, settings, monitor);
}
/// w_o at (theta, phi), degrees.
inline CheckResult judged_at(
    std::shared_ptr<const SamplerAdapter> subject, double theta, const TestSettings& settings, double phi = 130) {
    return judged_alone(make_user_case(std::move(subject), theta, phi), settings);
}

/// The first verdict of that name. Throws std::runtime_error where there is none.
inline const Verdict& named(const CheckResult& j, std::string_view name) {
    for (const Verdict& v : j.verdicts)
        if (v.name == name) return v;
    throw std::runtime_error("no verdict '" + std::string(name) + "'");
}

}  // namespace crescent
