// The one file that knows the command line's grammar, and the manual that --help prints.
#include "arguments.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "commands.h"
#include "crescent.h"

namespace crescent::cli {

namespace {

using Work = std::function<int()>;

constexpr const char* footer = R"(Exit codes: 0 all holds; 1 an assertion fails (check: wrong); 2 wrong command
line or experiment file; 3 an output cannot be written, a part is missing or
(check) the sampler broke off; 4 inconclusive (check); 130 interrupted.

  crescent run experiments/gallery.toml      the published experiment
  crescent run experiments/gallery.toml --set sphere.s=64 --set seed=7
  crescent list                              what an experiment can name
  crescent schema                            every key of an experiment file)";

constexpr const char* run_footer = R"(FILE is an experiment (`crescent schema` has its keys). --set takes the path
of any key, with the same checks as the file:
  --set sphere.s=64 --set seed=7
Films are the same bits for any --threads and any --isa. --instrument gl
computes them in GLSL, the same to a tolerance: docs/gl.md.

Written under DIR: report.html, metrics.json, metrics.csv, junit.xml,
timing.json, plates/, films/. Each file appears whole or not at all. A long run
that was stopped goes on where it was when the same command is given again.)";

std::string told(const std::string& text) { return text.find_first_not_of(" \t") == std::string::npos ? "is empty" : ""; }

std::string seconds(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end != text.c_str() && *end == 0 && value >= 0 && value <= 1e9 ? "" : "expected seconds, 0 to 1e9";
}

/// A command that fills in Flags and then runs `perform`.
template <class Flags> CLI::App* command(CLI::App& app, Work& work, const char* name, const char* means, int (*perform)(const Flags&), std::shared_ptr<Flags>& flags) {
    flags = std::make_shared<Flags>();
    CLI::App* sub = app.add_subcommand(name, means);
    sub->callback([&work, flags, perform] { work = [flags, perform] { return perform(*flags); }; });
    return sub;
}

void add_run(CLI::App& app, Work& work) {
    std::shared_ptr<RunFlags> f;
    CLI::App* c = command(app, work, "run", "Run an experiment: films, meters, plates, report.", run, f);
    c->footer(run_footer);
    c->add_option("FILE", f->file, "the experiment, a TOML file")->required()->type_name("");
    c->add_option("--out", f->out, "where the outputs go; default: out/ and FILE's name")->type_name("DIR")->check(told);
    c->add_option("--set", f->overrides, "another value for a key; may be given again")->type_name("PATH=VALUE")->take_all()->expected(1)->allow_extra_args(false);
    c->add_option("--seeds", f->seeds, "how many seeds the bands are made of (--set seeds=K)")->type_name("K")->check(CLI::Range(1, 4096));
    c->add_option("--threads", f->threads, "default: as many as the machine has")->type_name("N")->check(CLI::Range(1, 4096));
    c->add_option("--isa", f->isa, all_isas() + "; default: the best here")->type_name("NAME");
    c->add_option("--instrument", f->instrument, "what computes the films: cpu, gl")->type_name("NAME")->check(CLI::IsMember({"cpu", "gl"}));
    c->add_option("--gl-context", f->gl_context, "with gl: egl (default), osmesa")->type_name("NAME")->check(CLI::IsMember({"egl", "osmesa"}));
    c->add_option("--gl-device", f->gl_device, "with gl: which of `list devices`")->type_name("N")->check(CLI::Range(0, 1023));
    c->add_option("--keep-after", f->keep_after, "longer work is kept as it goes; default 10")->type_name("SECONDS")->check(seconds);
    c->add_flag("--quiet", f->quiet, "no progress; the summary stays");
}

constexpr const char* film_footer = R"(The film of an experiment: every picture, curve and number comes from the run
that it is made with. Written under DIR as one: crescent.mp4, captions
(.vtt, .srt), transcript (.txt), frames.json and a still of every shot.
--still, --stills, --shot, --from and --to make a part of it alone.
Frames are the same bits for any --threads and any --isa. Needs ffmpeg.)";

