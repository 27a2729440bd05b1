// Plates may be many and large, but not larger than the pages that embed them.
#include "run/stored_run.h"

#include <filesystem>
#include <string_view>

#include "base/errors.h"
#include "base/input.h"
#include "experiment/experiment.h"
#include "report/report.h"

namespace crescent {

namespace {

std::vector<unsigned char> read_plate(const std::filesystem::path& path) {
    constexpr std::size_t most_bytes = std::size_t{256} << 20;
    constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
    const std::string bytes = read_input(path.string(), most_bytes, "a plate");
    if (!bytes.starts_with(signature)) throw InputError({path.string(), 0, 0}, "expected a PNG image");
    return {bytes.begin(), bytes.end()};
}

}  // namespace

Plates read_plates(const std::filesystem::path& folder) {
    Plates out;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".png") out[entry.path().stem().string()] = read_plate(entry.path());
    return out;
}

StoredRun open_run(const Json& json, const std::string& path) {
    MetricsFile file = metrics_from_json(json, path);
    check_runs(file, path);
    StoredRun out;
    Measured& m = out.measured;
    m.experiment = std::move(file.experiment);
    m.metrics = std::move(file.metrics);
    m.evidence = std::move(file.evidence);
    m.provenance = std::move(file.provenance);
    m.metrics.series = seeds_of(parse(m.provenance.experiment_text, path));
    const std::vector<AssertionResult> assertions = m.metrics.assertions;  // some are of plates
    add_spreads(m);
    m.metrics.assertions = assertions;
    const std::filesystem::path folder = std::filesystem::path(path).parent_path() / "plates";
    m.plates = read_plates(folder);
    for (const PlatePlan& plan : m.experiment.plates)
        if (!m.plates.contains(plan.name)) out.missing.push_back((folder / (plan.name + ".png")).string());
    return out;
}

}  // namespace crescent
