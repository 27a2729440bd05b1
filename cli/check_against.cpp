// `crescent check A --against B`, and what is said of a program that never came to be judged.
#include <algorithm>

#include "check.h"

namespace crescent::cli {

Judgement complaint(const SubjectFault& fault, const CheckFlags& flags, const std::string& command) {
    Judgement j;
    j.alpha = flags.alpha;
    j.state = dynamic_cast<const SubjectTooSlow*>(&fault) ? State::inconclusive : State::error;
    for (std::string_view name : verdict_names) {
        Verdict v;
        v.arm = printable(command, 60);
        v.trial = before_any_trial;
        v.name = name;
        v.state = j.state;
        v.say = name == verdict_names[0] ? "The sampler never came to be judged: " + std::string(fault.what()) + "."
                                         : "It could not be asked: the sampler never came to be judged.";
        v.expected = false;
        j.verdicts.push_back(v);
    }
    j.as_expected = false;
    return j;
}

namespace {

/// B on the trials of A: a built-in arm by its name, or a program.
std::vector<Trial> others_of(const CheckFlags& flags, std::span<const Trial> a, const ProgressMonitor& monitor) {
    const std::vector<std::string> names = sampler_names();
    if (std::find(names.begin(), names.end(), flags.against) != names.end()) return arm_against(flags.against, a);
    const std::string near = did_you_mean(flags.against, names);
    if (!near.empty() && flags.against.find_first_of(" /") == std::string::npos)  // a word, no command
        throw InputError({"--against " + flags.against, 0, 0}, "no built-in arm" + near);
    for (const char* end : {".csv", ".npy"})
        if (flags.against.ends_with(end) && flags.against.find(' ') == std::string::npos)
            throw InputError({"--against " + flags.against, 0, 0},
                "is a file of samples, which has no p and f elsewhere: give it as --samples FILE, and --against an arm "
                "or a program");
    try {
        return sampler_against(start_pipe(flags.against, limits_of(flags, monitor)), a);
    } catch (const InputError&) {  // start_pipe calls it --exec
        throw InputError({"--against " + flags.against, 0, 0}, "neither a built-in arm nor a command of the shell");
    }
}

}  // namespace

int check_against(
    const CheckFlags& flags, std::vector<Trial> a, std::span<const Waiver> waivers, bool same, Progress& monitor) {
    std::erase_if(a, [](const Trial& t) { return t.baseline; });
    std::vector<Trial> b;
    try {
        b = others_of(flags, a, monitor);
    } catch (const SubjectFault& fault) {  // B's own: A has answered
        const Judgement j = complaint(fault, flags, flags.against);
        monitor.clear();
        print(verdict_table(j));
        write_files(flags, j);
        return exit_of(j.state, flags);
    }
    Judgement j = judge_against(a, b, test_settings_of(flags), same, monitor);
    if (!waivers.empty()) waive(j, waivers);
    monitor.clear();
    print(against_text(j));
    write_files(flags, j);
    return exit_of(j.state, flags);
}

}  // namespace crescent::cli
