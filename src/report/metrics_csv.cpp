// metrics.csv: every run in long form, one number a row, in RFC 4180 (CRLF, quotes doubled). The region is empty for
// the meters of the whole frame; a column follows for each key that --set gave, named as --set named it, `set.seed` and
// `set.n` for the two keys that are columns already. Units are those of meters/metrics.h.
#include <algorithm>
#include <array>
#include <string_view>

#include "experiment/override_text.h"
#include "pages/csv.h"
#include "pages/numbers.h"
#include "report/report.h"

namespace crescent::inline report {
namespace {

constexpr std::array<std::string_view, 7> fixed_columns = {"arm", "n", "s", "seed", "meter", "region", "value"};

struct Rows {
    std::string out;
    std::string run;  // "arm,n,s,seed,", the same for all rows of a run
    std::string set;  // ",64": a value for each key that --set gave, the same for all rows

    void add(std::string_view meter, std::string_view region, const std::string& value) {
        out += run + csv_field(meter) + "," + csv_field(region) + "," + value + set + "\r\n";
    }
    void add(std::string_view meter, std::string_view region, double value) { add(meter, region, shortest(value)); }
    void add(std::string_view meter, std::string_view region, std::uint64_t value) {
        add(meter, region, std::to_string(value));
    }
};

void add_region(Rows& rows, const RegionMeter& r) {
    for_each_meter(r, [&](std::string_view name, const MeterInfo&, auto value) { rows.add(name, r.region, value); });
    rows.add("pixels", r.region, r.pixels);
    if (!r.tail) return;
    rows.add("tail_k", r.region, r.tail->k);
    rows.add("tail_se", r.region, r.tail->se);
    rows.add("tail_exceedances", r.region, std::uint64_t{r.tail->exceedances});
}

/// What --set gave, key by key in the order of first mention; of a key that was given twice the last value, which
/// holds. The number of seeds is left out: each row is of one seed.
std::vector<std::pair<std::string, std::string>> overrides_of(const Experiment& experiment) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const std::string& text : experiment.overrides) {
        const std::size_t equals = end_of_path(text);
        const std::string path = text.substr(0, equals), value = text.substr(equals + 1);
        if (path == "seeds") continue;
        const auto known = std::ranges::find(out, path, &std::pair<std::string, std::string>::first);
        if (known == out.end()) out.emplace_back(path, value);
        else known->second = value;
    }
    return out;
}

/// A key's column: the key as it was given, but for one that would be the second column of its name.
std::string column_of(const std::string& path) {
    return std::ranges::find(fixed_columns, path) == fixed_columns.end() ? path : "set." + path;
}

}  // namespace

std::string metrics_csv(const ReportInputs& in) {
    Rows rows;
    for (const std::string_view name : fixed_columns) rows.out += (rows.out.empty() ? "" : ",") + std::string(name);
    for (const auto& [path, value] : overrides_of(in.experiment)) {
        rows.out += "," + csv_field(column_of(path));
        rows.set += "," + csv_field(value);
    }
    rows.out += "\r\n";
    for (const RunMeter& run : in.metrics.runs) {
        rows.run = csv_field(run.key.arm) + "," + std::to_string(run.key.n) + "," + shortest(run.key.s) + "," +
            std::to_string(run.key.seed) + ",";
        for (const RegionMeter& r : run.regions) add_region(rows, r);
        for_each_meter(run, [&](std::string_view name, const MeterInfo&, auto value) { rows.add(name, "", value); });
    }
    return rows.out;
}

}  // namespace crescent::inline report
