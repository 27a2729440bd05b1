// junit.xml: one test case an assertion, for build servers. No times and no dates: equal runs give equal bytes.
#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"
#include "report/numbers.h"
#include "report/report.h"

namespace crescent {
namespace {

std::string failure(const AssertionResult& a) {
    const std::string message = fmt::format("measured {}, must be {} {}{}", shortest(a.measured), a.op,
        shortest(a.bound), a.reference_good ? "" : "; the reference is not good enough");
    return fmt::format("      <failure type=\"assertion\" message=\"{}\">{}</failure>\n", escape(message),
        escape(a.text + ": " + message));
}

std::string test_case(const AssertionResult& a, const std::string& group) {
    const std::string head = fmt::format("    <testcase classname=\"{}\" name=\"{}\"", escape(group), escape(a.name));
    if (!a.skipped.empty()) return fmt::format("{}><skipped message=\"{}\" /></testcase>\n", head, escape(a.skipped));
    if (a.pass) return head + " />\n";
    return head + ">\n" + failure(a) + "    </testcase>\n";
}

std::string property(const char* name, const std::string& value) {
    return fmt::format("      <property name=\"{}\" value=\"{}\" />\n", name, escape(value));
}

}  // namespace

std::string junit_xml(const ReportInputs& in) {
    const auto& all = in.metrics.assertions;
    const auto failed = std::count_if(all.begin(), all.end(), [](const AssertionResult& a) { return a.failed(); });
    const auto skipped =
        std::count_if(all.begin(), all.end(), [](const AssertionResult& a) { return !a.skipped.empty(); });
    const std::string counts = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\"", all.size(), failed);
    const Provenance& p = in.provenance;
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    out += fmt::format("<testsuites name=\"crescent\" {}>\n", counts);
    out += fmt::format("  <testsuite name=\"{}\" {} skipped=\"{}\">\n", escape(in.experiment.title), counts, skipped);
    out += "    <properties>\n" + property("version", p.version) + property("commit", p.commit) +
        property("experiment", p.experiment_file) + property("hash", p.experiment_hash) +
        property("command", p.command) + "    </properties>\n";
    for (const AssertionResult& a : all) out += test_case(a, p.experiment_file);
    return out + "  </testsuite>\n</testsuites>\n";
}

}  // namespace crescent
