// crescent report: the page of a result that was stored as JSON.
#include <filesystem>
#include <fmt/format.h>
#include <vector>

#include "base/errors.h"
#include "base/files.h"
#include "base/input.h"
#include "base/text.h"
#include "check/report/print.h"
#include "commands.h"
#include "output/format.h"
#include "report/report.h"
#include "run/stored_run.h"
#include "run/write.h"
#include "progress.h"
#include "terminal.h"

namespace crescent::cli {

namespace {

std::string format_of(const std::string& text, const std::string& file) {
    try {
        return parse_json(text).at("format").get<std::string>();
    } catch (const Json::exception& error) {
        throw InputError({file, 0, 0},
            fmt::format("expected the metrics.json of a run or what check --json writes: {}", error.what()));
    }
}

std::string page_of_run(const std::string& text, const std::string& file) {
    const StoredRun run = open_run(text, file);
    Progress monitor(Progress::fitting());
    for (const std::string& plate : run.missing)
        monitor.log(fmt::format("{}: missing, so the page is without it", plate));
    return report_html(report_inputs(run.measured));
}

std::string page_of_check(const std::string& text, const std::string& file) {
    const StoredResult stored = read_verdict_json(text, file);
    return verdict_html(stored.result, stored.source);
}

}  // namespace

int report(const ReportFlags& flags) {
    const std::string text =
        read_input(flags.file, most_bytes_of_metrics, "the metrics.json of a run or what check --json writes,");
    const std::string format = format_of(text, flags.file);
    const bool is_run = format.starts_with("crescent metrics ");
    if (!is_run && !format.starts_with("crescent check "))
        throw InputError({flags.file, 0, 0},
            fmt::format("expected the metrics.json of a run or what check --json writes, not the format '{}'", format));
    const std::filesystem::path beside = flags.file;
    std::string out = flags.out;
    if (out.empty())
        out = (is_run ? beside.parent_path() / "report.html" : std::filesystem::path(beside).replace_extension(".html"))
                  .string();
    write_whole(out, is_run ? page_of_run(text, flags.file) : page_of_check(text, flags.file));
    print(out + "\n");
    return passed;
}

}  // namespace crescent::cli
