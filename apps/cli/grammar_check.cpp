// The flags of `crescent check`.
#include <filesystem>

#include "crescent/crescent.h"
#include "grammar.h"
#include "sampler_flags.h"

namespace crescent::cli {

namespace {

constexpr const char* check_footer =
    R"(Without ARM every built-in arm is checked, each case with an eighth of the draws
if these are conclusive, and 0 means that each arm has its expected verdicts.
Else:  0 right, 1 wrong, 3 error (the sampler crashed, stopped responding or broke
the protocol), 4 inconclusive: something could not be decided, or was not
examined. Wrong comes before error, error before inconclusive. docs/check.md
explains the verdicts, docs/samplers.md the protocol of --exec.)";

/// "Verdicts, in order: valid, ...", in lines of at most 80 columns.
std::string verdicts_in_order() {
    std::string out = "Verdicts, in order:";
    std::size_t column = out.size();
    for (const std::string_view name : verdict_names) {
        const std::string word = std::string(name) + (name == verdict_names.back() ? "." : ",");
        const bool fits = column + 1 + word.size() <= 80;
        out += (fits ? ' ' : '\n') + word;
        column = (fits ? column + 1 : 0) + word.size();
    }
    return out + '\n';
}

/// --against.
CLI::Option* comparison(CLI::App& c, CheckFlags& f) {
    auto* against = c.add_option("--against", f.against,
        "compare the sampler with a built-in one, a shader, a plugin (FILE.so) or a program: same distribution, same "
        "f, variance ratio");
    against->type_name("ARM|FILE|FILE.py:NAME|'PROGRAM'")->check(not_empty);
    return against;
}

/// Adds --expect and --allow-inconclusive; returns the former.
CLI::Option* waivers(CLI::App& c, CheckFlags& f) {
    c.add_flag("--allow-inconclusive", f.allow_inconclusive, "exit 0 instead of 4");
    return c
        .add_option("--expect", f.expect,
            "an expected failure, or a file of such lines; same: with --against, a difference "
            "fails")
        ->type_name("'[ARM ]VERDICT=STATE: REASON'|FILE|same")
        ->check([](const std::string& text) {
            return std::filesystem::is_directory(text) ? "expected a file, found the folder " + printable(text) : "";
        })
        ->take_all()
        ->expected(1)
        ->allow_extra_args(false);
}

/// The output files of a call.
void outputs(CLI::App& c, CheckFlags& f) {
    add_file(c, "--json", f.json, "write every verdict with its evidence; equal calls give equal bytes");
    add_reports(c, f.reports);
    add_file(c, "--html", f.html, "write one page with maps, histograms and roses");
    add_file(c, "--repro", f.repro, "write a Python script that shows the first fault without crescent");
}

/// A sampler given by the caller, which excludes the `others` and each other. Returns that of --samples.
CLI::Option* samplers_of_caller(CLI::App& c, CheckFlags& f, std::vector<CLI::Option*> others) {
    const auto add = [&](const std::string& flag, std::string& value, const char* type, const char* purpose) {
        CLI::Option* out = c.add_option(flag, value, purpose)->type_name(type)->check(not_empty);
        for (CLI::Option* other : others) out->excludes(other);
        others.push_back(out);
        return out;
    };
    for (const SamplerFlag& flag : sampler_flags())
        add("--" + std::string(flag.name), f.samplers[flag.name], flag.type, flag.purpose);
    return add("--samples", f.samples, "FILE", "check samples in a .csv or .npy file");
}

/// The options of a shader. A value may begin with '-'.
void shaders(CLI::App& c, CheckFlags& f) {
    struct Flag {
        const char *name, *type, *means;
    };
    static constexpr Flag flags[] = {
        {"--sample", "'STATEMENTS'", "of a shader: they assign wi, and pdf or weight, from wo and u"},
        {"--pdf", "'EXPRESSION'", "of a shader: the density of wi for wo"},
        {"--f", "'EXPRESSION'", "of a shader: f without the cosine"},
        {"--f-cos", "'EXPRESSION'", "of a shader: f with the cosine"},
        {"--let", "'STATEMENT'", "of a shader: declarations before these; may be repeated"},
        {"--numbers", "K", "of a shader: random numbers of a sample; default 2"},
        {"-I", "DIR", "of a shader: a folder of included files; may be repeated"},
        {"-D", "NAME[=VALUE]", "of a shader: a macro; may be repeated"},
        {"--prelude", "FILE", "of a shader: text before the file; may be repeated"},
        {"--random", "FUNCTION", "of a shader: its calls return the next random numbers; may be repeated"},
        {"--up", "x|y|z", "of a shader: the axis of the normal; default z"},
        {"--frame", "local|world", "of a shader: world: about a normal n with tangents t and b"},
        {"--sides", "upper|both|none", "of a shader: the wo that it accepts; default upper"},
        {"--eta", "X[,Y,Z]", "of a shader: index of refraction below over above"},
        {"--channels", "1|3", "of a shader: of f and weight; default: by the type of f"},
        {"--device", "NAME", "of a shader: a part of an adapter's name; list: print them"},
    };
    for (const Flag& flag : flags)
        c.add_option(flag.name, f.shader[flag.name], flag.means)
            ->type_name(flag.type)
            ->take_all()
            ->expected(1)
            ->allow_extra_args(false);
    c.add_option("--over", f.over, "of a shader: verdicts at each value under one alpha: alpha=0.01,0.1")
        ->type_name("NAME=VALUES")
        ->check(not_empty);
}

/// The time limits of a program.
void limits(CLI::App& c, CheckFlags& f) {
    c.add_option("--patience", f.patience,
         "s that a program, or an arm that combines, may take in all; default 120, with --full 3600")
        ->type_name("SECONDS")
        ->check(number(0.01, 1e6));
    timeout(c, f.timeout);
    c.add_flag("--accept-few", f.accept_few, "check a slow program only at the w_o that there is time for");
}

}  // namespace

