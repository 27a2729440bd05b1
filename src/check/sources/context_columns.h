// The description of the surface point for a program behind a pipe, protocol 3: columns after w_o and u, or after w_o
// and w_i. docs/samplers.md has their order and units.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "samplers/external_sampler.h"

namespace crescent::inline sources {

/// The quantities that a handshake may name in `uses`: "s, alpha, rho_d, rho_s, side, eta, lights".
std::span<const std::string_view> context_names();

/// Number of columns of one row for a scene with this many lights.
std::size_t context_columns(std::span<const std::string> uses, std::size_t lights);

/// Appends the columns of one surface point, in the order of `uses`. `at`: each light relative to the point.
void add_context(std::span<const std::string> uses, const ExternalRun& point, std::span<const ExternalLight> lights,
    std::span<const ExternalLightAt> at, std::vector<double>& to);

/// Reads names of context_names() separated by commas, each at most once; returns false for any other text.
bool take_context_names(std::string_view text, std::vector<std::string>& out);

/// The light of a check.
struct ExampleLight {
    ExternalLight light;
    ExternalLightAt at;
};
ExampleLight example_light();

/// The columns of the surface on which `crescent check` tests a sampler: the default of a plugin, below one disk light.
std::vector<double> example_context(std::span<const std::string> uses);

}  // namespace crescent::inline sources