std::string moment(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string minutes = colon == std::string::npos ? "0" : text.substr(0, colon);
    const std::string rest = colon == std::string::npos ? text : text.substr(colon + 1);
    const bool plain = !minutes.empty() && minutes.find_first_not_of("0123456789") == std::string::npos && minutes.size() < 4;
    char* end = nullptr;
    const double s = std::strtod(rest.c_str(), &end);
    const bool seconds_too = !rest.empty() && rest.find_first_not_of("0123456789.") == std::string::npos && *end == 0;
    return plain && seconds_too && (colon == std::string::npos || s < 60) ? "" : "expected MM:SS, as in 1:30";
}

void add_film(CLI::App& app, Work& work) {
    std::shared_ptr<FilmFlags> f;
    CLI::App* c = command(app, work, "film", "Make an explainer film of what a run measures.", film, f);
    FilmOptions& o = f->options;
    c->footer(film_footer);
    c->add_option("FILE", f->file, "the experiment, a TOML file")->required()->type_name("");
    c->add_option("--out", o.out, "where the outputs go; default: out/film")->type_name("DIR")->check(told);
    c->add_option("--size", f->size, "1080p (default), 720p, 360p")->type_name("P")->check(CLI::IsMember({"1080p", "720p", "360p"}));
    auto* still = c->add_option("--still", o.still, "the frame at this time alone, a PNG")->type_name("MM:SS")->check(moment);
    auto* stills = c->add_flag("--stills", o.stills, "a PNG of every shot, no film")->excludes(still);
    c->add_option("--shot", o.shot, "this shot alone")->type_name("K")->check(CLI::Range(1, 99));
    auto* from = c->add_option("--from", o.from, "from this time on")->type_name("MM:SS")->check(moment);
    auto* to = c->add_option("--to", o.to, "up to this time")->type_name("MM:SS")->check(moment);
    for (auto* part : {from, to}) part->excludes(still)->excludes(stills);
    c->add_option("--voice", o.voice, "speaks the captions: text in, WAV out")->type_name("'COMMAND'")->check(told);
    c->add_flag("--webm", o.webm, "crescent.webm too (VP9)");
    c->add_option("--set", f->overrides, "another value for a key; may be given again")->type_name("PATH=VALUE")->take_all()->expected(1)->allow_extra_args(false);
    c->add_option("--seeds", f->seeds, "how many seeds (--set seeds=K)")->type_name("K")->check(CLI::Range(1, 4096));
    c->add_option("--threads", o.threads, "default: as many as the machine has")->type_name("N")->check(CLI::Range(1, 4096));
    c->add_option("--isa", o.isa, all_isas() + "; default: the best here")->type_name("NAME");
    c->add_flag("--quiet", f->quiet, "no progress; the summary stays");
}

void add_list(CLI::App& app, Work& work) {
    std::shared_ptr<ListFlags> f;
    CLI::App* c = command(app, work, "list", "What an experiment can name.", list, f);
    c->add_option("WHAT", f->what, "arms, shapes, brdfs, plates, meters, isas or devices; without it, all")->type_name("");
}

void add_schema(CLI::App& app, Work& work) {
    std::shared_ptr<SchemaFlags> f;
    CLI::App* c = command(app, work, "schema", "Every key of an experiment file: type, unit, range, default, meaning.", schema, f);
    c->add_flag("--json", f->json, "as a JSON Schema");
}

constexpr const char* check_footer = R"(Nine verdicts, in order: valid, support, normalised, density, identity, physics,
tail, mean, efficiency. Without ARM the whole list is judged, and 0 means that every
arm gets what the list expects of it. Else: 0 right, 1 wrong, 3 error (the sampler
crashed, fell silent or spoke another language), 4 inconclusive: something could not
be told, or was not looked at. Wrong comes before error, error before inconclusive.
docs/verdicts.md says what each verdict means and how --exec is spoken to.)";

