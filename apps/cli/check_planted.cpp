// `crescent check --planted`: the check itself, on samplers whose faults are known.
#include <algorithm>
#include <cstdio>

#include "check.h"
#include "tests/known_samplers/faulty/planted.h"

namespace crescent::cli {

namespace {

/// Returns the result of a planted fault for the files: one verdict per fault, right if it is detected.
Verdict caught_or_not(const PlantedFault& fault, const std::string& caught) {
    Verdict v;
    v.arm = fault.breaks;
    v.check_case = fault.name;
    v.name = "caught";
    v.state = caught.empty() ? State::wrong : State::right;
    v.expected = !caught.empty();
    v.sentences = {{"caught", caught.empty() ? "No verdict detects this planted fault." : "Caught by " + caught + "."}};
    return v;
}

std::string catchers(const CheckResult& j) {
    std::string caught;
    for (std::string_view name : verdict_names)
        for (const Verdict& v : j.verdicts)
            if (v.name == name && v.state == State::wrong) {
                caught += (caught.empty() ? "" : ", ") + v.name;
                break;
            }
    return caught;
}

}  // namespace

int check_planted(const CheckFlags& flags, Progress& monitor) {
    CheckResult j;
    j.alpha = flags.alpha;
    std::string text;
    for (const PlantedFault& fault : planted_faults(flags.full)) {
        const std::string caught = catchers(run_checks(fault.check_cases, test_settings_of(flags), monitor));
        j.verdicts.push_back(caught_or_not(fault, caught));
        j.as_expected = j.as_expected && !caught.empty();
        char line[256];
        std::snprintf(line, sizeof line, "%-66s %-12s %s\n", fault.name.c_str(), fault.breaks.c_str(),
            caught.empty() ? "NOT CAUGHT" : caught.c_str());
        text += line;
    }
    j.state = j.as_expected ? State::right : State::wrong;
    monitor.clear();
    print(text);
    write_files(flags, j);
    return exit_of(j.state);
}

}  // namespace crescent::cli
