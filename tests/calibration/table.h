// Tables of the results in Markdown.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace crescent::calibration {

/// Clopper-Pearson 1934: the one-sided 95 % upper and lower bound of a rate.
double upper_bound(std::uint64_t hits, std::uint64_t of);
double lower_bound(std::uint64_t hits, std::uint64_t of);

/// False positives, faults found by kind and size, causes, stated sizes, cost, p-values; by engine and mode, and paired
/// for engines that ran the same cases.
std::string table_of(const std::vector<nlohmann::ordered_json>& records);

}  // namespace crescent::calibration
