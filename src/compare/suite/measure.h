// Reads the renders of views and tests them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/progress.h"
#include "compare/renders.h"
#include "compare/suite/suite.h"

namespace crescent {

/// Returns a hash of the pixels of a render, to find copies.
std::uint64_t pixel_hash(const Render& render);

/// Reads and tests one view. `compared`: the number of views that share alpha.
ViewResult measure_view(const Suite& suite, const SuiteView& view, std::size_t compared, ProgressMonitor& monitor,
    const RenderSource& source);

/// Measures and decides every view, one view in memory at a time. A view whose files cannot be compared, or differ from
/// the manifest, is unreadable; the others are compared all the same.
SuiteResult compare_suite(const Suite& suite, ProgressMonitor& monitor, const RenderSource& source);
/// The same of files, read as the suite states.
SuiteResult compare_suite(const Suite& suite, ProgressMonitor& monitor);

}  // namespace crescent
