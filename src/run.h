// One run from experiment to report: the order in which the parts are called, and what is written where.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/watch.h"
#include "experiment/experiment.h"
#include "films/film.h"
#include "meters/metrics.h"
#include "report/report.h"
#include "scene/scene.h"

namespace crescent {

class TileKeeper;

/// One pass over the pixels: one arm, every rung, one exponent, one seed.
struct Job {
    const ArmPlan* arm = nullptr;
    std::vector<std::uint64_t> n;  // ascending
    double s = 0;
    std::uint32_t seed = 0;
    TileKeeper* keeper = nullptr;  // an instrument that works tile by tile may keep finished ones in it
};

/// What computes films. The CPU's is built in; a door may bring another (GL).
class Instrument {
public:
    virtual ~Instrument() = default;
    virtual std::string name() const = 0;  // for provenance and plates
    /// One film per rung, in order. The scene already has the job's s.
    virtual std::vector<Film> films(const Scene& scene, const Job& job, Watch& watch) = 0;
    /// What the provenance says of it beside its name: the driver's own words, by what they are ("GL_RENDERER").
    virtual std::vector<std::pair<std::string, std::string>> details() const { return {}; }
    /// Claims of its own that join the assertions ("framebuffer is RGBA32F").
    virtual std::vector<AssertionResult> assertions() const { return {}; }
};

struct RunOptions {
    std::string out = "out";
    int threads = 0;       // 0: as many as the machine has
    std::string isa;       // "": the best this machine has
    std::string command;   // as typed, for the provenance
    double keep_after_s = 10;  // passes and runs that take longer keep what they have finished, see kept.h
    std::shared_ptr<Instrument> instrument;  // null: the CPU
};

struct RunResult {
    Metrics metrics;
    Timing timing;
    Provenance provenance;
    std::string summary;  // for the terminal
};

/// Runs `experiment` and writes everything under options.out; outputs appear whole or not at all.
RunResult run(const Experiment& experiment, const RunOptions& options, Watch& watch);

}  // namespace crescent
