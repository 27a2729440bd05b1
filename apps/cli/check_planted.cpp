// `crescent check --planted`: the check itself, on samplers whose faults are known.
#include <algorithm>
#include <cstdio>

#include "check.h"
#include "tests/known_samplers/faulty/planted.h"

namespace crescent::cli {

namespace {

/// Returns the result of a planted fault for the files: one verdict per fault, right if it is detected.
Verdict caught_or_not(const PlantedFault& fault, const std::string& detectors) {
    Verdict v;
    v.arm = fault.breaks;
    v.check_case = fault.name;
    v.name = "caught";
    v.state = detectors.empty() ? State::wrong : State::right;
    v.expected = !detectors.empty();
    v.sentences = {
        {"caught", detectors.empty() ? "No verdict detects this planted fault." : "Caught by " + detectors + "."}};
    return v;
}

std::string catchers(const CheckResult& result) {
    std::string detectors;
    for (std::string_view name : verdict_names)
        for (const Verdict& v : result.verdicts)
            if (v.name == name && v.state == State::wrong) {
                detectors += (detectors.empty() ? "" : ", ") + v.name;
                break;
            }
    return detectors;
}

}  // namespace

int check_planted(const CheckFlags& flags, Progress& monitor) {
    CheckResult result;
    result.alpha = flags.alpha;
    std::string text;
    for (const PlantedFault& fault : planted_faults(flags.full)) {
        const std::string detectors = catchers(run_checks(fault.check_cases, test_settings_of(flags), monitor));
        result.verdicts.push_back(caught_or_not(fault, detectors));
        result.as_expected = result.as_expected && !detectors.empty();
        char line[256];
        std::snprintf(line, sizeof line, "%-66s %-12s %s\n", fault.name.c_str(), fault.breaks.c_str(),
            detectors.empty() ? "NOT CAUGHT" : detectors.c_str());
        text += line;
    }
    result.state = result.as_expected ? State::right : State::wrong;
    monitor.clear();
    print(text);
    write_files(flags, result);
    return exit_of(result.state);
}

}  // namespace crescent::cli
