// crescent run: makes films, metrics, plates and a report from an experiment file.
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>

#include "commands.h"
#include "crescent/crescent.h"
#include "backends.h"
#include "progress.h"
#include "signals.h"
#include "terminal.h"

namespace crescent::cli {

namespace {

/// Returns the command that regenerates the outputs. Output folder, threads and instruction set do not change them and
/// are omitted, so that equal runs state equal commands.
std::string command_of(const RunFlags& flags) {
    std::string command = "crescent run " + shell_word(flags.file);
    for (const std::string& text : flags.overrides) command += " --set " + shell_word(text);
    if (flags.seeds > 0) command += " --seeds " + std::to_string(flags.seeds);
    if (!flags.seed_range.empty()) command += " --seed-range " + flags.seed_range;
    if (flags.no_references) command += " --no-references";
    if (flags.no_studies) command += " --no-studies";
    if (flags.backend != "cpu") command += " --instrument " + flags.backend;
    if (!flags.gl_context.empty()) command += " --gl-context " + flags.gl_context;
    if (flags.gl_device >= 0) command += " --gl-device " + std::to_string(flags.gl_device);
    return command;
}

/// Writes the preview and prints its path.
int show_preview(const Experiment& experiment, const RunOptions& options, Progress& progress) {
    const std::vector<unsigned char> png = preview(experiment, {options.threads, options.isa, nullptr}, progress);
    Staging staging(options.out, "preview");
    staging.write("preview.png", png);
    staging.commit(progress);
    progress.clear();
    print(fmt::format(
        "{}/preview.png: the reference, its regions and the crops of plates on rulers of pixels\n", options.out));
    return passed;
}

}  // namespace

std::string experiment_file(const std::string& word) {
    std::error_code ignored;
    const bool is_name = word.find_first_of("/.") == std::string::npos && !std::filesystem::exists(word, ignored);
    const std::string installed_file = is_name ? shared_file("experiments/" + word + ".toml") : "";
    return installed_file.empty() ? word : installed_file;
}

int run(const RunFlags& flags) {
    std::vector<std::string> overrides = flags.overrides;
    if (flags.seeds > 0) overrides.push_back("seeds=" + std::to_string(flags.seeds));
    RunOptions options;
    if (flags.no_references) options.parts = {.metrics = true, .films = true, .plates = false, .report = false};
    if (!flags.only.empty()) options.parts = output_parts(flags.only);
    options.references = !flags.no_references;
    options.studies = !flags.no_studies;
    if (!flags.seed_range.empty())
        std::sscanf(flags.seed_range.c_str(), "%d:%d", &options.seeds.first, &options.seeds.last);
    const Experiment experiment = load(experiment_file(flags.file), overrides);
    if (flags.no_code) refuse_code(experiment);

    options.out = flags.out.empty() ? "out/" + std::filesystem::path(flags.file).stem().string() : flags.out;
    options.threads = flags.threads;
    options.isa = flags.isa;
    options.keep_after_s = flags.keep_after;
    options.timeout_s = flags.timeout;
    options.command = command_of(flags);
    options.backend = backend(flags);
    options.columns = columns_of_summary();

    Progress progress(flags.quiet ? Progress::Style::silent : Progress::fitting());
    const StopOnSignal stop(progress);
    if (flags.preview) return show_preview(experiment, options, progress);
    const RunResult result = crescent::run(experiment, options, progress);
    progress.clear();
    print(result.summary);
    return result.metrics.all_hold() ? passed : failed;
}

// ---- Looks the word up among the registered kinds of back end and opens the one it finds with the two --gl flags,
// which the CPU rejects.

namespace {

void only_with_gl(const char* flag, bool is_given) {
    if (is_given) throw InputError({flag, 0, 0}, "expected together with --instrument gl");
}

}  // namespace

std::shared_ptr<Backend> backend(const RunFlags& flags) {
    if (flags.backend == "cpu") {
        only_with_gl("--gl-context", !flags.gl_context.empty());
        only_with_gl("--gl-device", flags.gl_device >= 0);
        return nullptr;
    }
    const std::shared_ptr<const BackendKind> kind = find_backend(flags.backend);
    if (!kind) throw not_built("--instrument " + flags.backend);
    return kind->open({flags.gl_context, flags.gl_device});
}

// ---- crescent join: computes the metrics of the run of all seeds from parts of one experiment.

int join(const JoinFlags& flags) {
    std::string command = "crescent join";
    for (const std::string& part : flags.parts) command += " " + shell_word(part);
    for (const std::string& part : flags.parts) {
        std::error_code ignored;
        std::filesystem::path folder = part;
        if (!std::filesystem::is_directory(folder, ignored)) folder = folder.parent_path() / ".";
        if (std::filesystem::equivalent(folder, flags.out, ignored))
            throw InputError({fmt::format("--out {}", flags.out), 0, 0},
                fmt::format("expected another folder than that of the part {}", part));
    }
    const Measured joined_run = crescent::join(flags.parts, command);
    ProgressMonitor monitor;
    write_metrics(joined_run, flags.out, monitor);
    print(terminal_summary(report_inputs(joined_run), {}, flags.out,
        {.metrics = true, .films = false, .plates = false, .report = false}, false, columns_of_summary()));
    return joined_run.metrics.all_hold() ? passed : failed;
}

}  // namespace crescent::cli
