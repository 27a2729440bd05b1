// The command line: its commands, the messages for a wrong call, and the manual that --help prints. The flags of the
// larger commands are in grammar_*.cpp.
#include "arguments.h"

#include <span>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <unistd.h>

#include "commands.h"
#include "crescent/crescent.h"
#include "grammar.h"

namespace crescent::cli {

std::string not_empty(const std::string& text) {
    return text.find_first_not_of(" \t") == std::string::npos ? "is empty" : "";
}

std::string seconds(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end != text.c_str() && *end == 0 && value >= 0 && value <= 1e9 ? "" : "expected seconds, 0 to 1e9";
}

CLI::Validator whole_number(std::int64_t low, std::int64_t high) {
    const std::string range = fmt::format("{} to {}", low, high);
    const auto find_mistake = [=](std::string& text) {
        std::int64_t value = 0;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool is_good = error == std::errc{} && stop == text.data() + text.size() && value >= low && value <= high;
        return is_good ? std::string()
                       : fmt::format("expected a whole number from {}, not '{}'", range, printable(text));
    };
    return {find_mistake, range, ""};
}

CLI::Validator number(double low, double high) {
    const std::string range = fmt::format("{} to {}", low, high);
    const auto find_mistake = [=](std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool is_good = end != text.c_str() && *end == 0 && value >= low && value <= high;
        return is_good ? std::string() : fmt::format("expected a number from {}, not '{}'", range, printable(text));
    };
    return {find_mistake, range, ""};
}

void add_file(CLI::App& command, const std::string& flag, std::string& file, const char* purpose) {
    command.add_option(flag, file, purpose)->type_name("FILE")->check(not_empty);
}

void add_reports(CLI::App& command, ReportFiles& files) {
    for (const ReportFormat& format : report_formats())
        add_file(command, "--" + std::string(format.name), files[format.name], format.purpose);
}

void timeout(CLI::App& command, double& to) {
    command.add_option("--timeout", to, "limit of one answer; programs 10, plugins 60")
        ->type_name("SECONDS")
        ->check(number(0.01, 1e6));
}

CLI::Validator one_of(const std::vector<std::string>& words) {
    const auto find_mistake = [=](std::string& text) {
        return std::ranges::find(words, text) != words.end() ? std::string() : expected_one_of(words, text);
    };
    return {find_mistake, "", ""};
}

namespace {

constexpr const char* footer = R"(Exit codes: 0 all holds; 1 an assertion fails (check: wrong); 2 wrong command
line or experiment file; 3 an output cannot be written, a part is missing or
(check) the sampler terminated; 4 inconclusive (check); 130 interrupted.

