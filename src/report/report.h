// Makes metrics.json, metrics.csv, junit.xml, timing.json, report.html and the summary on the terminal from numbers and
// plates.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "metrics/article_checks.h"
#include "metrics/metrics.h"
#include "output/format.h"

namespace crescent {

/// The origin of an output; equal for equal runs.
struct Provenance {
    std::string version, commit, compiler, experiment_file, experiment_hash, backend, command;
    std::vector<std::uint32_t> seeds;
    std::vector<int> places;  // of these seeds in the experiment's series, from 1
    int series = 0;           // how many seeds the series has
    std::vector<std::pair<std::string, std::string>> backend_details{};  // what drivers report; none: the CPU
    std::string experiment_text{};  // canonical_text() of the experiment with all of its seeds

    /// Returns the places of the series that are not among `places`.
    std::vector<int> missing() const;
};
/// Formats {1, 2, 3, 7} as "1 to 3, 7".
std::string ranges_text(const std::vector<int>& ascending);

/// Values that vary from run to run, kept in timing.json.
struct ArmTiming {
    std::string arm;
    std::uint64_t n = 0;
    double s = 0;
    std::uint64_t samples = 0;
    double seconds = 0;
};
/// Values that vary from run to run; timing.json holds them. Seconds of wall-clock time.
struct Timing {
    double estimating_s = 0, total_s = 0;
    int threads = 0;
    std::string isa, date, host_cpu;
    std::vector<ArmTiming> arms;
    std::vector<std::pair<std::string, double>> stages;  // name, seconds
};

/// Which outputs a run writes; timing.json always is.
struct OutputParts {
    bool metrics = true;  // metrics.json, metrics.csv, junit.xml
    bool films = true;    // films/*.exr
    bool plates = true;   // plates/*.png
    bool report = true;   // report.html, with the plates in it
    bool draws() const { return plates || report; }
};

using Plates = std::map<std::string, std::vector<unsigned char>>;  // name -> PNG

/// The inputs of a report; all must outlive the call.
struct ReportInputs {
    const Experiment& experiment;
    const Metrics& metrics;
    const Evidence& evidence;  // "Where the article is wrong"
    const Provenance& provenance;
    const Plates& plates;
};

/// Returns the files of a report, as bytes: equal inputs give equal files.
std::string metrics_json(const ReportInputs& in);
/// The contents of a metrics.json, every number unchanged: metrics_json() of it gives the same bytes if bands, ladders
/// and assertions, which follow from the rest, are computed from it.
struct MetricsFile {
    Experiment experiment;  // with the seed and the number of seeds of this file
    Metrics metrics;
    Evidence evidence;
    Provenance provenance;
};
inline constexpr std::size_t most_bytes_of_metrics = std::size_t{2} << 30;  // a run of 4,096 seeds has some 500 MB
/// Throws InputError, with `name` for the file, if the text is something else or was changed.
MetricsFile read_metrics(const std::string& text, const std::string& name);
/// The same of a text that is parsed.
MetricsFile metrics_from_json(const Json& json, const std::string& name);
/// Throws InputError if a run is none of the experiment's, or has other regions.
void check_runs(const MetricsFile& file, const std::string& name);
std::string metrics_csv(const ReportInputs& in);
std::string junit_xml(const ReportInputs& in);
std::string report_html(const ReportInputs& in);
std::string timing_json(const Timing& timing, const Provenance& provenance);
/// Returns first whether all assertions held, then the values, then the files. Lines are cut at so many columns; 0:
/// none is cut.
std::string terminal_summary(const ReportInputs& in, const Timing& timing, const std::string& out_dir,
    const OutputParts& parts = {}, bool colour = false, std::size_t columns = 80);

// ---- The provenance of an output, as the JSON files of a run state it.

/// As in metrics.json.
Json provenance_json(const Provenance& provenance);

}  // namespace crescent