void add_check(CLI::App& app, Work& work) {
    std::shared_ptr<CheckFlags> f;
    CLI::App* c = command(app, work, "check", "Judge samplers by themselves, without a picture.", check, f);
    c->footer(check_footer);
    auto* arm = c->add_option("ARM", f->arm, "a sampler of the list; without it, all")->type_name("");
    auto* set = c->add_option("--set", f->settings, "s, alpha, rho_d or rho_s; may be given again")->type_name("KEY=VALUE")->take_all()->expected(1)->allow_extra_args(false);
    auto* quick = c->add_flag("--quick", f->quick, "seconds an arm (the default)");
    c->add_flag("--full", f->full, "minutes: more directions, more draws")->excludes(quick);
    c->add_option("--alpha", f->alpha, "family-wise error of the whole call; default 1e-3")->type_name("P");
    c->add_option("--seed", f->seed, "default 1")->type_name("N");
    auto* planted = c->add_flag("--planted", f->planted, "judge the planted faults: which verdict catches which")->excludes(arm)->excludes(set);
    auto* rates = c->add_option("--error-rates", f->error_rates, "measure the bench itself on so many seeds")->type_name("SEEDS")->check(CLI::Range(1, 100000))->excludes(arm)->excludes(set)->excludes(planted);
    auto* exec = c->add_option("--exec", f->exec, "judge a program that answers over a pipe")->type_name("'PROGRAM ARGS'")->check(told);
    auto* samples = c->add_option("--samples", f->samples, "judge samples in a .csv or .npy file")->type_name("FILE")->check(told);
    c->add_option("--patience", f->patience, "s that --exec may take in all; default 120, with --full 3600")->type_name("SECONDS")->needs(exec)->check(CLI::Range(0.01, 1e6));
    c->add_flag("--accept-few", f->accept_few, "judge a slow --exec by the w_o that there was time for")->needs(exec);
    auto* right = c->add_option("--right", f->right, "judge so many right samplers at random parameters; with --error-rates in quick and in full mode")->type_name("N")->check(CLI::Range(1, 1000000));
    for (auto* other : {arm, set, planted}) right->excludes(other);
    c->add_option("--first", f->first, "of --right: where in their row to begin")->type_name("K")->needs(right);
    for (auto* other : {arm, set, planted, rates, right}) exec->excludes(other), samples->excludes(other);
    exec->excludes(samples);
    c->add_option("--pdf-table", f->table, "the density of --samples, a .csv or .npy grid")->type_name("FILE")->needs(samples)->check(told);
    c->add_option("--wo", f->wo, "the w_o of --samples")->type_name("x,y,z")->needs(samples);
    for (auto* file : {c->add_option("--json", f->json, "write every verdict with its evidence; equal calls give equal bytes"),
                       c->add_option("--timing", f->timing, "write what each verdict and each sample took"),
                       c->add_option("--junit", f->junit, "write for a build server"),
                       c->add_option("--html", f->html, "write one page with maps, histograms and roses")})
        file->type_name("FILE")->excludes(rates);
    c->add_flag("--quiet", f->quiet, "no progress; the table stays");
}

constexpr const char* compare_footer = R"(FILES is a path or a pattern of renders of one view, each one independent: OpenEXR,
PFM, Radiance HDR, NPY. --arm may be given again for the same NAME. Without a reference the
arms are held against each other. `crescent compare --schema` has the keys of FILE.

Written under DIR: report.html, metrics.json, metrics.csv, junit.xml, plates/.
Exit codes: 0 nothing asked is violated; 1 an assertion fails, or with --expect same a
difference was found; 4 --expect same, and too few renders to have seen one.)";

