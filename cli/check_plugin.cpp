// `crescent check --plugin`: judged by a child process, so that a library that ends its process is an error of the
// sampler, told and written as any other.
#include "check.h"
#include "supervised.h"

namespace crescent::cli {

std::optional<int> judged_by_child(const CheckFlags& flags) {
    if (flags.plugin.empty()) return {};
    const std::optional<ChildEnd> end = done_by_child({{flags.plugin, ""}}, flags.quiet);
    if (!end) return {};
    if (end->fault.empty()) return end->code;
    Judgement j = complaint(SubjectFault(end->fault), flags, flags.plugin);
    for (Verdict& v : j.verdicts) {
        v.trial = "the whole call";
        v.say = v.name == verdict_names[0] ? "The sampler broke off: " + end->fault + "."
                                           : "It could not be decided: the sampler broke off.";
    }
    print(verdict_table(j));
    write_files(flags, j);
    return exit_of(j.state);
}

}  // namespace crescent::cli
