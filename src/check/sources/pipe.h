// A sampler in another process, over its stdin and stdout. It is greeted with `hello 2` and says what it is; one that
// answers `hello 1 NAME` is spoken to in protocol 1, which is protocol 2 without keys. Text lines, or blocks of doubles
// where it asks for them; docs/samplers.md has the grammar. Local frame, n = +z; end of input ends it.
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "check/sources/sampler_adapter.h"

namespace crescent::inline sources {

/// What a program behind a pipe, or a plugin, may take.
struct PipeLimits {
    double hello_seconds = 60;   // until the first answer: a sky of millions of texels is read first
    double quiet_seconds = 10;   // without a byte while an answer is due
    double call_seconds = 60;    // of a plugin: for one call of a function
    double total_seconds = 120;  // for everything; beyond it the program is too slow to check
    std::size_t longest_line = 4096;
    const std::atomic<bool>* stop = nullptr;  // when set, the program is ended and Interrupted thrown
    /// The same limit for each answer of either kind; 0: as it is.
    void limit_answers(double seconds) {
        if (seconds > 0) hello_seconds = quiet_seconds = call_seconds = seconds;
    }
};

/// Starts `command` with /bin/sh -c. Throws SamplerError that says at which request, what came and what was expected;
/// InputError if the shell cannot start it, or if it answers `error TEXT` to the handshake. `label` is before what it
/// writes to stderr and before that text; "": the command.
std::shared_ptr<const SamplerAdapter> start_pipe(
    const std::string& command, const PipeLimits& limits = {}, const std::string& label = "");

// ---- What a program says of itself: `hello 1 NAME`, or `hello 2 NAME [KEY=VALUE]...`; docs/samplers.md has the keys.

/// What a program declares of itself in its first line.
struct Handshake {
    int protocol = 1;
    std::string name;
    Traits traits;
    bool hemisphere = false;  // a draw under the horizon is nothing drawn
    bool f_cos = false;       // f comes with |cos|
    bool weight = false, delta = false, blocks = false;
};

/// What was expected of a greeting, and what came in place of it; both empty where it could be read.
struct HandshakeError {
    std::string expected, got;
    explicit operator bool() const { return !got.empty(); }
};
/// Reads the first line that a program answers.
HandshakeError read_handshake(std::string_view answer, Handshake& out);

}  // namespace crescent::inline sources
