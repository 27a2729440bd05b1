// One sampler checked at one w_o, and one of its verdicts by name: shared by tests of verdicts.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "check/check.h"
#include "check/sources/cases.h"

namespace crescent {

inline CheckResult checked_alone(const CheckCase& check_case, const TestSettings& settings) {
    ProgressMonitor monitor;
    return run_checks({&check_case, 1}, settings, monitor);
}
/// w_o at (theta, phi), degrees.
inline CheckResult checked_at(
    std::shared_ptr<const SamplerAdapter> adapter, double theta, const TestSettings& settings, double phi = 130) {
    return checked_alone(make_user_case(std::move(adapter), theta, phi), settings);
}

/// Returns the first verdict of that name. Throws std::runtime_error if there is none.
inline const Verdict& named(const CheckResult& j, std::string_view name) {
    for (const Verdict& v : j.verdicts)
        if (v.name == name) return v;
    throw std::runtime_error("no verdict '" + std::string(name) + "'");
}

}  // namespace crescent
