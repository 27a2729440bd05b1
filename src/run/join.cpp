// What does not depend on the seed must agree in all parts, and rows of one seed wherever two parts have it. Film
// hashes, and values that compare references by films, are of a run's first seed: they come from the part that begins
// with it. Tails are of the experiment's own seed in every part and are stored with the first seed.
#include "run/join.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include "base/errors.h"
#include "base/files.h"
#include "base/input.h"
#include "experiment/experiment.h"
#include "output/format.h"
#include "run/collect.h"
#include "run/plan.h"

namespace crescent {

namespace {

struct Part {
    std::string name;
    Json json;
    MetricsFile file;
};

Part part_of(const std::string& text, const std::string& path) {
    Json json = parse_json(text, path, "the metrics.json of a run");
    MetricsFile file = metrics_from_json(json, path);
    check_runs(file, path);
    return {path, std::move(json), std::move(file)};
}

Part read_part(const std::string& argument) {
    std::error_code ignored;
    const bool is_folder = std::filesystem::is_directory(argument, ignored);
    const std::string path = is_folder ? (std::filesystem::path(argument) / "metrics.json").string() : argument;
    return part_of(read_input(path, most_bytes_of_metrics, "the metrics.json of a run, or the folder of one,"), path);
}

/// "section.key" -> value, of an experiment's canonical text.
std::map<std::string, std::string> values_in(const std::string& text) {
    std::map<std::string, std::string> out;
    std::string section;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        const std::size_t equals = line.find(" = ");
        if (line.starts_with('[')) section = line.substr(1, line.size() - 2) + ".";
        else if (equals != std::string::npos) out[section + line.substr(0, equals)] = line.substr(equals + 3);
        begin = end + 1;
    }
    return out;
}

/// Returns where two experiments differ: "; ball.s is 32 there and 64 here".
std::string difference(const std::string& first, const std::string& second) {
    const auto a = values_in(first), b = values_in(second);
    std::set<std::string> keys;
    for (const auto& values : {a, b})
        for (const auto& [key, value] : values) keys.insert(key);
    const auto message = [](const auto& in, const std::string& key) {
        const auto entry = in.find(key);
        return entry == in.end() ? "not given" : entry->second.substr(0, 60);
    };
    for (const std::string& key : keys)
        if (key != "seeds" && message(a, key) != message(b, key))
            return fmt::format("; {} is {} there and {} here", key, message(a, key), message(b, key));
    return "; the published figures differ";
}

[[noreturn]] void refuse(const Part& first, const Part& part, const std::string& reason) {
    throw InputError({part.name, 0, 0}, fmt::format("cannot be joined with {}: {}", first.name, reason));
}

void check_same(const Part& first, const Part& part, const std::string& what, const Json& a, const Json& b) {
    if (a.dump() != b.dump())
        refuse(first, part, fmt::format("{} differs; expected the same value, bit for bit", what));
}

/// Returns the references without the films that they were compared by.
Json of_no_film(Json references) {
    for (Json& reference : references)
        for (const char* key : {"rmse_unlike", "error_share"}) reference.erase(key);
    return references;
}

/// Hashes of references, whose names are not those of runs.
Json reference_hashes(const Part& part) {
    Json out = part.json.at("films");
    for (const RunMetrics& run : part.file.metrics.runs) out.erase(to_string(run.key));
    return out;
}

void check_alike(const Part& first, const Part& part) {
    const Provenance &a = first.file.provenance, &b = part.file.provenance;
    if (a.experiment_hash != b.experiment_hash)
        refuse(first, part,
            "it is of another experiment" + difference(a.experiment_text, b.experiment_text) +
                "; expected parts of one experiment");
    for (const auto& [what, x, y] : {std::tuple("version", a.version, b.version), {"commit", a.commit, b.commit},
             {"instrument", a.backend, b.backend}})
        if (x != y) refuse(first, part, fmt::format("{} is '{}' there and '{}' here", what, x, y));
    for (const char* key : {"geometry_pixels", "shape_pixels", "furnace", "evidence"})
        check_same(first, part, fmt::format("'{}'", key), first.json.at(key), part.json.at(key));
    check_same(
        first, part, "the reference", of_no_film(first.json.at("references")), of_no_film(part.json.at("references")));
    check_same(first, part, "the hash of a reference", reference_hashes(first), reference_hashes(part));
    if (a.seeds.front() != b.seeds.front()) return;
    check_same(first, part, "'films'", first.json.at("films"), part.json.at("films"));
    check_same(first, part, "'references'", first.json.at("references"), part.json.at("references"));
}

using TailKey = std::tuple<std::string, double, std::string>;  // arm, s, region

/// Runs of all parts by their seed, without tails.
class Rows {
public:
    void add(const Part& part) {
        const Json& rows = part.json.at("runs");
        std::set<std::uint32_t> fresh;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            RunMetrics run = part.file.metrics.runs[k];
            Json row = rows[k];
            for (RegionMetrics& region : run.regions) {
                Json& entry = row.at("regions").at(region.region);
                if (region.tail) add_tail(part, run, region, entry);
                entry.erase("tail");
                region.tail.reset();
            }
            const auto [match, is_new] =
                text_.try_emplace({run.key.arm, run.key.n, run.key.s, run.key.seed}, std::pair(row.dump(), part.name));
            if (!is_new && match->second.first != row.dump())
                throw InputError({part.name, 0, 0},
                    fmt::format("cannot be joined with {}: {} at seed {} differs; expected the same numbers, bit for "
                                "bit",
                        match->second.second, to_string(run.key), run.key.seed));
            if (is_new) by_seed_[run.key.seed].push_back(std::move(run));
        }
    }

