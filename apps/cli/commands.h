// The commands of the program: their flags, and the exit codes that all of them return.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "crescent/crescent.h"

namespace crescent::cli {

class Progress;

/// Exit codes, the same for every command.
enum Exit : int {
    passed = 0,   // done, and all assertions hold (check: right)
    failed = 1,   // done, and an assertion fails (check: wrong)
    misused = 2,  // the command line or the experiment file is wrong; only --junit and --sarif may say so
    unwritable =
        3,  // an output could not be written, a needed part is missing, or (check) the sampler terminated: an error
    inconclusive = 4,  // check: neither right nor wrong
    bug = 70,          // an internal check failed (EX_SOFTWARE of sysexits.h)
    interrupted = 130  // SIGINT or SIGTERM
};

struct RunFlags {
    std::string file;
    std::vector<std::string> overrides;  // PATH=VALUE
    std::string out, isa;                // "": the default
    std::string backend = "cpu";
    std::string only, seed_range;  // "metrics,report", "1:8"; "": all
    std::string gl_context;        // "": EGL
    int gl_device = -1;            // -1: a GPU where there is one
    int seeds = 0, threads = 0;    // 0: the file's; as many as this process may use
    double keep_after = 10;        // s
    double timeout = 0;            // s that an answer of a program or plugin may take; 0: the defaults
    bool quiet = false, preview = false, no_code = false;
    bool no_references = false, no_studies = false;
};
int run(const RunFlags& flags);
/// The file that was given, or the installed experiment of that name: `crescent run gallery`.
std::string experiment_file(const std::string& word);

struct JoinFlags {
    std::vector<std::string> parts;
    std::string out;
};
int join(const JoinFlags& flags);

struct ReportFlags {
    std::string file, out;  // out "": beside the file
};
int report(const ReportFlags& flags);

struct FilmFlags {
    std::string file;
    std::vector<std::string> overrides;  // PATH=VALUE
    std::string size = "1080p";
    int seeds = 0;  // 0: the file's
    ExplainerOptions options;
    bool quiet = false, no_code = false;
};
int film(const FilmFlags& flags);

struct ListFlags {
    std::string what;  // "": all
};
int list(const ListFlags& flags);

struct SchemaFlags {
    bool json = false;
};
int schema(const SchemaFlags& flags);

struct CheckFlags {
    std::string arm;  // "": all built-in arms; an experiment: `sampler` is an arm of it
    std::string sampler;
    std::vector<std::string> settings;            // s=128
    int neighbours = 0;                           // 0: the default
    std::map<std::string, std::string> samplers;  // by the name of a SamplerFlag
    std::string samples, table;
    std::map<std::string, std::vector<std::string>> shader;  // options of a shader, by flag
    std::string over;                                        // NAME=VALUES of a shader
    std::string domain;               // of a shader, of --samples, or of a program that states none
    std::string estimates;            // the expected value of an estimator of a number, one or three expressions
    std::string against;              // a built-in arm, a Python file, a shader, a plugin or a program
    std::vector<std::string> expect;  // waivers, files of them, or "same": with against, a difference fails
    std::vector<std::string> wo;      // x,y,z or degrees
    std::string json, html;           // files to write
    ReportFiles reports;
    std::string repro;                  // a script to write
    double alpha = 1e-3, patience = 0;  // patience: s for a program; 0: two minutes, with --full an hour
    double timeout = 0;                 // s per response of a program or plugin; 0: the defaults
    unsigned seed = 1;
    int pixels = 0;  // of an experiment; 0: the grid of w_o
    bool no_code = false;
    bool light = false;  // f is the radiance of a light
    bool full = false, quick = false, planted = false, quiet = false, accept_few = false, allow_inconclusive = false;
    bool verbose = false;   // prints the details and the cost
    bool describe = false;  // describes the distribution of the draws, without a verdict

