// Back ends that compute films, each with its word on the command line. The CPU's is built in; doors register theirs
// when the program starts.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "experiment/experiment.h"
#include "metrics/metrics.h"
#include "render/film.h"
#include "run/plan.h"

namespace crescent::inline render {
class TileCheckpoint;
class TiledScene;
}  // namespace crescent::inline render

namespace crescent::inline runs {

/// What computes films. One call at a time; what it throws ends the run.
class Backend {
public:
    virtual ~Backend() = default;
    virtual std::string name() const = 0;  // for provenance and plates
    /// One film per sample count, in order. The view already has the job's s. `checkpoint`: where an back end that
    /// works tile by tile keeps finished ones; null: nowhere.
    virtual std::vector<Film> films(
        const TiledScene& view, const Job& job, ProgressMonitor& monitor, TileCheckpoint* checkpoint = nullptr) = 0;
    /// What the provenance says of it beside its name: the driver's own words, by what they are ("GL_RENDERER").
    virtual std::vector<std::pair<std::string, std::string>> details() const { return {}; }
    /// Claims of its own that join the assertions ("framebuffer is RGBA32F").
    virtual std::vector<AssertionResult> assertions() const { return {}; }
};

/// The one that is built in; `isa` is a name of isas().
std::shared_ptr<Backend> cpu_backend(std::string isa);

/// What the command line may say of an back end; "" and -1: the back end's own choice.
struct BackendChoice {
    std::string context;
    int device = -1;
};

/// A device that an back end can be opened on.
struct BackendDevice {
    int number = 0;     // as BackendChoice::device has it
    std::string means;  // in the driver's words
};

/// A kind of back end, which a program registers; opened by name.
class BackendKind {
public:
    virtual ~BackendKind() = default;
    virtual std::string name() const = 0;  // "gl"
    /// Throws OutputError where a part is missing, InputError where the choice is not to be had.
    virtual std::shared_ptr<Backend> open(const BackendChoice& choice) const = 0;
    /// None where its library is missing.
    virtual std::vector<BackendDevice> devices() const = 0;
};

/// Those that were registered. Called before main by a door's own initialiser.
std::vector<std::shared_ptr<const BackendKind>>& backend_kinds();
/// Null: this program was built without it.
std::shared_ptr<const BackendKind> find_backend(const std::string& name);

}  // namespace crescent::inline runs

// ---- What makes an explainer film of an experiment. explainer/ registers itself here when the program starts; the
// library does not depend on it.

namespace crescent {

/// What of the film is made, and how.
struct ExplainerOptions {
    std::string out = "out/film";
    int height = 1080;     // of 16:9 frames
    int threads = 0;       // 0: as many as this process may use
    int shot = 0;          // 1 ..: that shot alone; 0: all
    std::string still;     // "MM:SS" or "SS": this frame alone, as a PNG
    bool stills = false;   // one PNG a shot and nothing else
    std::string from, to;  // "MM:SS": this part alone; "": beginning, end
    std::string voice;     // a command: text on stdin, WAV on stdout; "": silent
    std::string isa;       // "": the best this machine has
    std::string command;   // as typed, for the last shot
    bool webm = false;
    double timeout_s = 0;  // for one answer of a program or plugin; 0: 10 and 60 s
};

/// Makes the film and publishes it under options.out as one; returns a summary for the terminal.
using ExplainerHook = std::function<std::string(const Experiment&, const ExplainerOptions&, ProgressMonitor&)>;

/// Empty: this program was built without it.
ExplainerHook& film_maker();

}  // namespace crescent
