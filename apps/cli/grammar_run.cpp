// The flags of `crescent run` and `crescent film`.
#include <cstdio>

#include "crescent/crescent.h"
#include "grammar.h"

namespace crescent::cli {

namespace {

constexpr const char* run_footer = R"(FILE is an experiment (`crescent schema` has its keys). --set takes the path
of any key, with the same checks as the file:
  --set sphere.s=64 --set seed=7
Films are the same bits for any --threads and any --isa. --instrument gl
computes them in GLSL, the same to a tolerance: docs/gl.md.

Written under DIR: report.html, metrics.json, metrics.csv, junit.xml,
timing.json, plates/, films/, in place of those of an earlier run. They appear
as one, or not at all. --only metrics writes metrics.json, metrics.csv and
junit.xml; --seed-range lets several machines share the seeds (assertions that
need the others are skipped), and `crescent join` makes one run of the parts.
A long run that was stopped resumes when the same command is given again.)";

constexpr const char* join_footer = R"(A PART is the folder of a run or its metrics.json. All must be of one
experiment (--seeds and --seed-range do not change it), version and
instrument; seeds that two of them have must agree bit for bit. Written under
DIR: metrics.json, metrics.csv and junit.xml, as of one run with all seeds.
Assertions that need seeds which are in no part are skipped.)";

constexpr const char* report_footer = R"(Of a run or a comparison the page is report.html, with the plates that are in
plates/ beside FILE; of check.json it is check.html.)";

constexpr const char* film_footer = R"(The film of an experiment: every picture, curve and number comes from the run
that it is made with. Written under DIR as one: crescent.mp4, captions
(.vtt, .srt), transcript (.txt), frames.json and a still of every shot.
--still, --stills, --shot, --from and --to make a part of it alone.
Frames are the same bits for any --threads and any --isa. Needs ffmpeg.)";

std::string moment(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string minutes = colon == std::string::npos ? "0" : text.substr(0, colon);
    const std::string seconds_text = colon == std::string::npos ? text : text.substr(colon + 1);
    const bool has_minutes =
        !minutes.empty() && minutes.find_first_not_of("0123456789") == std::string::npos && minutes.size() < 4;
    char* end = nullptr;
    const double s = std::strtod(seconds_text.c_str(), &end);
    const bool has_seconds =
        !seconds_text.empty() && seconds_text.find_first_not_of("0123456789.") == std::string::npos && *end == 0;
    return has_minutes && has_seconds && (colon == std::string::npos || s < 60) ? "" : "expected MM:SS, as in 1:30";
}

std::string seed_range(const std::string& text) {
    int first = 0, last = 0, read = 0;
    const bool is_plain = text.find_first_not_of("0123456789:") == std::string::npos && text.size() <= 9;
    const bool is_range = is_plain && std::sscanf(text.c_str(), "%d:%d%n", &first, &last, &read) == 2;
    const bool is_good = is_range && static_cast<std::size_t>(read) == text.size() && first >= 1 && first <= last;
    return is_good ? "" : "expected A:B with 1 <= A <= B, as in 1:8";
}

}  // namespace

void add_run(CLI::App& app, Work& work) {
    std::shared_ptr<RunFlags> f;
    CLI::App* c = command(app, work, "run", "Run an experiment: films, metrics, plates, report.", run, f);
    c->footer(run_footer);
    c->add_option("FILE", f->file, "the experiment, a TOML file")->required()->type_name("");
    c->add_option("--out", f->out, "where the outputs go; default: out/ and FILE's name")
        ->type_name("DIR")
        ->check(not_empty);
    c->add_option("--set", f->overrides, "another value for a key; may be given again")
        ->type_name("PATH=VALUE")
        ->take_all()
        ->expected(1)
        ->allow_extra_args(false);
    c->add_option("--seeds", f->seeds, "how many seeds the bands are made of (--set seeds=K)")
        ->type_name("K")
        ->check(whole_number(1, 4096));
    auto* preview = c->add_flag("--preview", f->preview, "DIR/preview.png alone: where regions and crops lie");
    c->add_option("--seed-range", f->seed_range, "seeds A to B of the series alone, from 1")
        ->type_name("A:B")
        ->check(seed_range)
        ->excludes(preview);
    c->add_option("--only", f->only, "of metrics, films, plates, report: these alone")
        ->type_name("PART,..")
        ->check(not_empty)
        ->excludes(preview);
    c->add_flag("--no-studies", f->no_studies, "leave out tails, furnaces and article checks")->excludes(preview);
    c->add_flag("--no-references", f->no_references, "films of the first seed alone, without metrics")
        ->excludes(preview);
    c->add_option("--threads", f->threads, "default: as many as this process may use")
        ->type_name("N")
        ->check(whole_number(1, 4096));
    c->add_option("--isa", f->isa, all_isas() + "; default: the best here")->type_name("NAME");
    c->add_option("--instrument", f->backend, "what computes the films: cpu, gl")
        ->type_name("NAME")
        ->check(one_of({"cpu", "gl"}));
    c->add_option("--gl-context", f->gl_context, "with gl: egl (default), osmesa")
        ->type_name("NAME")
        ->check(one_of({"egl", "osmesa"}));
    c->add_option("--gl-device", f->gl_device, "with gl: which of `list devices`")
        ->type_name("N")
        ->check(whole_number(0, 1023));
    c->add_flag("--no-code", f->no_code, "refuse a file that names a program or plugin");
    timeout(*c, f->timeout);
    c->add_option("--keep-after", f->keep_after, "finished passes of longer runs are kept; default 10")
        ->type_name("SECONDS")
        ->check(seconds);
    c->add_flag("--quiet", f->quiet, "no progress; the summary stays");
}

