// The list of formats, in the order of the help.
#include "output/report_formats.h"

#include "output/junit.h"
#include "output/sarif.h"

namespace crescent {

std::span<const ReportFormat> report_formats() {
    static constexpr ReportFormat formats[] = {
        {"junit", "write a case for each verdict, assertion or view, for a build server", junit_text},
        {"sarif", "write what fails, for the annotations of a code host", sarif_text},
    };
    return formats;
}

std::vector<OutputFile> with_reports(std::vector<OutputFile> outputs, const ReportFiles& files) {
    for (const auto& [name, file] : files) outputs.push_back({"--" + name, file});
    return outputs;
}

void write_reports(const ReportFiles& files, const TestReport& report) {
    for (const ReportFormat& format : report_formats())
        if (const auto file = files.find(format.name); file != files.end() && !file->second.empty())
            write_whole(file->second, format.text(report));
}

}  // namespace crescent
