// How a sampler from outside fails to answer: what is thrown to whoever asked it.
#pragma once

#include <stdexcept>

namespace crescent::inline subjects {

/// The sampler cannot be talked with any more: what happened, at which request.
struct SubjectFault : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// It was given up in an earlier trial.
struct SubjectGone : SubjectFault {
    using SubjectFault::SubjectFault;
};

/// The program keeps to the protocol but needs more than PipeLimits::total_seconds.
struct SubjectTooSlow : SubjectFault {
    using SubjectFault::SubjectFault;
};

}  // namespace crescent::inline subjects
