// junit.xml: one test case an assertion, for build servers. No times and no dates: equal runs give equal bytes.
#include "pages/junit.h"

#include <fmt/format.h>

#include "pages/numbers.h"
#include "report/report.h"

namespace crescent::inline report {
namespace {

JunitCase case_of(const AssertionResult& a, const std::string& group) {
    JunitCase out{group, a.name, JunitCase::State::passed, "", "", {}};
    if (!a.skipped.empty()) out.state = JunitCase::State::skipped, out.message = a.skipped;
    if (!a.failed()) return out;
    out.state = JunitCase::State::failed;
    out.message = fmt::format("measured {}, must be {} {}{}", shortest(a.measured), a.op, shortest(a.bound),
        a.reference_good ? "" : "; the reference is not good enough");
    out.text = a.text + ": " + out.message;
    return out;
}

}  // namespace

std::string junit_xml(const ReportInputs& in) {
    const Provenance& p = in.provenance;
    JunitSuite suite{in.experiment.title,
        {{"version", p.version}, {"commit", p.commit}, {"experiment", p.experiment_file}, {"hash", p.experiment_hash},
            {"command", p.command}},
        {}};
    for (const AssertionResult& a : in.metrics.assertions) suite.cases.push_back(case_of(a, p.experiment_file));
    return junit_text(suite);
}

}  // namespace crescent::inline report
