// crescent film: makes an explainer video of an experiment's measurements.
#include "commands.h"
#include "crescent/crescent.h"
#include "progress.h"
#include "signals.h"

namespace crescent::cli {

namespace {

std::string command_of(const FilmFlags& flags) {
    std::string command = "crescent film " + shell_word(flags.file);
    for (const std::string& text : flags.overrides) command += " --set " + shell_word(text);
    if (flags.seeds > 0) command += " --seeds " + std::to_string(flags.seeds);
    return command;
}

}  // namespace

int film(const FilmFlags& flags) {
    std::vector<std::string> overrides = flags.overrides;
    if (flags.seeds > 0) overrides.push_back("seeds=" + std::to_string(flags.seeds));
    const Experiment experiment = load(experiment_file(flags.file), overrides);
    if (flags.no_code) refuse_code(experiment);
    if (!film_maker()) throw not_built("crescent film");

    ExplainerOptions options = flags.options;
    options.height = std::stoi(flags.size);
    options.command = command_of(flags);

    Progress progress(flags.quiet ? Progress::Style::silent : Progress::fitting());
    const StopOnSignal stop(progress);
    const std::string summary = film_maker()(experiment, options, progress);
    progress.clear();
    print(summary);
    return passed;
}

}  // namespace crescent::cli
