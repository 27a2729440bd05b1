// Joins parts of one experiment, each run with a part of the seeds, possibly on different machines, into the run of all
// of them.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "run/collect.h"

namespace crescent {

/// Joins parts: each a metrics.json or the folder of one. The metrics are those of one run with all seeds, bit for bit.
/// There are no films, so assertions on plates are skipped; if seeds are missing, assertions that need them are too.
/// Throws InputError if a part cannot be read or is of another experiment, build or back end, or if two parts give two
/// values for one quantity.
Measured join(const std::vector<std::string>& parts, const std::string& command);
/// The same of the texts of metrics.json.
Measured join_texts(const std::vector<std::string>& texts, const std::string& command);

/// Writes metrics.json, metrics.csv and junit.xml, all at once. Throws OutputError.
void write_metrics(const Measured& result, const std::string& folder, ProgressMonitor& monitor);

}  // namespace crescent