void add_join(CLI::App& app, Work& work) {
    std::shared_ptr<JoinFlags> f;
    CLI::App* c = command(app, work, "join", "Join runs of parts of an experiment's seeds into one.", join, f);
    c->footer(join_footer);
    c->add_option("PART", f->parts, "the folder of a run, or its metrics.json")
        ->required()
        ->type_name("...")
        ->check(not_empty);
    c->add_option("--out", f->out, "where the outputs go")->required()->type_name("DIR")->check(not_empty);
}

void add_report(CLI::App& app, Work& work) {
    std::shared_ptr<ReportFlags> f;
    CLI::App* c = command(app, work, "report", "Make the page of a stored result.", report, f);
    c->footer(report_footer);
    c->add_option("FILE", f->file, "the metrics.json of a run or a comparison, or what check --json wrote")
        ->required()
        ->type_name("")
        ->check(not_empty);
    c->add_option("--out", f->out, "the page; default: beside FILE")->type_name("FILE")->check(not_empty);
}

void add_film(CLI::App& app, Work& work) {
    std::shared_ptr<FilmFlags> f;
    CLI::App* c = command(app, work, "film", "Make an explainer film of what a run measures.", film, f);
    ExplainerOptions& o = f->options;
    c->footer(film_footer);
    c->add_option("FILE", f->file, "the experiment, a TOML file")->required()->type_name("");
    c->add_option("--out", o.out, "where the outputs go; default: out/film")->type_name("DIR")->check(not_empty);
    c->add_option("--size", f->size, "1080p (default), 720p, 360p")
        ->type_name("P")
        ->check(one_of({"1080p", "720p", "360p"}));
    auto* still =
        c->add_option("--still", o.still, "the frame at this time alone, a PNG")->type_name("MM:SS")->check(moment);
    auto* stills = c->add_flag("--stills", o.stills, "a PNG of every shot, no film")->excludes(still);
    c->add_option("--shot", o.shot, "this shot alone")->type_name("K")->check(whole_number(1, 99));
    auto* from = c->add_option("--from", o.from, "from this time on")->type_name("MM:SS")->check(moment);
    auto* to = c->add_option("--to", o.to, "up to this time")->type_name("MM:SS")->check(moment);
    for (auto* part : {from, to}) part->excludes(still)->excludes(stills);
    c->add_option("--set", f->overrides, "another value for a key; may be given again")
        ->type_name("PATH=VALUE")
        ->take_all()
        ->expected(1)
        ->allow_extra_args(false);
    c->add_option("--seeds", f->seeds, "how many seeds (--set seeds=K)")->type_name("K")->check(whole_number(1, 4096));
    c->add_flag("--no-code", f->no_code, "refuse a file that names a program or plugin");
    timeout(*c, o.timeout_s);
    c->add_option("--threads", o.threads, "default: as many as this process may use")
        ->type_name("N")
        ->check(whole_number(1, 4096));
    c->add_option("--isa", o.isa, all_isas() + "; default: the best here")->type_name("NAME");
    c->add_flag("--quiet", f->quiet, "no progress; the summary stays");
}

}  // namespace crescent::cli
