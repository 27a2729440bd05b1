// crescent_calibration SET ...: runs cases; crescent_calibration false-alarms: checks correct samplers at random
// parameters and counts false alarms by family; crescent_calibration table|csv FILE...: reports results; --serve:
// serves the sampler of a case over a pipe; --list: lists sets, families and engines.
#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <oneapi/tbb/global_control.h>
#include <unistd.h>

#include "base/errors.h"
#include "check/sources/check_case.h"
#include "check/sources/pipe.h"
#include "math/statistics.h"
#include "tests/calibration/records.h"
#include "tests/calibration/serve.h"
#include "tests/calibration/table.h"
#include "tests/known_samplers/study/false_alarms.h"

namespace {

using namespace crescent;
using namespace crescent::calibration;

struct Options {
    std::vector<std::string> words;
    std::string engine = "0.2", cases = "0:60", mode = "quick", out;
    std::uint64_t seed = 1, draws = 0, evaluations = 0;
    int wo = -1;
    bool pipe = false, serve = false, list = false;
};

std::uint64_t number(const std::string& text, const char* what) {
    std::uint64_t v = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (error != std::errc{} || end != text.data() + text.size())
        throw InputError({what, 0, 0}, "'" + text + "' is not a whole number");
    return v;
}

/// "A:B", "B" for 0:B, or "all" for a set with a finite number of cases.
std::pair<std::uint64_t, std::uint64_t> range_of(const std::string& text, const CaseSet& set) {
    const auto colon = text.find(':');
    std::uint64_t from = 0, to = set.count;
    if (text != "all") {
        if (colon != text.npos) from = number(text.substr(0, colon), "--cases");
        to = number(colon == text.npos ? text : text.substr(colon + 1), "--cases");
    } else if (set.count == 0) throw InputError({"--cases", 0, 0}, "set '" + set.name + "' has no end: give A:B");
    return {from, set.count ? std::min(to, set.count) : to};
}

/// This program as the sampler of a case.
std::vector<CheckCase> piped(const CaseKey& key, const Case& c) {
    const std::string self = std::filesystem::read_symlink("/proc/self/exe");
    const std::string command = fmt::format("exec '{}' --serve {} {} {} --wo {} --mode {}", self, key.set, key.seed,
        key.index, key.wo, key.full ? "full" : "quick");
    return make_user_cases(start_pipe(command), key.full, c.grid);
}

Result run_case(const Engine& engine, const CaseKey& key, const Case& c, const Request& request, bool pipe) {
    try {
        if (pipe && !c.sampler) throw std::invalid_argument("this case has no sampler that can be served");
        return measured(engine, [&] { return pipe ? piped(key, c) : c.check_cases; }, request);
    } catch (const SamplerError& fault) {
        Result broken;
        broken.state = State::error;
        broken.message = fault.what();
        return broken;
    }
}

/// Set `stated`: the right sampler first; then a fault of the size that its verdict states as possibly hidden.
nlohmann::ordered_json run_stated(
    const Engine& engine, const CaseKey& key, const RunOf& run, Request request, const StatedCase& of) {
    Case c = stated_right(of, key);
    const std::string kind = c.kind;
    Result first = run_case(engine, key, c, request, false);
    const auto size = first.stated.find(kind);
    if (first.state != State::right || size == first.stated.end() || !(size->second > 0)) {
        nlohmann::ordered_json r = record_of(key, run, c, first);
        r["stated_size"] = nullptr;
        return r;
    }
    request.seed ^= 0x5bd1e995u;
    const Case wrong = stated_faulty(of, key, size->second);
    nlohmann::ordered_json r = record_of(key, run, wrong, run_case(engine, key, wrong, request, false));
    r["stated_size"] = size->second;
    return r;
}

void run_set(const Options& o) {
    const CaseSet& set = case_set(o.words.at(0));
    const Engine& engine = engine_named(o.engine);
    const RunOf run{o.engine, o.mode == "full", o.pipe};
    const auto [from, to] = range_of(o.cases, set);
    std::set<std::string> done;
    if (!o.out.empty())
        for (const auto& r : read_records(o.out, true)) done.insert(identity_of(r));
    for (std::uint64_t index = from; index < to; ++index) {
        const CaseKey key{set.name, o.seed, index, o.wo < 0 ? set.wo : o.wo, run.full};
        if (done.contains(identity_of(key, run))) continue;
        Request request{run.full, 1, o.draws, o.evaluations};
        request.seed = static_cast<std::uint32_t>(hash_of({set.name, o.seed, index, "engine"}));
        const bool stated = set.name.starts_with("stated");
        nlohmann::ordered_json r;
        if (stated) r = run_stated(engine, key, run, request, stated_case(key));
        else {
            const Case c = set.make(key);
            r = record_of(key, run, c, run_case(engine, key, c, request, o.pipe));
        }
        if (!o.out.empty()) append_record(o.out, r);
        if (o.out.empty() || r["state"] != r["expected"])
            fmt::print("{} {} {} {} {:g} {}: {} ({}) {:.2f} s {}\n", set.name, index, r["family"].get<std::string>(),
                r["kind"].get<std::string>(), r["size"].get<double>(), r["real"].get<std::string>(),
                r["state"].get<std::string>(), r["wrong"].dump(), r["cpu"].get<double>(),
                r["message"].get<std::string>());
        std::fflush(stdout);
    }
}

/// Returns 0 if no more correct samplers are called wrong than alpha allows.
int count_false_alarms(const Options& o) {
    TestSettings settings = o.mode == "full" ? TestSettings::thorough() : TestSettings::quick();
    settings.seed = static_cast<std::uint32_t>(o.seed);
    const auto [from, to] = range_of(o.cases, CaseSet{});
    ProgressMonitor monitor;
    const FalseAlarmStudy study = measure_false_alarms(from, to - from, settings, monitor);
    for (const std::string& line : study.message) fmt::print("{}", line);
    fmt::print("{}", false_alarm_text(study));
    return rate_interval(study.false_alarms, study.checked).first <= study.alpha ? 0 : 1;
}

int serve_case(const Options& o) {
    if (o.words.size() != 3) throw InputError({"--serve", 0, 0}, "give SET SEED INDEX");
    const CaseSet& set = case_set(o.words[0]);
    const CaseKey key{
        set.name, number(o.words[1], "SEED"), number(o.words[2], "INDEX"), o.wo < 0 ? set.wo : o.wo, o.mode == "full"};
    const Case c = set.make(key);
    if (!c.sampler) throw InputError({"--serve", 0, 0}, "set '" + set.name + "' has no samplers that can be served");
    return serve(*c.sampler, stdin, stdout) ? 0 : 3;
}

void list() {
    fmt::print("Sets:\n");
    for (const CaseSet& s : case_sets())
        fmt::print("  {:16} {:5} {}\n", s.name, s.count ? std::to_string(s.count) : "-", s.what);
    fmt::print("Families (* held out):\n");
    for (const Family& f : families())
        fmt::print("  {}{}{}\n", f.name, f.held_out ? " *" : "", f.parameter.empty() ? "" : ": " + f.parameter);
    fmt::print("Engines:");
    for (const auto& e : engines()) fmt::print(" {}", e->name());
    fmt::print("\n");
}

int run(int argc, char** argv) {
    CLI::App app{"Measures engines of `crescent check` on samplers whose verdict is known."};
    Options o;
    app.add_option("what", o.words, "SET, or false-alarms, or table FILE..., or csv FILE... (JSON lines, or .csv)");
    app.add_option("--engine", o.engine, "which engine")->capture_default_str();
    app.add_option("--seed", o.seed, "of the cases")->capture_default_str();
    app.add_option("--cases", o.cases, "A:B, or all")->capture_default_str();
    app.add_option("--mode", o.mode, "quick or full")->check(CLI::IsMember({"quick", "full"}))->capture_default_str();
    app.add_option("--wo", o.wo, "random w_o for each case; 0: those of the mode; default: the set's");
    app.add_option("--draws", o.draws, "draws for each w_o; default: the mode's");
    app.add_option("--evaluations", o.evaluations, "evaluations for each w_o; default: the mode's");
    app.add_option("--out", o.out, "a file of JSON lines; an interrupted run continues");
    app.add_flag("--pipe", o.pipe, "each sampler behind a pipe");
    app.add_flag("--serve", o.serve, "serve the sampler of SET SEED INDEX over a pipe");
    app.add_flag("--list", o.list, "sets, families, engines");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) { return app.exit(e) == 0 ? 0 : 2; }
    // One thread, because CPU time is measured and two runs may be made at the same time.
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    if (o.serve) return serve_case(o);
    if (o.list) return list(), 0;
    if (o.words.empty())
        throw InputError(
            {"SET", 0, 0}, "give a set, or false-alarms, or table or csv and files; --list lists the sets");
    if (o.words[0] == "false-alarms") return count_false_alarms(o);
    if (o.words[0] != "table" && o.words[0] != "csv") return run_set(o), 0;
    std::vector<nlohmann::ordered_json> records;
    for (std::size_t k = 1; k < o.words.size(); ++k)
        for (auto& r : o.words[k].ends_with(".csv") ? read_csv(o.words[k]) : read_records(o.words[k], false))
            records.push_back(std::move(r));
    std::cout << (o.words[0] == "csv" ? csv_of(records) : table_of(records));
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const InputError& e) {
        fmt::print(stderr, "crescent_calibration: {}\n", e.what());
        return 2;
    } catch (const std::exception& e) {
        fmt::print(stderr, "crescent_calibration: {}\n", e.what());
        return 3;
    }
}
