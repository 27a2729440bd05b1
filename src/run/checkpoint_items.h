// The bytes of a checkpoint: items, each with a checksum. The first is the key of the run, each other one the metrics
// of passes that were finished together.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "metrics/metrics.h"

namespace crescent {

/// Returns the item with the key of a run.
std::string key_item(std::string_view key);
/// Returns the item with these metrics.
std::string metrics_item(const std::vector<RunMetrics>& metrics);

/// The beginning of a checkpoint that can be used.
struct CheckpointContent {
    bool has_key = false;   // it begins with the key of this run
    std::size_t bytes = 0;  // of the undamaged items from the start; what follows is incomplete or damaged
    std::vector<RunMetrics> metrics{};
};

/// Reads the items of the run with this key. Stops at the first item whose checksum, length or regions do not fit.
CheckpointContent read_items(std::string_view bytes, std::string_view key, const Experiment& experiment);

}  // namespace crescent
