// Back ends that compute films, each with its name on the command line. The CPU's is built in; programs register others
// when they start.
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

namespace crescent {
class TiledScene;

/// Computes films. One call at a time; an exception ends the run.
class Backend {
public:
    virtual ~Backend() = default;
    virtual std::string name() const = 0;  // for provenance and plates
    /// Throws InputError with the place of a part of the experiment that this back end has no films of.
    virtual void check(const Experiment&) const {}
    /// Returns one film per sample count, in order. The view already has the job's s.
    virtual std::vector<Film> films(const TiledScene& view, const Job& job, ProgressMonitor& monitor) = 0;
    /// Returns details for the provenance, in the driver's own words, by their names ("GL_RENDERER").
    virtual std::vector<std::pair<std::string, std::string>> details() const { return {}; }
    /// Returns assertions of its own, added to those of the experiment ("framebuffer is RGBA32F").
    virtual std::vector<AssertionResult> assertions() const { return {}; }
};

/// Returns the built-in one; `isa` is a name of isas().
std::shared_ptr<Backend> cpu_backend(std::string isa);

/// The choices of the command line for a back end; "" and -1: the back end's own choice.
struct BackendChoice {
    std::string context;
    int device = -1;
};

/// A device on which a back end can be opened.
struct BackendDevice {
    int number = 0;     // like BackendChoice::device
    std::string means;  // in the driver's words
};

/// A kind of back end, registered by a program and opened by name.
class BackendKind {
public:
    virtual ~BackendKind() = default;
    virtual std::string name() const = 0;  // "gl"
    /// Throws OutputError if a part is missing, InputError if the choice is not available.
    virtual std::shared_ptr<Backend> open(const BackendChoice& choice) const = 0;
    /// Returns none if its library is missing.
    virtual std::vector<BackendDevice> devices() const = 0;
};

/// Returns the registered kinds. Called before main by initialisers of the front ends.
std::vector<std::shared_ptr<const BackendKind>>& backend_kinds();
/// Returns null if this program was built without it.
std::shared_ptr<const BackendKind> find_backend(const std::string& name);

}  // namespace crescent

// ---- The hook that makes an explainer video of an experiment. apps/explainer registers itself here when the program
// starts; the library does not depend on it.

namespace crescent {

/// The options of an explainer video.
struct ExplainerOptions {
    std::string out = "out/film";
    int height = 1080;     // of 16:9 frames
    int threads = 0;       // 0: as many as this process may use
    int shot = 0;          // 1 ..: only that shot; 0: all
    std::string still;     // "MM:SS" or "SS": only this frame, as a PNG
    bool stills = false;   // only one PNG per shot
    std::string from, to;  // "MM:SS": only this part; "": beginning, end
    std::string isa;       // "": the best this machine has
    std::string command;   // as typed, for the last shot
    double timeout_s = 0;  // for one response of a program or plugin; 0: 10 and 60 s
};

/// Makes the video and publishes it under options.out at once; returns a summary for the terminal.
using ExplainerHook = std::function<std::string(const Experiment&, const ExplainerOptions&, ProgressMonitor&)>;

/// Empty if this program was built without it.
ExplainerHook& film_maker();

}  // namespace crescent