void add_check(CLI::App& app, Work& work) {
    std::shared_ptr<CheckFlags> f;
    CLI::App* c = command(app, work, "check", "Check samplers alone, without a render.", check, f);
    c->footer(verdicts_in_order() + check_footer);
    auto* arm =
        c->add_option("ARM", f->arm, "a built-in arm, FILE.py:NAME, a shader, or an experiment; without it, all")
            ->type_name("");
    auto* sampler =
        c->add_option("--sampler", f->sampler, "of an experiment: the arm to check, with its materials and lights")
            ->type_name("NAME")
            ->needs(arm)
            ->check(not_empty);
    c->add_option("--pixels", f->pixels, "check it at this many pixels of the scene, not on the grid of w_o")
        ->type_name("N")
        ->needs(sampler)
        ->check(whole_number(1, 4096));
    c->add_flag("--no-code", f->no_code, "refuse an experiment that names a plugin, a program or a Python file")
        ->needs(sampler);
    c->add_flag("--light", f->light, "the sampler is a light with its radiance: compare its irradiance");
    auto* set =
        c->add_option("--set", f->settings, "s, alpha, rho_d or rho_s; a key of the experiment; a constant of a shader")
            ->type_name("KEY=VALUE")
            ->take_all()
            ->expected(1)
            ->allow_extra_args(false);
    auto* quick = c->add_flag("--quick", f->quick, "seconds an arm (the default)");
    c->add_flag("--full", f->full, "minutes: more directions, more draws")->excludes(quick);
    c->add_option("--alpha", f->alpha, "family-wise error of the whole call; default 1e-3")
        ->type_name("P")
        ->check(number(0, 1));
    c->add_option("--seed", f->seed, "default 1")->type_name("N")->check(whole_number(0, 4294967295));
    auto* planted = c->add_flag("--planted", f->planted, "check the planted faults: which verdict detects which")
                        ->excludes(arm)
                        ->excludes(set);
    CLI::Option* samples = samplers_of_caller(*c, *f, {arm, set, planted});
    shaders(*c, *f);
    c->add_option(
         "--domain", f->domain, "what a shader or --samples draws, or a program that does not say; docs/domains.md")
        ->type_name("DOMAIN")
        ->check(not_empty);
    c->add_option("--estimates", f->estimates, "the expected value of a sampler of domain=number: 0.8187, exp(-0.2)")
        ->type_name("VALUE[,VALUE,VALUE]")
        ->check(not_empty);
    c->add_option("--neighbours", f->neighbours, "supplied to a sampler that merges reservoirs; default 8")
        ->type_name("K")
        ->check(whole_number(1, Neighbour::largest_count));
    limits(*c, *f);
    c->add_option("--pdf-table", f->table, "the density of --samples, a .csv or .npy grid")
        ->type_name("FILE")
        ->needs(samples)
        ->check(not_empty);
    auto* wo = c->add_option("--wo", f->wo, "check only at this w_o; may be repeated; the one of --samples");
    wo->type_name("DEG[,DEG] or x,y,z")->take_all()->expected(1)->allow_extra_args(false);
    outputs(*c, *f);
    auto* against = comparison(*c, *f);
    auto* describe = c->add_flag("--describe", f->describe,
        "print what distribution the draws have, with intervals, and no verdict; --json writes it");
    for (auto* other : {planted, against}) describe->excludes(other);
    for (auto* other : {planted, against, describe}) c->get_option("--repro")->excludes(other);
    auto* expect = waivers(*c, *f);
    for (auto* option : {expect, against, wo}) option->excludes(planted);
    c->add_flag("--quiet", f->quiet, "no progress; the verdicts stay");
    c->add_flag("--verbose", f->verbose, "print every finding, the number of tests, time, memory and evaluations");
}

}  // namespace crescent::cli
