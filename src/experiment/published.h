// Published values for an experiment, shown next to the measured ones. JSON:
//   {"source": "...", "seed": 7, "runs": [{"arm": "cosine", "n": 64, "s": 32, "rmse.H": 7.66, ...}], "furnaces":
//   {"NAME": 0.29}}
// Metrics are named as in metrics.h: rmse.REGION, var.REGION, fireflies, horizon_frac, y_mean.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

namespace crescent {

/// Values that were published for an experiment, by arm, sample count, exponent and metric.
class Published {
public:
    std::string source;
    std::optional<std::uint32_t> seed;  // of the published run, if known

    /// Returns empty if none was published.
    std::optional<double> find(const std::string& arm, std::uint64_t n, double s, const std::string& metric) const;
    /// Returns the value of the furnace of this name; empty if none was published.
    std::optional<double> furnace(const std::string& name) const;

    std::map<std::tuple<std::string, std::uint64_t, double, std::string>, double> runs;  // arm, n, s, metric
    std::map<std::string, double> furnaces;
};

/// Returns nothing if `path` is empty; throws InputError if the file cannot be read or does not have the form above.
std::optional<Published> load_published(const std::string& path);
/// The same from text; `name` is the file's name in messages.
Published parse_published(std::string_view text, const std::string& name);

}  // namespace crescent