    const std::vector<RunMetrics>* of(std::uint32_t seed) const {
        const auto entry = by_seed_.find(seed);
        return entry == by_seed_.end() ? nullptr : &entry->second;
    }

    void give_tails(RunMetrics& run) const {
        for (RegionMetrics& region : run.regions)
            if (const auto tail = tails_.find({run.key.arm, run.key.s, region.region}); tail != tails_.end())
                region.tail = tail->second.tail;
    }

private:
    struct KnownTail {
        std::optional<Tail> tail;
        std::string text;
    };

    void add_tail(const Part& part, const RunMetrics& run, const RegionMetrics& region, const Json& entry) {
        const std::string text = entry.at("tail").dump();
        const auto [match, is_new] =
            tails_.try_emplace({run.key.arm, run.key.s, region.region}, KnownTail{region.tail, text});
        if (!is_new && match->second.text != text)
            throw InputError({part.name, 0, 0},
                fmt::format("cannot be joined: the tail of {} in {} differs from that of a part before; expected the "
                            "same, bit for bit",
                    run.key.arm, region.region));
    }

    std::map<std::tuple<std::string, std::uint64_t, double, std::uint32_t>, std::pair<std::string, std::string>> text_;
    std::map<std::uint32_t, std::vector<RunMetrics>> by_seed_;
    std::map<TailKey, KnownTail> tails_;
};

/// Assertions of the back end, which follow the experiment's own; if one fails in any part, it fails.
std::vector<AssertionResult> backend_claims(const std::vector<Part>& parts) {
    std::vector<AssertionResult> out;
    for (const Part& part : parts) {
        const auto& results = part.file.metrics.assertions;
        for (std::size_t k = part.file.experiment.assertions.size(); k < results.size(); ++k) {
            const auto match = std::ranges::find(out, results[k].name, &AssertionResult::name);
            if (match == out.end()) out.push_back(results[k]);
            else if (results[k].failed()) *match = results[k];
        }
    }
    return out;
}

Measured join_parts(const std::vector<Part>& parts, const Rows& rows, const std::string& command) {
    if (parts.empty()) throw InputError({"join", 0, 0}, "expected the folders of one or more runs, found none");
    const auto of_longest_series =
        std::ranges::max_element(parts, {}, [](const Part& part) { return part.file.provenance.series; });
    Measured out;
    out.experiment = of_longest_series->file.experiment;
    out.provenance = of_longest_series->file.provenance;
    out.provenance.command = command;
    out.provenance.seeds.clear();
    out.provenance.places.clear();
    Experiment experiment = parse(out.provenance.experiment_text, "experiment");
    out.metrics.series = seeds_of(experiment);
    for (std::size_t k = 0; k < out.metrics.series.size(); ++k) {
        const std::vector<RunMetrics>* runs = rows.of(out.metrics.series[k]);
        if (!runs) continue;
        out.provenance.seeds.push_back(out.metrics.series[k]);
        out.provenance.places.push_back(static_cast<int>(k) + 1);
        for (RunMetrics run : *runs) {
            if (out.provenance.seeds.size() == 1) rows.give_tails(run);
            out.metrics.runs.push_back(std::move(run));
        }
    }
    if (out.provenance.seeds.empty())
        throw InputError({parts.front().name, 0, 0}, "cannot be joined: none of its runs is of a seed of its series");
    out.experiment.seed = out.provenance.seeds.front();
    out.experiment.seeds = static_cast<int>(out.provenance.seeds.size());
    const auto begins = std::ranges::find_if(
        parts, [&](const Part& part) { return part.file.provenance.seeds.front() == out.experiment.seed; });
    if (begins == parts.end())
        throw InputError({parts.front().name, 0, 0},
            fmt::format("cannot be joined: no part begins with the seed {}, the first of all", out.experiment.seed));
    const Metrics& of_first = begins->file.metrics;
    out.metrics.film_hashes = of_first.film_hashes;
    out.metrics.references = of_first.references;
    out.metrics.furnaces = of_first.furnaces;
    out.metrics.has_studies =
        std::ranges::any_of(parts, [](const Part& part) { return part.file.metrics.has_studies; });
    out.metrics.shape_pixels = of_first.shape_pixels;
    out.metrics.geometry_pixels = of_first.geometry_pixels;
    out.evidence = begins->file.evidence;
    add_spreads(out);
    std::ranges::move(backend_claims(parts), std::back_inserter(out.metrics.assertions));
    return out;
}

}  // namespace

Measured join(const std::vector<std::string>& paths, const std::string& command) {
    std::vector<Part> parts;
    Rows rows;
    for (const std::string& path : paths) {
        parts.push_back(read_part(path));
        check_alike(parts.front(), parts.back());
        rows.add(parts.back());
    }
    return join_parts(parts, rows, command);
}

Measured join_texts(const std::vector<std::string>& texts, const std::string& command) {
    std::vector<Part> parts;
    Rows rows;
    for (const std::string& text : texts) {
        parts.push_back(part_of(text, fmt::format("part {}", parts.size() + 1)));
        check_alike(parts.front(), parts.back());
        rows.add(parts.back());
    }
    return join_parts(parts, rows, command);
}

void write_metrics(const Measured& m, const std::string& folder, ProgressMonitor& monitor) {
    const ReportInputs in{m.experiment, m.metrics, m.evidence, m.provenance, m.plates};
    Staging staging(folder);
    staging.write("metrics.json", metrics_json(in));
    staging.write("metrics.csv", metrics_csv(in));
    staging.write("junit.xml", junit_xml(in));
    staging.commit(monitor);
}

}  // namespace crescent
