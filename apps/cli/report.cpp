// crescent report: the page of a result that was stored as JSON.
#include <array>
#include <filesystem>
#include <fmt/format.h>

#include "commands.h"
#include "crescent/crescent.h"
#include "progress.h"
#include "terminal.h"

namespace crescent::cli {

namespace {

constexpr std::string_view what_is_read = "the metrics.json of a run or of a comparison, or what check --json writes";

std::string page_of_run(const Json& json, const std::string& file) {
    const StoredRun run = open_run(json, file);
    Progress monitor(Progress::fitting());
    for (const std::string& plate : run.missing)
        monitor.log(fmt::format("{}: missing, so the page is without it", plate));
    return report_html(report_inputs(run.measured));
}

std::string page_of_check(const Json& json, const std::string& file) {
    const StoredResult stored_result = result_from_json(json, file);
    return verdict_html(stored_result.result, stored_result.source);
}

std::string page_of_comparison(const Json& json, const std::string& file) {
    return compare_html(json, read_plates(std::filesystem::path(file).parent_path() / "plates"));
}

/// A stored result by the begin of its format, with the page that it is made into.
struct Kind {
    std::string_view format;
    std::string (*page)(const Json& json, const std::string& file);
    const char* name;  // of the page beside the file; null: the file's own
};
constexpr std::array stored_kinds = {Kind{"crescent metrics ", page_of_run, "report.html"},
    Kind{"crescent comparison ", page_of_comparison, "report.html"}, Kind{"crescent check ", page_of_check, nullptr}};

const Kind& kind_of(const Json& json, const std::string& file) {
    const auto format = StoredJson(json).at("format").get<std::string>();
    for (const Kind& kind : stored_kinds)
        if (format.starts_with(kind.format)) return kind;
    throw InputError({file, 0, 0}, fmt::format("expected {}, not the format '{}'", what_is_read, format));
}

}  // namespace

int report(const ReportFlags& flags) {
    const Json json = parse_json(
        read_input(flags.file, most_bytes_of_metrics, fmt::format("{},", what_is_read)), flags.file, what_is_read);
    try {
        const Kind& kind = kind_of(json, flags.file);
        std::filesystem::path out = flags.out;
        if (flags.out.empty()) {
            out = std::filesystem::path(flags.file).replace_extension(".html");
            if (kind.name) out.replace_filename(kind.name);
        }
        claim_outputs({{"--out", out.string()}}, {flags.file});
        write_whole(out.string(), kind.page(json, flags.file));
        print(out.string() + "\n");
    } catch (const StoredJsonError& error) {
        throw InputError({flags.file, 0, 0}, fmt::format("expected {}: {}", what_is_read, error.what()));
    } catch (const Json::exception& error) {
        throw InputError({flags.file, 0, 0}, fmt::format("expected {}: {}", what_is_read, unreadable_json(error)));
    }
    return passed;
}

}  // namespace crescent::cli
