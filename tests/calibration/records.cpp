// Field names are short because files have thousands of lines.
#include "tests/calibration/records.h"

#include <cmath>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <sstream>
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
    r["set"] = key.set;
    r["seed"] = key.seed;
    r["index"] = key.index;
    r["wo"] = key.wo;
    r["engine"] = run.engine;
    r["mode"] = run.full ? "full" : "quick";
    r["by"] = run.pipe ? "pipe" : "process";
    r["family"] = c.family;
    r["parameters"] = c.parameters;
    r["real"] = c.real == Real::f32 ? "f32" : "f64";
    r["held_out"] = c.held_out;
    r["kind"] = c.kind;
    r["size"] = c.size;
    r["expected"] = word(c.expected);
    r["state"] = word(result.state);
    r["wrong"] = result.wrong;
    r["open"] = result.open;
    r["cause"] = c.cause;
    r["causes"] = result.causes;
    r["stated"] = result.stated;
    r["p"] = result.p;
    r["cpu"] = std::round(result.cpu_seconds * 1e4) / 1e4;
    r["evaluations"] = result.evaluations;
    r["directions"] = result.wo;
    r["message"] = result.message.substr(0, 300);
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

Causes causes_of(const Json& r) {
    if (r.contains("given")) return {r["given"].get<int>(), r["named"].get<bool>(), r["others"].get<bool>()};
    const auto cause = r.at("cause").get<std::string>();
    const auto all = r.at("causes").get<std::vector<std::string>>();
    Causes out{static_cast<int>(all.size()), names_cause(cause, all), false};
    for (const std::string& one : all) out.others = out.others || (out.named && !names_cause(cause, {one}));
    if (!cause.empty()) return out;
    // If no cause must be named, a named cause must be true.
    const auto kind = r.at("kind").get<std::string>(), family = r.at("family").get<std::string>();
    const auto is_true = [&](const std::string& one) { return is_true_of(kind, family, one); };
    out.named = std::ranges::any_of(all, is_true);
    out.others = !std::ranges::all_of(all, is_true);
    return out;
}

namespace {

/// Columns of the CSV: texts, words of a list, numbers, flags.
struct Column {
    const char* name;
    enum Kind { text, list, number, flag } kind;
};
constexpr Column columns[] = {{"set", Column::text}, {"seed", Column::number}, {"index", Column::number},
    {"wo", Column::number}, {"engine", Column::text}, {"mode", Column::text}, {"by", Column::text},
    {"family", Column::text}, {"real", Column::text}, {"kind", Column::text}, {"size", Column::number},
    {"expected", Column::text}, {"state", Column::text}, {"wrong", Column::list}, {"open", Column::list},
    {"cause", Column::text}, {"given", Column::number}, {"named", Column::flag}, {"others", Column::flag},
    {"stated_size", Column::number}, {"cpu", Column::number}, {"evaluations", Column::number},
    {"directions", Column::number}};

std::string cell_of(const Column& c, const Json& r) {
    if (!r.contains(c.name)) return "";
    const Json& v = r[c.name];
    if (c.kind == Column::list) return fmt::format("{}", fmt::join(v.get<std::vector<std::string>>(), " "));
    if (c.kind == Column::flag) return v.get<bool>() ? "1" : "0";
    if (c.kind == Column::number)
        return v.is_null() ? "none" : v.is_number_float() ? fmt::format("{:.4g}", v.get<double>()) : v.dump();
    std::string s = v.get<std::string>();
    std::ranges::replace(s, '"', '\'');
    return s.find(',') == s.npos ? s : '"' + s + '"';
}

/// The cells of a line; a quoted cell may contain commas.
std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> out(1);
    bool quoted = false;
    for (const char c : line)
        if (c == '"') quoted = !quoted;
        else if (c == ',' && !quoted) out.emplace_back();
        else out.back() += c;
    return out;
}

Json value_of(const Column& c, const std::string& cell) {
    if (c.kind == Column::text) return cell;
    if (c.kind == Column::flag) return cell == "1";
    if (c.kind == Column::number) return cell == "none" ? Json() : Json::parse(cell);
    std::vector<std::string> words;
    std::istringstream in(cell);
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

}  // namespace

std::string csv_of(const std::vector<Json>& records) {
    std::string out;
    for (const Column& c : columns) out += fmt::format("{}{}", out.empty() ? "" : ",", c.name);
    for (Json r : records) {
        const Causes causes = causes_of(r);
        r["given"] = causes.given;
        r["named"] = causes.named;
        r["others"] = causes.others;
        out += "\n";
        for (const Column& c : columns) out += (&c == columns ? "" : ",") + cell_of(c, r);
    }
    return out + "\n";
}

std::vector<Json> read_csv(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    std::vector<Json> out;
    for (unsigned number = 1; std::getline(file, line); ++number) {
        if (number == 1) continue;
        const std::vector<std::string> cells = cells_of(line);
        if (cells.size() != std::size(columns))
            throw InputError({path, number, 1}, fmt::format("{} cells, expected {}", cells.size(), std::size(columns)));
        Json r;
        for (std::size_t k = 0; k < cells.size(); ++k)
            if (!cells[k].empty() || columns[k].kind == Column::text || columns[k].kind == Column::list)
                r[columns[k].name] = value_of(columns[k], cells[k]);
        r["parameters"] = "";
        r["p"] = Json::object();
        out.push_back(std::move(r));
    }
    return out;
}

}  // namespace crescent::calibration
