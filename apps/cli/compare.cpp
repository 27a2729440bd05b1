// crescent compare: metrics, bias tests, plates and a report for renders of other programs.
#include <filesystem>
#include <fmt/format.h>

#include "commands.h"
#include "crescent/crescent.h"
#include "progress.h"
#include "signals.h"

namespace crescent::cli {

namespace {

/// Returns the arms of the flags and of the file.
std::vector<std::string> arms_of(const CompareFlags& flags) {
    std::vector<std::string> out;
    for (const std::string& arm : flags.arms) out.push_back(arm.substr(0, arm.find('=')));
    if (!flags.file.empty())
        for (const std::string& name : compare_arms(flags.file)) out.push_back(name);
    return out;
}

/// Reads a number for all arms, or for one by name, which overrides it.
void per_arm(std::vector<CompareFlag>& out, const CompareFlags& flags, const std::vector<std::string>& texts,
    const std::string& flag, const char* key) {
    for (const std::string& text : texts) {
        if (text.find('=') != std::string::npos) continue;
        for (const std::string& arm : arms_of(flags))
            out.push_back({{"arms", arm, key}, text, true, flag + " " + text});
    }
    const std::vector<std::string> arms = arms_of(flags);
    for (const std::string& text : texts) {
        if (text.find('=') == std::string::npos) continue;
        const auto [arm, value] = name_and_value(flag, text, "NAME=NUMBER");
        if (std::find(arms.begin(), arms.end(), arm) == arms.end())
            throw InputError(
                {flag + " " + text, 0, 0}, fmt::format("no arm '{}': expected one of {}", arm, fmt::join(arms, ", ")));
        out.push_back({{"arms", arm, key}, value, true, flag + " " + text});
    }
}

/// Reads "LAYER" for all files, or "NAME=LAYER" for an arm or the reference, which overrides it. Layers may have a '='
/// too.
void layers_of(std::vector<CompareFlag>& out, const CompareFlags& flags) {
    const std::vector<std::string> arms = arms_of(flags);
    const auto is_named = [&](const std::string& text) {
        const std::string name = text.substr(0, text.find('='));
        return name.size() < text.size() && (name == "reference" || std::count(arms.begin(), arms.end(), name));
    };
    const auto add = [&](const std::string& name, const std::string& layer, const std::string& text) {
        if (name == "reference") out.push_back({{"reference_layer"}, layer, false, "--layer " + text});
        else out.push_back({{"arms", name, "layer"}, layer, false, "--layer " + text});
    };
    for (const std::string& text : flags.layers) {
        if (is_named(text)) continue;
        for (const std::string& arm : arms) add(arm, text, text);
        add("reference", text, text);
    }
    for (const std::string& text : flags.layers)
        if (is_named(text)) add(text.substr(0, text.find('=')), text.substr(text.find('=') + 1), text);
}

std::vector<CompareFlag> flags_of(const CompareFlags& f) {
    std::vector<CompareFlag> out;
    for (const std::string& text : f.arms) {
        const auto [name, files] = name_and_value("--arm", text, "NAME=FILES");
        out.push_back({{"arms", name, "files"}, files, false, "--arm " + text});
    }
    for (const std::string& text : f.reference) out.push_back({{"reference"}, text, false, "--reference " + text});
    for (const std::string& text : f.regions) {
        const auto [name, box] = name_and_value("--region", text, "NAME=x0,y0,x1,y1");
        out.push_back({{"regions", name, "box"}, "[" + box + "]", true, "--region " + text});
    }
    for (const std::string& text : f.masks) {
        const auto [name, file] = name_and_value("--mask", text, "NAME=FILE");
        out.push_back({{"masks", name, "file"}, file, false, "--mask " + text});
    }
    layers_of(out, f);
    per_arm(out, f, f.spp, "--spp", "spp");
    per_arm(out, f, f.seconds, "--seconds", "seconds");
    for (const std::string& text : f.assertions)
        out.push_back({{"assertions", text, "check"}, text, false, "--assert '" + text + "'"});
    for (const auto& [key, text] : reading_keys(f))
        if (!text.empty()) out.push_back({{key}, text, false, fmt::format("--{} {}", key, text)});
    if (!f.theme.empty()) out.push_back({{"theme"}, f.theme, false, "--theme " + f.theme});
    if (!f.align.empty()) out.push_back({{"align"}, f.align, false, "--align " + f.align});
    if (f.crop) out.push_back({{"crop"}, "true", true, "--crop"});
    if (f.pair) out.push_back({{"pair"}, "true", true, "--pair"});
    if (!f.expect.empty()) out.push_back({{"expect"}, f.expect, false, "--expect " + f.expect});
    const std::pair<const char*, std::string> numbers[] = {
        {"exposure", f.exposure}, {"alpha", f.alpha}, {"trim", f.trim}, {"brightest", f.brightest}};
    for (const auto& [key, text] : numbers)
        if (!text.empty()) out.push_back({{key}, text, true, std::string("--") + key + " " + text});
    if (!f.smallest.empty())
        out.push_back({{"smallest"}, number_of_share(f.smallest), true, "--smallest " + f.smallest});
    return out;
}

std::string command_of(const CompareFlags& f) {
    std::string out = "crescent compare";
    if (!f.file.empty()) out += " " + shell_word(f.file);
    const auto add = [&](const char* flag, const std::vector<std::string>& values) {
        for (const std::string& value : values) out += fmt::format(" {} {}", flag, shell_word(value));
    };
    add("--arm", f.arms);
    add("--reference", f.reference);
    add("--region", f.regions);
    add("--mask", f.masks);
    add("--layer", f.layers);
    add("--spp", f.spp);
    add("--seconds", f.seconds);
    add("--assert", f.assertions);
    if (f.pair) out += " --pair";
    if (f.crop) out += " --crop";
    const std::pair<const char*, std::string> options[] = {{"--align", f.align}, {"--expect", f.expect},
        {"--smallest", f.smallest}, {"--exposure", f.exposure}, {"--alpha", f.alpha}, {"--trim", f.trim},
        {"--brightest", f.brightest}, {"--theme", f.theme}};
    for (const auto& [flag, value] : options)
        if (!value.empty()) out += fmt::format(" {} {}", flag, shell_word(value));
    for (const auto& [key, value] : reading_keys(f))
        if (!value.empty()) out += fmt::format(" --{} {}", key, shell_word(value));
    return out;
}

/// InputError if a flag is given that only a suite has.
void forbid_suite_flags(const CompareFlags& f) {
    const std::pair<const char*, bool> suite_options[] = {{"--json", !f.json.empty()},
        {"--markdown", !f.markdown.empty()}, {"--because", !f.because.empty()}, {"--store", !f.store.empty()},
        {"--tolerance", !f.tolerance.empty()}, {"--new-baseline", f.new_baseline}, {"--plan", f.plan},
        {"--accept", f.accept}};
    for (const auto& [flag, is_given] : suite_options)
        if (is_given)
            throw InputError(
                {flag, 0, 0}, "expected a suite: a file with a table [suite], or --baseline and --candidate");
}

/// Writes files that say that the call failed, in place of those of an earlier call; "": none.
void report_failure(const ReportFiles& reports, const std::string& file, const std::exception& error) {
    try {
        write_reports(reports, failure_report(file, error, crescent::version()));
    } catch (const OutputError&) {  // the failure itself is reported
    }
}

int compare_arms(const CompareFlags& flags, const std::string& out) {
    const ComparePlan plan = plan_of(flags_of(flags), flags.file);
    claim_outputs(with_reports({}, flags.reports), {flags.file});
    Provenance provenance;
    provenance.version = crescent::version();
    provenance.commit = commit();
    provenance.compiler = compiler();
    provenance.command = command_of(flags);
    Progress progress(flags.quiet ? Progress::Style::silent : Progress::fitting());
    const StopOnSignal stop(progress);
    std::string summary;
    const CompareResult result = crescent::compare_renders(plan, {out}, provenance, progress, summary);
    progress.clear();
    print(summary);
    write_reports(flags.reports, compare_report(plan, result, flags.file, provenance.version));
    return result.state == CompareResult::State::holds ? passed
        : result.state == CompareResult::State::fails  ? failed
        : flags.allow_inconclusive                     ? passed
                                                       : inconclusive;
}

}  // namespace

std::pair<std::string, std::string> name_and_value(const std::string& flag, const std::string& text, const char* what) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos)
        throw InputError({flag + " " + text, 0, 0}, std::string("expected ") + what);
    return {text.substr(0, equals), text.substr(equals + 1)};
}

int compare(const CompareFlags& flags) {
    if (flags.schema)
        return print(flags.schema_as_json ? compare_schema_json() : compare_schema_text() + "\n" + suite_schema_text()),
               passed;
    const bool has_folders = !flags.baseline.empty() || !flags.candidate.empty();
    const std::string out = flags.out.empty() ? "out/compare" : flags.out;
    std::string earlier_junit;
    try {
        if (has_folders || flags.makes_renders() || (!flags.file.empty() && is_suite(flags.file)))
            return compare_suite(flags);
        forbid_suite_flags(flags);
        if (flags.file.empty() && flags.arms.empty())
            throw InputError({"crescent compare", 0, 0}, "expected a compare file, or --arm NAME=FILES");
        std::error_code ignored;  // that of an earlier call says nothing about this one
        if (std::filesystem::is_regular_file(out + "/junit.xml", ignored)) earlier_junit = out + "/junit.xml";
        return compare_arms(flags, out);
    } catch (const Interrupted&) { throw; } catch (const std::exception& e) {
        report_failure(flags.reports, flags.file, e);
        report_failure({{"junit", earlier_junit}}, flags.file, e);
        throw;
    }
}

}  // namespace crescent::cli
