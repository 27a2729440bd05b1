// The flags of `crescent compare`.
#include "crescent/crescent.h"
#include "grammar.h"

namespace crescent::cli {

namespace {

constexpr const char* compare_footer =
    R"(FILES is a path or a pattern of renders of one view, each one independent: OpenEXR,
PFM, NPY, Radiance HDR, PNG, JPEG, BMP, TGA, PGM, PPM. --arm may be given again for the same NAME. Without a reference the
arms are compared with each other. `crescent compare --schema` has the keys of FILE.

Written under DIR: report.html, metrics.json, metrics.csv, junit.xml, plates/.
Exit codes: 0 no assertion fails; 1 an assertion fails, or with --expect same a
difference was found; 4 --expect same, and too few renders to find one.

With --render, or with --a and --b, the renders are made here: more of each view until it is
decided; the probability of a false alarm holds although the number is not fixed before.

A FILE with a table [suite] compares the views of a baseline and a candidate. Written under
DIR: report.html. Exit codes: 1 a view changed, is noisier, is missing or is new; 2 a view cannot
be read; 4 too few renders.)";

/// The flags of a suite.
void add_suite_flags(CLI::App& c, const std::shared_ptr<CompareFlags>& f) {
    c.add_option("--baseline", f->baseline,
         "folder with VIEW/*.exr or VIEW-SEED.exr, or other images, in place of the suite's pattern")
        ->type_name("DIR")
        ->check(not_empty);
    c.add_option("--candidate", f->candidate, "the same of the renders to be compared")
        ->type_name("DIR")
        ->check(not_empty);
    c.add_flag("--allow-inconclusive", f->allow_inconclusive, "exit code 0 in place of 4: too few renders do not fail");
    const auto add_text = [&](const char* flag, std::string& to, const char* means, const char* type) {
        c.add_option(flag, to, means)->type_name(type)->check(not_empty);
    };
    add_text("--render", f->render,
        "of a suite: the program that makes renders of {view} with {seed} in the file {out}", "CMD");
    add_text("--a", f->a, "without a suite: the program that makes one side", "CMD");
    add_text("--b", f->b, "the same of the other side, whose mean is to be equal", "CMD");
    c.add_option("--views", f->made_views, "of --a and --b: what {view} stands for")
        ->type_name("A,B,...")
        ->delimiter(',');
    c.add_option("--tolerance", f->tolerance,
         "of renders without noise: \"0 ulp\", \"0.5 %\", \"2/255\" of each channel of a pixel; default: equal bits")
        ->type_name("SIZE")
        ->check(not_empty);
    add_text("--until", f->until, "make renders until each view is decided", "decided");
    add_text("--budget", f->budget, "the longest time for all renders; default 10min", "TIME");
    add_text("--timeout", f->timeout, "the longest time of one render; default 1h", "TIME");
    c.add_option("--jobs", f->jobs, "programs at a time; default 1")->type_name("N")->check(CLI::Range(1, 1024));
    c.add_flag("--new-baseline", f->new_baseline, "of a suite: views without a baseline do not fail");
    c.add_flag("--plan", f->plan, "of a suite: how many renders the smallest difference needs, from the baseline");
    c.add_option_function<std::vector<std::string>>(
         "--accept",
         [f](const std::vector<std::string>& views) {
             f->accept = true;
             for (const std::string& view : views)
                 if (!view.empty()) f->views.push_back(view);
         },
         "of a suite: make the candidate of these views (none named: of all) the baseline")
        ->type_name("[VIEW...]")
        ->expected(0, -1);
    c.add_option("--because", f->because, "with --accept: the reason, for the manifest")
        ->type_name("TEXT")
        ->check(not_empty);
    c.add_option("--store", f->store, "with --accept: renders, or moments (mean and variance of each pixel)")
        ->type_name("renders|moments");
    c.add_option_function<std::string>(
         "--json",
         [f](const std::string& path) {
             f->json = path;
             f->schema_as_json = true;
         },
         "of a suite: every number; with --schema: as a JSON Schema")
        ->type_name("[FILE]")
        ->expected(0, 1);
    add_reports(c, f->reports);
    add_file(c, "--markdown", f->markdown, "of a suite: a table of what changed, for a summary page");
}

}  // namespace

void add_compare(CLI::App& app, Work& work) {
    std::shared_ptr<CompareFlags> f;
    CLI::App* c = command(app, work, "compare", "Compare renders of any program: noise, bias, where.", compare, f);
    c->footer(compare_footer);
    const auto add_repeated = [&](const char* flag, std::vector<std::string>& to, const char* means, const char* type) {
        c->add_option(flag, to, means)
            ->type_name(type)
            ->take_all()
            ->expected(1)
            ->allow_extra_args(false)
            ->check(not_empty);
    };
    c->add_option("FILE", f->file, "a TOML file; flags override it")->type_name("");
    add_repeated("--arm", f->arms, "renders of one arm; may be given again", "NAME=FILES");
    add_repeated("--reference", f->reference, "the converged image, or several", "FILES");
    add_repeated("--region", f->regions, "a box, both ends inside, from the bottom-left", "NAME=x0,y0,x1,y1");
    add_repeated("--mask", f->masks, "pixels above 0 in a picture", "NAME=FILE");
    add_repeated("--layer", f->layers, "which layer of the files, of one arm's, or of reference=LAYER", "[NAME=]LAYER");
    const auto add_word = [&](const char* flag, std::string& to, const char* means, const char* type) {
        c->add_option(flag, to, means)->type_name(type)->check(not_empty);
    };
    add_word("--encoding", f->encoding, "how whole numbers encode radiance; default: as the file states it, else srgb",
        "srgb|linear");
    add_word("--space", f->space, "what of them is tested: radiance, or the displayed values", "radiance|display");
    add_word("--channels", f->channels, "rgba: the alpha channel is tested too", "rgb|rgba");
    add_word("--channel", f->channel, "this channel alone is tested", "NAME");
    add_repeated("--spp", f->spp, "samples a pixel of one render", "[NAME=]N");
    add_repeated("--seconds", f->seconds, "time of one render", "[NAME=]S");
    add_repeated("--assert", f->assertions, "a claim such as 'rmse.H(a) < rmse.H(b)'", "CHECK");
    c->add_option("--align", f->align, "display: place data windows that differ in the display window")
        ->type_name("display");
    c->add_flag("--crop", f->crop, "compare the pixels that the data windows of all renders share");
    c->add_flag("--pair", f->pair, "renders with the same number in their names share random numbers");
    c->add_option("--expect", f->expect, "same: a difference between arms fails")->type_name("same");
    c->add_option("--smallest", f->smallest, "with it: the difference that must be detectable; default 1%")
        ->type_name("SHARE");
    c->add_option("--exposure", f->exposure, "of photographs; default 1")->type_name("E");
    c->add_option("--alpha", f->alpha, "chance of a false alarm; default 0.01")->type_name("P");
    c->add_option("--trim", f->trim, "share of pixels relMSE and MAPE leave out; default 0")->type_name("SHARE");
    c->add_option("--brightest", f->brightest, "largest possible Y of a pixel of one render, e.g. a clamp")
        ->type_name("Y");
    c->add_option("--theme", f->theme, "of plates: dark, light")->type_name("THEME");
    c->add_option("--out", f->out, "where the outputs go; default: out/compare")->type_name("DIR")->check(not_empty);
    add_suite_flags(*c, f);
    c->add_flag("--schema", f->schema, "every key of FILE");
    c->add_flag("--quiet", f->quiet, "no progress; the summary stays");
}

}  // namespace crescent::cli
