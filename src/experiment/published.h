// Figures that someone published for an experiment, to stand beside the measured ones. JSON:
//   {"source": "...", "seed": 7, "runs": [{"arm": "cosine", "n": 64, "s": 32, "rmse.H": 7.66, ...}], "furnaces":
//   {"NAME": 0.29}}
// Meters are named as in metrics.h: rmse.REGION, var.REGION, fireflies, horizon_frac, y_mean.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

namespace crescent::inline experiment {

class Published {
public:
    std::string source;
    std::optional<std::uint32_t> seed;  // of the published run, where it is known

    std::optional<double> find(const std::string& arm, std::uint64_t n, double s, const std::string& meter) const;
    std::optional<double> furnace(const std::string& name) const;

    std::map<std::tuple<std::string, std::uint64_t, double, std::string>, double> runs;  // arm, n, s, meter
    std::map<std::string, double> furnaces;
};

/// Nothing where `path` is empty; throws InputError where the file cannot be read or is not of the form above.
std::optional<Published> load_published(const std::string& path);
/// The same from text, `name` standing for the file in messages.
Published parse_published(std::string_view text, const std::string& name);

/// A whole text file of at most 4 MiB; `what` names it in the InputError where it cannot be read.
std::string read_text(const std::string& path, std::string_view what);

}  // namespace crescent::inline experiment
