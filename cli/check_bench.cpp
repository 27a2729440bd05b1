// `crescent check --planted`, `--right` and `--error-rates`: the bench itself, measured.
#include <algorithm>
#include <cstdio>

#include "check.h"
#include "laws/planted/planted.h"
#include "laws/right/law.h"

namespace crescent::cli {

namespace {

/// What the faults came to, for the files: one verdict a fault, right where it is caught.
Verdict caught_or_not(const PlantedFault& fault, const std::string& caught) {
    Verdict v;
    v.arm = fault.breaks;
    v.trial = fault.name;
    v.name = "caught";
    v.state = caught.empty() ? State::wrong : State::right;
    v.expected = !caught.empty();
    v.say = caught.empty() ? "No verdict is wrong where this fault is planted." : "Caught by " + caught + ".";
    return v;
}

std::string catchers(const Judgement& j) {
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
    Judgement j;
    j.alpha = flags.alpha;
    std::string text;
    for (const PlantedFault& fault : planted_faults(flags.full)) {
        const std::string caught = catchers(judge(fault.trials, test_settings_of(flags), monitor));
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

namespace {

bool keeps_promise(const RightLaw& law) { return rate_interval(law.accused, law.judged).first <= law.alpha; }

/// Right samplers at random parameters in quick and in full mode, where --right asks for them; kept: no more of them
/// are accused than was promised.
std::string right_tables(const CheckFlags& flags, ProgressMonitor& monitor, bool& kept) {
    if (flags.right == 0) return {};
    std::string out =
        "Samplers of many families, the parameters and w_o of each drawn at random, each judged by a call of its "
        "own.\n";
    for (TestSettings settings : {TestSettings::quick(), TestSettings::thorough()}) {
        settings.alpha = flags.alpha;
        settings.seed = flags.seed;
        const RightLaw law = measure_right(flags.first, flags.right, settings, monitor);
        for (const std::string& text : law.said) monitor.log(text);
        out += (law.full ? "\n### Full mode\n\n" : "\n### Quick mode\n\n") + right_law_text(law);
        kept = kept && keeps_promise(law);
    }
    return out;
}

/// The command that makes docs/error-rates.md.
std::string command_of_rates(const CheckFlags& f) {
    std::string out = "crescent check --error-rates " + std::to_string(f.error_rates);
    if (f.right > 0) out += " --right " + std::to_string(f.right);
    if (f.first > 0) out += " --first " + std::to_string(f.first);
    if (f.alpha != 1e-3) out += " --alpha " + shortest(f.alpha);
    return out + " --seed " + std::to_string(f.seed);
}

}  // namespace

int check_error_rates(const CheckFlags& flags, ProgressMonitor& monitor) {
    TestSettings settings = test_settings_of(flags);
    settings.draws = 4096;  // the levels do not depend on it; many seeds matter more than many draws
    const FalseAlarms alarms = measure_false_alarms(flags.error_rates, settings, monitor);
    bool kept = rate_interval(alarms.calls, alarms.seeds).first <= alarms.alpha;
    const std::string law = right_tables(flags, monitor, kept);
    std::vector<Caught> table;
    std::vector<Explained> causes;
    const std::vector<PlantedFault> quick = planted_faults(false), full = planted_faults(true);
    for (std::size_t i = 0; i < quick.size(); ++i) {
        const Judgement seen = judge(quick[i].trials, TestSettings::quick(), monitor);
        causes.push_back(explained(quick[i], seen));
        table.push_back({quick[i].name, quick[i].breaks, catchers(seen),
            catchers(judge(full[i].trials, TestSettings::thorough(), monitor))});
        kept = kept && !table.back().full.empty();
    }
    print(error_rates_text(alarms, law, table, command_of_rates(flags),
        "crescent " + crescent::version() + ", commit " + crescent::commit()));
    std::string told;
    const std::size_t right = std::max<std::size_t>(flags.right, 100);
    const std::size_t found = count_false_diagnoses(flags.first, right, flags.seed, told);
    if (!told.empty()) monitor.log(told);
    print(explained_text(causes, found, right));
    return kept && found == 0 ? held : failed;
}

int check_right(const CheckFlags& flags, ProgressMonitor& monitor) {
    const RightLaw law = measure_right(flags.first, flags.right, test_settings_of(flags), monitor);
    std::string text;
    for (const std::string& line : law.said) text += line;
    print(text + right_law_text(law));
    return keeps_promise(law) ? held : failed;
}

}  // namespace crescent::cli
