// First step of a run: an experiment -> everything there is to do, as plain values that can be sent elsewhere. Nothing
// is computed here.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "samplers/external_sampler.h"

namespace crescent::inline runs {

/// One pass over the pixels: one arm, every sample count, one exponent, one seed.
struct Job {
    std::string arm, sampler;      // its name in the experiment, and its word in arms/all.h
    std::vector<std::uint64_t> n;  // ascending
    double s = 0;
    std::uint32_t seed = 0;
    std::shared_ptr<const ExternalSampler> outside = {};  // set by execute() where the arm is not built in
};

/// A part of an experiment's series of seeds, counted from 1, both ends included; last = 0: to the end of the series.
struct SeedRange {
    int first = 1, last = 0;
};

struct RunPlan {
    /// As it was given, with its published figures. What does not depend on the seeds of this plan is measured of it.
    Experiment whole;
    /// The same; its seed is the first of this plan's, `seeds` how many there are.
    Experiment experiment;
    std::uint64_t hash = 0;            // of the whole
    SeedRange range;                   // last is never 0 here
    std::vector<std::uint32_t> seeds;  // no two alike; films of the first are kept, of the others metrics alone
    std::vector<double> exponents;     // every s that a job has: a reference is needed for each
    std::vector<Job> jobs;             // seed by seed
};

/// Throws InputError where the series has no such seeds, or the published figures cannot be read.
RunPlan plan(const Experiment& experiment, SeedRange range = {});

/// The series of seeds of an experiment, no two alike: its own first.
std::vector<std::uint32_t> seeds_of(const Experiment& experiment);

/// Every pass of one seed: each arm at the experiment's own s, then the exponent control where it adds anything.
std::vector<Job> jobs_of(const Experiment& experiment, std::uint32_t seed);

}  // namespace crescent::inline runs
