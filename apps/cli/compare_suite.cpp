// crescent compare SUITE.toml: golden images of several views.
#include <ctime>
#include <fmt/format.h>

#include "commands.h"
#include "crescent/crescent.h"
#include "memory.h"
#include "progress.h"
#include "signals.h"

namespace crescent::cli {

namespace {

/// The path of a folder, which may be an address that begins with file://.
std::string folder_of(const char* flag, const std::string& text) {
    constexpr std::string_view scheme = "file://";
    if (text.starts_with("file:///")) return text.substr(scheme.size());
    if (text.find("://") == std::string::npos) return text;
    throw InputError({fmt::format("{} {}", flag, text), 0, 0},
        "expected a folder, found an address: mount it, and give the folder where it is mounted");
}

/// The keys of [suite] that the flags replace.
SuiteFlags suite_flags(const CompareFlags& f) {
    SuiteFlags out;
    out.baseline = folder_of("--baseline", f.baseline);
    out.candidate = folder_of("--candidate", f.candidate);
    out.baseline_only = f.plan || (f.accept && !f.views.empty()) || !f.render.empty();
    const auto add = [&](const char* key, const std::string& text, bool is_toml) {
        if (!text.empty()) out.keys.push_back({{"suite", key}, text, is_toml, fmt::format("--{} {}", key, text)});
    };
    add("alpha", f.alpha, true);
    add("exposure", f.exposure, true);
    add("brightest", f.brightest, true);
    add("store", f.store, false);
    add("tolerance", f.tolerance, false);
    for (const auto& [key, text] : reading_keys(f)) add(key, text, false);
    if (!f.smallest.empty())
        out.keys.push_back({{"suite", "smallest"}, number_of_share(f.smallest), true, "--smallest " + f.smallest});
    for (const std::string& layer : f.layers) add("layer", layer, false);
    return out;
}

/// InputError if a flag is given that a suite does not have.
void forbid_other_flags(const CompareFlags& f) {
    const std::pair<const char*, bool> arm_options[] = {{"--arm", !f.arms.empty()},
        {"--reference", !f.reference.empty()}, {"--region", !f.regions.empty() && !f.makes_both_sides()},
        {"--mask", !f.masks.empty()}, {"--spp", !f.spp.empty()}, {"--seconds", !f.seconds.empty()},
        {"--assert", !f.assertions.empty()}, {"--align", !f.align.empty()}, {"--expect", !f.expect.empty()},
        {"--trim", !f.trim.empty()}, {"--theme", !f.theme.empty()}, {"--crop", f.crop},
        {"--pair", f.pair && !f.makes_renders()}};
    for (const auto& [flag, is_given] : arm_options)
        if (is_given)
            throw InputError({flag, 0, 0}, "expected no such flag: a suite compares a baseline and a candidate");
    if (!f.because.empty() && !f.accept) throw InputError({"--because", 0, 0}, "expected --accept with it");
    if (!f.store.empty() && !f.accept) throw InputError({"--store", 0, 0}, "expected --accept with it");
    const std::pair<const char*, bool> render_options[] = {{"--until", !f.until.empty()},
        {"--budget", !f.budget.empty()}, {"--timeout", !f.timeout.empty()}, {"--views", !f.made_views.empty()}};
    for (const auto& [flag, is_given] : render_options)
        if (is_given && !f.makes_renders())
            throw InputError({flag, 0, 0}, "expected --render, or --a and --b, with it");
    if (!f.made_views.empty() && !f.render.empty())
        throw InputError({"--views", 0, 0}, "expected --a and --b with it: --render makes those of the suite");
    if (f.makes_renders() && (f.accept || f.plan))
        throw InputError({"--render", 0, 0}, "expected no --accept and no --plan with it");
    if (f.plan && f.accept) throw InputError({"--plan", 0, 0}, "expected no --accept with it");
}

std::string suite_command(const CompareFlags& f) {
    std::string out = "crescent compare";
    if (!f.file.empty()) out += " " + shell_word(f.file);
    const std::pair<const char*, std::string> options[] = {{"--baseline", f.baseline}, {"--candidate", f.candidate},
        {"--alpha", f.alpha}, {"--smallest", f.smallest}, {"--brightest", f.brightest}, {"--exposure", f.exposure},
        {"--tolerance", f.tolerance}};
    for (const auto& [flag, value] : options)
        if (!value.empty()) out += fmt::format(" {} {}", flag, shell_word(value));
    for (const auto& [key, text] : reading_keys(f))
        if (!text.empty()) out += fmt::format(" --{} {}", key, shell_word(text));
    for (const std::string& layer : f.layers) out += " --layer " + shell_word(layer);
    for (const auto& [flag, value] : {std::pair{"--render", f.render}, std::pair{"--a", f.a}, std::pair{"--b", f.b},
             std::pair{"--until", f.until}, std::pair{"--budget", f.budget}, std::pair{"--timeout", f.timeout}})
        if (!value.empty()) out += fmt::format(" {} {}", flag, shell_word(value));
    for (const std::string& region : f.regions) out += " --region " + shell_word(region);
    if (!f.made_views.empty()) out += " --views " + shell_word(fmt::format("{}", fmt::join(f.made_views, ",")));
    if (f.pair) out += " --pair";
    if (f.jobs != 1) out += fmt::format(" --jobs {}", f.jobs);
    if (f.new_baseline) out += " --new-baseline";
    return out;
}

/// 2026-11-25T21:04:05Z; "unknown" if the clock has no date, as at the ends of 64 bits.
std::string now_text() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    if (!gmtime_r(&now, &parts)) return "unknown";
    char out[sizeof "2026-11-25T21:04:05Z"];
    std::strftime(out, sizeof out, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return out;
}

int accept_suite(const CompareFlags& flags, Progress& progress) {
    const Acceptance acceptance{.views = flags.views,
        .because = flags.because,
        .date = now_text(),
        .program = fmt::format("crescent {} ({})", crescent::version(), commit())};
    std::string folder;
    const auto read = [&] {
        Suite suite = read_suite(flags.file, suite_flags(flags));
        folder = baseline_folder(suite);
        return suite;
    };
    const std::vector<std::string> lines = accept_views(read, acceptance, progress);
    progress.clear();
    print(fmt::format("{}\n{}/baseline.json has the new baseline of {} view{}.\n", fmt::join(lines, "\n"), folder,
        lines.size(), lines.size() == 1 ? "" : "s"));
    return passed;
}

int plan_suite(const CompareFlags& flags, const Suite& suite, Progress& progress) {
    claim_outputs({{"--json", flags.json}}, {flags.file});
    const std::vector<ViewPlan> plans = plan_renders(suite, progress);
    progress.clear();
    if (!flags.json.empty()) write_whole(flags.json, render_plan_json(suite, plans));
    print(render_plan_text(suite, plans));
    return passed;
}

/// The suite of a file, of folders, or of two commands.
Suite suite_for(const CompareFlags& flags) {
    if (flags.makes_both_sides()) return suite_of_two(flags, suite_flags(flags).keys);
    return read_suite(flags.file, suite_flags(flags));
}

int test_suite(const CompareFlags& flags) {
    Suite suite = suite_for(flags);
    Provenance provenance;
    provenance.version = crescent::version();
    provenance.commit = commit();
    provenance.compiler = compiler();
    provenance.command = suite_command(flags);
    Progress progress(flags.quiet ? Progress::Style::silent : Progress::fitting());
    const StopOnSignal stop(progress);
    if (flags.plan) return plan_suite(flags, suite, progress);
    claim_outputs(with_reports({{"--json", flags.json}, {"--markdown", flags.markdown}}, flags.reports), {flags.file});
    Staging staging(flags.out.empty() ? "out/compare" : flags.out);
    const SuiteResult result =
        flags.makes_renders() ? make_renders_of(flags, suite, progress) : crescent::compare_suite(suite, progress);
    if (!flags.json.empty()) write_whole(flags.json, suite_json(suite, result, flags.new_baseline, provenance));
    if (!flags.markdown.empty()) write_whole(flags.markdown, suite_markdown(suite, result, provenance));
    write_reports(flags.reports, suite_report(suite, result, flags.new_baseline, provenance.version));
    staging.write("report.html", suite_html(suite, result, provenance));
    for (const auto& [name, bytes] : suite_plates(result)) staging.write(name, bytes);
    staging.commit(progress);
    progress.clear();
    print(suite_summary(suite, result));
    const int code = exit_code(result, flags.new_baseline);
    return code == inconclusive && flags.allow_inconclusive ? passed : code;
}

}  // namespace

int compare_suite(const CompareFlags& flags) {
    forbid_other_flags(flags);
    keep_freed_memory();
    if (!flags.accept) return test_suite(flags);
    Progress progress(flags.quiet ? Progress::Style::silent : Progress::fitting());
    const StopOnSignal stop(progress);
    return accept_suite(flags, progress);
}

}  // namespace crescent::cli
