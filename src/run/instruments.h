// Back ends that compute films, each with its word on the command line. The CPU's is built in; doors register theirs
// when the program starts.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/progress_monitor.h"
#include "films/film.h"
#include "meters/metrics.h"
#include "run/plan.h"

namespace crescent::inline estimator {
class TileCheckpoint;
class TiledScene;
}  // namespace crescent::inline estimator

namespace crescent::inline runs {

/// What computes films. One call at a time; what it throws ends the run.
class Instrument {
public:
    virtual ~Instrument() = default;
    virtual std::string name() const = 0;  // for provenance and plates
    /// One film per rung, in order. The view already has the job's s. `checkpoint`: where an instrument that works
    /// tile by tile keeps finished ones; null: nowhere.
    virtual std::vector<Film> films(
        const TiledScene& view, const Job& job, ProgressMonitor& monitor, TileCheckpoint* checkpoint = nullptr) = 0;
    /// What the provenance says of it beside its name: the driver's own words, by what they are ("GL_RENDERER").
    virtual std::vector<std::pair<std::string, std::string>> details() const { return {}; }
    /// Claims of its own that join the assertions ("framebuffer is RGBA32F").
    virtual std::vector<AssertionResult> assertions() const { return {}; }
};

/// The one that is built in; `isa` is a name of isas().
std::shared_ptr<Instrument> cpu_instrument(std::string isa);

/// What the command line may say of an instrument; "" and -1: the instrument's own choice.
struct InstrumentChoice {
    std::string context;
    int device = -1;
};

/// A device that an instrument can be opened on.
struct InstrumentDevice {
    int number = 0;     // as InstrumentChoice::device has it
    std::string means;  // in the driver's words
};

class InstrumentKind {
public:
    virtual ~InstrumentKind() = default;
    virtual std::string name() const = 0;  // "gl"
    /// Throws OutputError where a part is missing, InputError where the choice is not to be had.
    virtual std::shared_ptr<Instrument> open(const InstrumentChoice& choice) const = 0;
    /// None where its library is missing.
    virtual std::vector<InstrumentDevice> devices() const = 0;
};

/// Those that were registered. Called before main by a door's own initialiser.
std::vector<std::shared_ptr<const InstrumentKind>>& instrument_kinds();
/// Null: this program was built without it.
std::shared_ptr<const InstrumentKind> find_instrument(const std::string& name);

}  // namespace crescent::inline runs