void add_compare(CLI::App& app, Work& work) {
    std::shared_ptr<CompareFlags> f;
    CLI::App* c = command(app, work, "compare", "Compare renders of any program: noise, bias, where.", compare, f);
    c->footer(compare_footer);
    const auto many = [&](const char* flag, std::vector<std::string>& to, const char* means, const char* type) {
        c->add_option(flag, to, means)->type_name(type)->take_all()->expected(1)->allow_extra_args(false)->check(told);
    };
    c->add_option("FILE", f->file, "a TOML file; flags stand over it")->type_name("");
    many("--arm", f->arms, "renders of one arm; may be given again", "NAME=FILES");
    many("--reference", f->reference, "the converged image, or several", "FILES");
    many("--region", f->regions, "a box, both ends inside, from the bottom-left", "NAME=x0,y0,x1,y1");
    many("--mask", f->masks, "pixels above 0 in a picture", "NAME=FILE");
    many("--layer", f->layers, "which layer of an arm's files, or reference=LAYER", "NAME=LAYER");
    many("--spp", f->spp, "samples a pixel of one render", "[NAME=]N");
    many("--seconds", f->seconds, "time of one render", "[NAME=]S");
    many("--assert", f->assertions, "a claim such as 'rmse.H(a) < rmse.H(b)'", "CHECK");
    c->add_flag("--pair", f->pair, "renders with the same number in their names share random numbers");
    c->add_option("--expect", f->expect, "same: a difference between arms fails")->type_name("same");
    c->add_option("--smallest", f->smallest, "with it: the difference that must have been seen; default 1%")->type_name("SHARE");
    c->add_option("--exposure", f->exposure, "of photographs; default 1")->type_name("E");
    c->add_option("--alpha", f->alpha, "chance of a false alarm; default 0.01")->type_name("P");
    c->add_option("--trim", f->trim, "share of pixels relMSE and MAPE leave out; default 0")->type_name("SHARE");
    c->add_option("--out", f->out, "where the outputs go; default: out/compare")->type_name("DIR")->check(told);
    auto* schema = c->add_flag("--schema", f->schema, "every key of FILE");
    c->add_flag("--json", f->json, "with --schema: as a JSON Schema")->needs(schema);
    auto* rates = c->add_option("--error-rates", f->error_rates, "measure compare itself on so many made-up calls");
    rates->type_name("CALLS")->check(CLI::Range(1, 100000));
    c->add_option("--seed", f->seed, "of their noise; default 1")->type_name("SEED")->needs(rates);
    c->add_flag("--quiet", f->quiet, "no progress; the summary stays");
}

void add_version(CLI::App& app, Work& work) {
    std::shared_ptr<VersionFlags> f;
    command(app, work, "version", "Version, commit and compiler.", version, f);
    app.add_flag_callback("--version", [] { throw CLI::CallForVersion("", 0); }, "Version, commit and compiler.");
}

/// Commands where none was chosen, else the flags of the chosen one.
std::vector<std::string> words(const CLI::App& command) {
    std::vector<std::string> out;
    for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; })) out.push_back(sub->get_name());
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
    return out;
}

/// The parser's complaint in two lines, with the nearest valid word where a word is unknown.
std::string misuse(const CLI::App& app, const CLI::ParseError& error) {
    const auto used = app.get_subcommands();
    const CLI::App& command = used.empty() ? app : *used.front();
    const std::string name = used.empty() ? "crescent" : "crescent " + command.get_name();
    std::string text = name + ": " + error.what();
    const std::vector<std::string> extra = app.remaining(true);
    if (dynamic_cast<const CLI::ExtrasError*>(&error) && !extra.empty()) {
        const std::string near = nearest(extra.front().substr(0, extra.front().find('=')), words(command));
        text = name + ": no '" + extra.front() + "' here" + (near.empty() ? "" : "; did you mean '" + near + "'?");
    }
    return text + "\n`" + name + " --help` says what it takes\n";
}

Work answer(std::FILE* to, const std::string& text, int code) {
    return [=] {
        if (to == stdout) print(text);
        else complain(text);
        return code;
    };
}

}  // namespace

std::function<int()> parse(int argc, char** argv) {
    CLI::App app("A bench for importance samplers: it shows where the noise goes.", "crescent");
    app.footer(footer);
    app.get_formatter()->column_width(28);
    app.require_subcommand(0, 1);
    Work work;
    add_run(app, work);
    add_film(app, work);
    add_list(app, work);
    add_schema(app, work);
    add_check(app, work);
    add_compare(app, work);
    add_version(app, work);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return answer(stdout, app.help(), held);
    } catch (const CLI::CallForVersion&) {
        return [] { return version({}); };
    } catch (const CLI::ParseError& e) {
        return answer(stderr, misuse(app, e), misused);
    }
    return work ? work : answer(stderr, app.help(), misused);
}

}  // namespace crescent::cli
