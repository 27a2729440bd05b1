// What is not right in the Static Analysis Results Interchange Format 2.1.0, which code hosts show at lines of files.
#pragma once

#include <string>

#include "output/test_report.h"

namespace crescent {

/// Returns the file: the annotations of the report. Equal reports give equal bytes.
std::string sarif_text(const TestReport& report);

}  // namespace crescent
