// What a run computes: its passes over the pixels, and the CPU as the instrument that makes them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "instruments.h"

namespace crescent {

/// Every pass of one seed: each arm at the experiment's own s, then the exponent control where it adds anything.
std::vector<Job> jobs_of(const Experiment& experiment, std::uint32_t seed);

/// The instrument that is built in; `isa` is a name of isas().
std::shared_ptr<Instrument> cpu_instrument(std::string isa);

}  // namespace crescent