  crescent run experiments/gallery.toml      the published experiment
  crescent run experiments/gallery.toml --set sphere.s=64 --set seed=7
  crescent list                              what an experiment can name
  crescent schema                            every key of an experiment file)";

void add_list(CLI::App& app, Work& work) {
    std::shared_ptr<ListFlags> f;
    CLI::App* c = command(app, work, "list", "What an experiment can name.", list, f);
    c->add_option(
         "TOPIC", f->what, "arms, shapes, lights, brdfs, plates, metrics, verdicts, isas or devices; without it, all")
        ->type_name("");
}

void add_schema(CLI::App& app, Work& work) {
    std::shared_ptr<SchemaFlags> f;
    CLI::App* c = command(
        app, work, "schema", "Every key of an experiment file: type, unit, range, default, meaning.", schema, f);
    c->add_flag("--json", f->json, "as a JSON Schema");
}

void add_import(CLI::App& app, Work& work) {
    std::shared_ptr<ImportFlags> f;
    CLI::App* c = command(app, work, "import",
        "Make an experiment or a .mesh file of a model of another program, or an .image file of an image.", import, f);
    c->add_option("FILE", f->file, "a model: .obj, .ply, .glb, .gltf or .stl; or an image: .exr or .hdr")
        ->type_name("")
        ->required()
        ->check(not_empty);
    c->add_option("--out", f->out,
         "a folder for an experiment of the whole scene, or NAME.mesh: one mesh; of an image: NAME.image")
        ->type_name("OUT")
        ->required()
        ->check(not_empty);
    c->add_option("--material", f->material, "the triangles of one material of the model")
        ->type_name("NAME")
        ->check(not_empty);
    c->add_option("--select", f->select, "what has this name: a mesh, a node with all below it, or a material")
        ->type_name("NAME")
        ->check(not_empty);
    c->add_option("--up", f->up, "the axis of the model that is up: y or z")
        ->type_name("AXIS")
        ->check(one_of({"y", "z"}));
    c->add_option("--scale", f->scale, "factor of all lengths")->type_name("X")->check(number(1e-12, 1e12));
    c->add_option(
         "--smooth", f->smooth, "smooth normals over edges of up to so many degrees, for parts without normals")
        ->type_name("DEG")
        ->check(number(0, 180));
    c->add_option("--sky", f->sky, "the sky of the experiment in a folder; without it, a disk light")
        ->type_name("FILE")
        ->check(not_empty);
    c->add_option("--layer", f->layer, "the layer of the sky, or of an image, in OpenEXR; default: the first part")
        ->type_name("NAME")
        ->check(not_empty);
    c->add_option("--memory", f->memory_mib, "limit of the importer")
        ->type_name("MIB")
        ->check(whole_number(64, 1 << 20));
    c->add_option("--timeout", f->timeout, "limit of the importer")->type_name("SECONDS")->check(number(0.01, 1e6));
    c->footer(R"(Prints what was found, and the tables [camera] and [meshes.NAME] of an experiment
in which the whole model is seen. The importer is a process of its own; a model
that it cannot read, or dies of, is an error of the input (exit code 2). Exit code
3: this build has no importer. An image becomes a pack of the same texels,
which skies and textures can name in its place: a page reads packs only.)");
}

void add_version(CLI::App& app, Work& work) {
    std::shared_ptr<VersionFlags> f;
    command(app, work, "version", "Version, commit and compiler.", version, f);
    app.add_flag_callback("--version", [] { throw CLI::CallForVersion("", 0); }, "Version, commit and compiler.");
}

/// Replaces this process by the program `crescent-sweep` of the Python package, from the PATH, with the words after the
/// command.
int sweep(char** argv) {
    for (const int ignored : {SIGPIPE, SIGXFSZ}) std::signal(ignored, SIG_DFL);
    char name[] = "crescent-sweep";
    argv[1] = name;
    ::execvp(name, argv + 1);
    print_to_stderr(errno == ENOENT
            ? "crescent sweep: no crescent-sweep in the PATH: pip install 'crescent-bench[sweep]'\n"
            : fmt::format("crescent sweep: cannot start crescent-sweep: {}\n", std::strerror(errno)));
    return unwritable;
}

/// Returns the commands if none was chosen, else the flags of the chosen one.
std::vector<std::string> words(const CLI::App& command, bool flags = true) {
    std::vector<std::string> out;
    for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
        out.push_back(sub->get_name());
    if (!flags) return out;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
    return out;
}

/// Returns the message for a word that a command does not accept.
std::string unexpected(const CLI::App& command, const std::string& word) {
    const std::string quoted_word = "'" + printable(word) + "'";
    const std::string suggestion = did_you_mean(word.substr(0, word.find('=')), words(command));
    if (word.starts_with('-')) return "no flag " + quoted_word + suggestion;
    if (!command.get_subcommands([](const CLI::App*) { return true; }).empty())
        return fmt::format(
            "no command {}: expected one of {}{}", quoted_word, fmt::join(words(command, false), ", "), suggestion);
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional())
            return fmt::format("takes one {}, and {} is a second one", option->get_name(true), quoted_word);
    return fmt::format("takes flags alone, and {} is none{}", quoted_word, suggestion);
}

/// Returns the parser's error in two lines, with the nearest valid word for an unknown one.
std::string misuse(const CLI::App& app, const CLI::ParseError& error) {
    const auto subcommands = app.get_subcommands();
    const CLI::App& command = subcommands.empty() ? app : *subcommands.front();
    const std::string name = subcommands.empty() ? "crescent" : "crescent " + command.get_name();
    std::string text = name + ": " + error.what();
    const std::vector<std::string> extra = app.remaining(true);
    if (dynamic_cast<const CLI::ExtrasError*>(&error) && !extra.empty()) {
        text = name + ": " + unexpected(command, extra.front());
    }
    return text + "\n`" + name + " --help` lists its flags\n";
}

Work print_text(std::FILE* to, const std::string& text, int code) {
    return [=] {
        if (to == stdout) print(text);
        else print_to_stderr(text);
        return code;
    };
}

/// Returns whether a flag that may have no value has an empty one: CLI11 does not tell them apart.
bool has_empty_value(std::span<char*> arguments, std::string_view flag) {
    bool is_after_flag = false;
    for (const std::string_view argument : arguments) {
        if (argument == std::string(flag) + "=" || (is_after_flag && argument.empty())) return true;
        if (argument.starts_with('-')) is_after_flag = argument == flag;
    }
    return false;
}

}  // namespace

std::function<int()> parse(int argc, char** argv) {
    CLI::App app("Tests and benchmarks importance samplers for rendering.", "crescent");
    app.footer(footer);
    app.get_formatter()->column_width(28);
    app.require_subcommand(0, 1);
    Work work;
    add_run(app, work);
    add_join(app, work);
    add_report(app, work);
    add_film(app, work);
    add_list(app, work);
    add_schema(app, work);
    add_check(app, work);
    add_compare(app, work);
    add_import(app, work);
    app.add_subcommand("sweep", "Run an experiment over a grid, on one machine or many (Python package).");
    add_version(app, work);
    if (argc > 1 && std::string_view(argv[1]) == "sweep") return [argv] { return sweep(argv); };
    if (has_empty_value({argv, static_cast<std::size_t>(argc)}, "--accept"))
        return print_text(stderr, "--accept: expected the name of a view, found an empty one\n", misused);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return print_text(stdout, app.help(), passed);
    } catch (const CLI::CallForVersion&) {
        return [] { return version({}); };
    } catch (const CLI::ParseError& e) { return print_text(stderr, misuse(app, e), misused); }
    return work ? work : print_text(stderr, app.help(), misused);
}

}  // namespace crescent::cli
