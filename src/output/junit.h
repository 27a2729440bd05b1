// A result as junit.xml, for build servers: one suite.
#pragma once

#include <string>

#include "output/test_report.h"

namespace crescent {

/// Returns the file. Any text is allowed in the report: it is escaped here. Equal reports give equal bytes.
std::string junit_text(const TestReport& report);

}  // namespace crescent
