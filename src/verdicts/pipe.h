// A sampler in another process, over its stdin and stdout, one request a line, one answer a line, in order:
//   hello 1                          -> hello 1 NAME
//   sample wox woy woz u1 u2         -> wix wiy wiz pdf      (pdf 0: nothing drawn)
//   pdf wox woy woz wix wiy wiz      -> p
//   f wox woy woz wix wiy wiz        -> f, without the cosine, or - where the program has no BRDF
// Local frame, n = +z; decimal or hexadecimal floats, separated by blanks; end of input ends it. Requests run far ahead
// of the answers, both ways without blocking, so that neither side waits for the other.
#pragma once

#include <atomic>
#include <chrono>

#include "verdicts/judge.h"

namespace crescent {

struct PipeLimits {
    double hello_seconds = 10;   // until the first answer
    double quiet_seconds = 10;   // without a byte while an answer is due
    double total_seconds = 120;  // for everything; beyond it the program is too slow to judge
    std::size_t longest_line = 4096;
    const std::atomic<bool>* stop = nullptr;  // when set, the program is ended and Interrupted thrown
};

/// Starts `command` with /bin/sh -c. Throws SubjectFault that says at which request, what came and what was expected.
std::shared_ptr<const JudgedSampler> start_pipe(const std::string& command, const PipeLimits& limits = {});

}  // namespace crescent
