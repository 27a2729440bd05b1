// What a program behind a pipe may receive of the surface point, protocol 3: columns after w_o and u, or after w_o and
// w_i. docs/samplers.md has their order and units.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "samplers/external_sampler.h"

namespace crescent::inline sources {

/// The quantities that a handshake may name by `uses`: "s, alpha, rho_d, rho_s, side, eta, lights".
std::span<const std::string_view> context_names();

/// Columns of one row where the scene has so many lights.
std::size_t context_columns(std::span<const std::string> uses, std::size_t lights);

/// Appends the columns of one surface point, in the order of `uses`. `at`: each light as the point sees it.
void add_context(std::span<const std::string> uses, const ExternalRun& point, std::span<const ExternalLight> lights,
    std::span<const ExternalLightAt> at, std::vector<double>& to);

/// Reads names of context_names() separated by commas, each at most once; false if it is anything else.
bool take_context_names(std::string_view text, std::vector<std::string>& out);

/// The light of a check.
struct ExampleLight {
    ExternalLight light;
    ExternalLightAt at;
};
ExampleLight example_light();

/// The columns on the surface on which `crescent check` tests a sampler: the default of a plugin, below one disk light.
std::vector<double> example_context(std::span<const std::string> uses);

}  // namespace crescent::inline sources
