// A sampler of points of a domain in C++, from functions.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "check/sources/check_case.h"

namespace crescent {

/// Points are rows of coordinates, densities those of docs/domains.md.
///
///   PointSampler lens{.domain = "disk",
///       .sample = [](std::span<const double> u, std::span<double> x) { x[0] = ...; x[1] = ...; return 1 / pi; },
///       .pdf = [](std::span<const double> x) { return 1 / pi; }};
///   CheckResult j = check_sampler("lens", lens);
struct PointSampler {
    using Function = std::function<double(std::span<const double>)>;
    std::string domain;
    int numbers = 2;  // random numbers of a draw
    /// Writes a point and returns its density; 0: nothing is drawn.
    std::function<double(std::span<const double> u, std::span<double> x)> sample;
    Function pdf;
    Function f{};             // an integrand; optional
    bool own_random = false;  // it uses its own random numbers
    bool parallel = false;    // several threads may call its functions
};

/// The sampler for a check. Throws InputError if the domain or the number of random numbers is not valid.
std::shared_ptr<const SamplerAdapter> adapter_of(const PointSampler& sampler, const std::string& name);

}  // namespace crescent
