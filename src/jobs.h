// What a run computes: its passes over the pixels, and the CPU as the instrument that makes them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "instruments.h"
#include "report/report.h"

namespace crescent {

/// The seeds of an experiment, no two alike: its own first.
std::vector<std::uint32_t> seeds_of(const Experiment& experiment);

/// Every pass of one seed: each arm at the experiment's own s, then the exponent control where it adds anything.
std::vector<Job> jobs_of(const Experiment& experiment, std::uint32_t seed);

/// The instrument that is built in; `isa` is a name of isas().
std::shared_ptr<Instrument> cpu_instrument(std::string isa);

/// The tail index of one arm's samples X in a box, read off as many samples as about four million allow; none where too
/// few spread.
std::optional<Tail> region_tail(
    const Scene& scene, const Job& job, const Box& box, const std::string& isa, Watch& watch);

Provenance provenance_of(const Experiment& experiment, const Instrument& instrument, const std::string& command);

}  // namespace crescent
