// The formats in which `check` and `compare` write a report, beside their own JSON.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/whole_file.h"
#include "output/test_report.h"

namespace crescent {

/// A format of the reports of `check` and `compare`, written by `--NAME FILE`.
struct ReportFormat {
    const char *name, *purpose;
    std::string (*text)(const TestReport& report);
};
/// A new format is a function in a file of its own, and a row here.
std::span<const ReportFormat> report_formats();

/// The files to write, by the name of their format; "": none.
using ReportFiles = std::map<std::string, std::string>;
/// These outputs, and the files as those of `--NAME`.
std::vector<OutputFile> with_reports(std::vector<OutputFile> outputs, const ReportFiles& files);
/// Throws OutputError.
void write_reports(const ReportFiles& files, const TestReport& report);

}  // namespace crescent