    /// The value of the SamplerFlag of this name; "": it is not given.
    std::string sampler_of(const std::string& name) const {
        const auto value = samplers.find(name);
        return value == samplers.end() ? "" : value->second;
    }
    std::string exec() const { return sampler_of("exec"); }
};
int check(const CheckFlags& flags);

struct CompareFlags {
    std::string file, out;                                      // "": none; out/compare
    std::vector<std::string> arms, reference, regions, masks;   // NAME=FILES, FILES, NAME=x0,y0,x1,y1, NAME=FILE
    std::vector<std::string> layers, spp, seconds, assertions;  // [NAME=]LAYER, [NAME=]N, [NAME=]S, a check
    std::string encoding, space, channels, channel;             // of the files; "": the file's
    std::string align, expect, smallest, exposure, alpha, trim, brightest, theme;  // "": the file's
    bool crop = false, pair = false, schema = false, schema_as_json = false, quiet = false;
    // Of a suite.
    std::string baseline, candidate;  // folders; "": the file's patterns
    std::string json, markdown;       // files to write
    ReportFiles reports;
    bool allow_inconclusive = false;  // too few renders do not fail
    std::string because, store;       // of accept
    std::string tolerance;            // of views without noise; "": the file's
    std::vector<std::string> views;   // to accept; empty: all
    bool new_baseline = false, plan = false, accept = false;
    // Of renders that are made here.
    std::string render, a, b;             // commands
    std::string until, budget, timeout;   // "decided"; times such as 10min
    std::vector<std::string> made_views;  // of a and b
    int jobs = 1;
    bool makes_both_sides() const { return !a.empty() || !b.empty(); }
    bool makes_renders() const { return !render.empty() || makes_both_sides(); }
};
int compare(const CompareFlags& flags);
/// Splits "NAME=VALUE" of a flag; `what` is used in the error message.
std::pair<std::string, std::string> name_and_value(const std::string& flag, const std::string& text, const char* what);
/// "0.04" of "4 %", as TOML; another text as it is.
inline std::string number_of_share(std::string text) {
    if (!text.ends_with('%')) return text;
    text.pop_back();
    text.resize(text.find_last_not_of(' ') + 1);
    return text + "e-2";
}

/// The keys that say how files are read, with the values of their flags ("": not given).
inline std::array<std::pair<const char*, std::string>, 4> reading_keys(const CompareFlags& f) {
    return {{{"encoding", f.encoding}, {"space", f.space}, {"channels", f.channels}, {"channel", f.channel}}};
}
/// `crescent compare SUITE.toml`, and --baseline DIR --candidate DIR.
int compare_suite(const CompareFlags& flags);
/// Makes the renders of a suite, or those of two commands, and decides; the outputs are those of a suite.
SuiteResult make_renders_of(const CompareFlags& flags, Suite& suite, Progress& progress);
/// The suite of --a and --b. Throws InputError.
Suite suite_of_two(const CompareFlags& flags, std::vector<CompareFlag> keys);

struct ImportFlags {
    std::string file, out, material;  // "": all materials
    std::string select, up = "y";     // select: a mesh, node or material; "": all
    std::string sky;                  // of the experiment in a folder; "": a disk light
    std::string layer;                // of the sky or of an image; "": its first part
    std::optional<double> smooth;     // degrees; none: normals as they are
    double scale = 1;
    double timeout = 300;  // s
    int memory_mib = 4096;
};
int import(const ImportFlags& flags);

struct VersionFlags {};
int version(const VersionFlags& flags);

/// Writes to stdout and checks that all was written. A closed pipe is not an error; any other failure throws
/// OutputError.
void print(const std::string& text);
/// Writes to stderr. In both, no control character in a name, a file or a word reaches the terminal.
void print_to_stderr(const std::string& text);
/// Like print(), with the control characters of a text that the caller has made safe.
void print_as_it_is(const std::string& text);

}  // namespace crescent::cli
