// A sampler in another process, over its stdin and stdout. The handshake starts with `hello 2`, and the program answers
// with its declaration. A program that answers `hello 1 NAME` uses protocol 1, which is protocol 2 without keys; one
// that answers `hello 3` may declare the quantities of the surface point and the lights that it uses. Requests are text
// lines, or blocks of doubles if the program declares them; docs/samplers.md has the grammar. Local frame, n = +z; the
// program ends at the end of its input.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "check/sources/sampler_adapter.h"
#include "samplers/external_sampler.h"

namespace crescent::inline sources {

/// Time limits of a program behind a pipe or of a plugin.
struct PipeLimits {
    double hello_seconds = 60;   // until the first answer: a sky of millions of texels is read first
    double quiet_seconds = 10;   // without a byte while an answer is pending
    double call_seconds = 60;    // for one call of a function of a plugin
    double total_seconds = 120;  // in total; a slower program cannot be checked
    std::size_t longest_line = 4096;
    const std::atomic<bool>* stop = nullptr;  // if set, the program is ended and Interrupted is thrown
    /// Sets the same limit for each answer of either kind; 0: no change.
    void limit_answers(double seconds) {
        if (seconds > 0) hello_seconds = quiet_seconds = call_seconds = seconds;
    }
};

/// A program, checked by itself or as an arm of an experiment. Its requests are sequential, also for several callers.
class ProgramSampler : public ExternalSampler, public SamplerAdapter {
public:
    std::string name() const override = 0;
};

/// Starts `command` with /bin/sh -c. Throws SamplerError with the request, the answer and the expected answer;
/// InputError if the shell cannot start it, or if it answers `error TEXT` to the handshake. `label` is the prefix of
/// its stderr output and of that text; "": the command.
std::shared_ptr<const ProgramSampler> start_pipe(
    const std::string& command, const PipeLimits& limits = {}, const std::string& label = "");

// ---- The declaration of a program: `hello 1 NAME`, or `hello 2 NAME [KEY=VALUE]...`, or `hello 3 ...`;
// docs/samplers.md has the keys.

/// The declaration in the first line of a program.
struct Handshake {
    int protocol = 1;
    std::string name;
    Traits traits;
    bool hemisphere = false;  // a draw below the horizon is no sample
    bool f_cos = false;       // f includes |cos|
    bool weight = false, delta = false, blocks = false;
    std::vector<std::string> uses;  // protocol 3: of context_names()
    bool uses_lights() const { return std::ranges::find(uses, "lights") != uses.end(); }
};

/// The expected handshake, and the received one; both empty if it is valid.
struct HandshakeError {
    std::string expected, got;
    explicit operator bool() const { return !got.empty(); }
};
/// Reads the first line of a program.
HandshakeError read_handshake(std::string_view answer, Handshake& out);

}  // namespace crescent::inline sources
