// Names of fields are short: files have thousands of lines.
#include "tests/calibration/records.h"

#include <cmath>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <unistd.h>

#include "base/errors.h"

namespace crescent::calibration {

using Json = nlohmann::ordered_json;

std::string identity_of(const CaseKey& key, const RunOf& run) {
    return fmt::format("{} {} {} wo={} {} {} {}", key.set, key.seed, key.index, key.wo, run.engine,
        run.full ? "full" : "quick", run.pipe ? "pipe" : "process");
}
std::string identity_of(const Json& r) {
    return fmt::format("{} {} {} wo={} {} {} {}", r.at("set").get<std::string>(), r.at("seed").get<std::uint64_t>(),
        r.at("index").get<std::uint64_t>(), r.at("wo").get<int>(), r.at("engine").get<std::string>(),
        r.at("mode").get<std::string>(), r.at("by").get<std::string>());
}

Json record_of(const CaseKey& key, const RunOf& run, const Case& c, const Result& result) {
    Json r;
    r["set"] = key.set, r["seed"] = key.seed, r["index"] = key.index, r["wo"] = key.wo;
    r["engine"] = run.engine, r["mode"] = run.full ? "full" : "quick", r["by"] = run.pipe ? "pipe" : "process";
    r["family"] = c.family, r["parameters"] = c.parameters, r["real"] = c.real == Real::f32 ? "f32" : "f64";
    r["held_out"] = c.held_out, r["kind"] = c.kind, r["size"] = c.size;
    r["expected"] = word(c.expected), r["state"] = word(result.state);
    r["wrong"] = result.wrong, r["open"] = result.open;
    r["cause"] = c.cause, r["causes"] = result.causes;
    r["stated"] = result.stated, r["p"] = result.p;
    r["cpu"] = std::round(result.cpu_seconds * 1e4) / 1e4, r["evaluations"] = result.evaluations;
    r["directions"] = result.wo, r["say"] = result.say.substr(0, 300);
    return r;
}

std::vector<Json> read_records(const std::string& path, bool repair) {
    std::vector<Json> out;
    std::ifstream file(path, std::ios::binary);
    if (!file) return out;
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    std::size_t from = 0;
    for (unsigned line = 1; from < text.size(); ++line) {
        const std::size_t end = text.find('\n', from);
        const Json one = Json::parse(text.substr(from, end == text.npos ? end : end - from), nullptr, false);
        if (end == text.npos) break;
        if (one.is_discarded()) throw InputError({path, line, 1}, "this line is not JSON");
        out.push_back(one);
        from = end + 1;
    }
    if (repair && from < text.size()) std::filesystem::resize_file(path, from);
    return out;
}

void append_record(const std::string& path, const Json& record) {
    const std::string line = record.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    const int file = open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    const bool done = file >= 0 && write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    if (file >= 0) close(file);
    if (!done) throw std::runtime_error("cannot write to " + path);
}

std::string csv_of(const std::vector<Json>& records) {
    std::string out =
        "set,seed,index,wo,engine,mode,by,family,real,kind,size,expected,state,wrong,open,named,cpu,"
        "evaluations,directions\n";
    const auto joined = [](const Json& list) {
        return fmt::format("{}", fmt::join(list.get<std::vector<std::string>>(), " "));
    };
    const auto quoted = [](const Json& text) {
        std::string s = text.get<std::string>();
        std::ranges::replace(s, '"', '\'');
        return s.find(',') == s.npos ? s : '"' + s + '"';
    };
    for (const Json& r : records)
        out +=
            fmt::format("{},{},{},{},{},{},{},{},{},{},{:g},{},{},{},{},{},{:.3f},{},{}\n", r["set"].get<std::string>(),
                r["seed"].get<std::uint64_t>(), r["index"].get<std::uint64_t>(), r["wo"].get<int>(),
                r["engine"].get<std::string>(), r["mode"].get<std::string>(), r["by"].get<std::string>(),
                quoted(r["family"]), r["real"].get<std::string>(), quoted(r["kind"]), r["size"].get<double>(),
                r["expected"].get<std::string>(), r["state"].get<std::string>(), joined(r["wrong"]), joined(r["open"]),
                names_cause(r["cause"].get<std::string>(), r["causes"].get<std::vector<std::string>>()) ? 1 : 0,
                r["cpu"].get<double>(), r["evaluations"].get<std::uint64_t>(), r["directions"].get<int>());
    return out;
}

}  // namespace crescent::calibration
