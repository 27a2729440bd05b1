// Numbers and plates -> metrics.json, metrics.csv, junit.xml, timing.json, report.html and the summary on the
// terminal.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "metrics/article_checks.h"
#include "metrics/metrics.h"

namespace crescent::inline report {

/// Where an output came from; equal for equal runs.
struct Provenance {
    std::string version, commit, compiler, experiment_file, experiment_hash, backend, command;
    std::vector<std::uint32_t> seeds;
    std::vector<int> places;  // of these seeds in the experiment's series, from 1
    int series = 0;           // how many seeds the series has
    std::vector<std::pair<std::string, std::string>> backend_details{};  // what a driver says of itself; none: the CPU
    std::string experiment_text{};  // canonical_text() of the experiment with all of its seeds

    /// The places of the series that are not among `places`.
    std::vector<int> missing() const;
};
/// {1, 2, 3, 7} -> "1 to 3, 7".
std::string ranges_text(const std::vector<int>& ascending);

/// What varies from run to run; stands apart in timing.json.
struct ArmTiming {
    std::string arm;
    std::uint64_t n = 0;
    double s = 0;
    std::uint64_t samples = 0;
    double seconds = 0;
};
/// What varies from run to run; timing.json holds it. Seconds of wall-clock time.
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

/// What a report is written from; all must outlive the call.
struct ReportInputs {
    const Experiment& experiment;
    const Metrics& metrics;
    const Evidence& evidence;  // "Where the article is wrong"
    const Provenance& provenance;
    const Plates& plates;
};

/// The files of a report, as bytes: the same inputs give the same ones.
std::string metrics_json(const ReportInputs& in);
/// What a metrics.json holds, every number as it was: metrics_json() of it gives the same bytes where bands, ladders
/// and assertions, which follow from the rest, are computed from it.
struct MetricsFile {
    Experiment experiment;  // with the seed and the number of seeds of this file
    Metrics metrics;
    Evidence evidence;
    Provenance provenance;
};
/// Throws InputError, with `name` for the file, where the text is something else or was changed.
MetricsFile read_metrics(const std::string& text, const std::string& name);
std::string metrics_csv(const ReportInputs& in);
std::string junit_xml(const ReportInputs& in);
std::string report_html(const ReportInputs& in);
std::string timing_json(const Timing& timing, const Provenance& provenance);
/// At most 80 columns: first whether all held, then the figures, then where to look.
std::string terminal_summary(const ReportInputs& in, const Timing& timing, const std::string& out_dir,
    const OutputParts& parts = {}, bool colour = false);

}  // namespace crescent::inline report
