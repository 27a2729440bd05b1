// The command line: its commands, what is said of a wrong call, and the manual that --help prints. The flags of the
// larger commands are in grammar_*.cpp.
#include "arguments.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "commands.h"
#include "crescent.h"
#include "grammar.h"

namespace crescent::cli {

std::string told(const std::string& text) {
    return text.find_first_not_of(" \t") == std::string::npos ? "is empty" : "";
}

std::string seconds(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end != text.c_str() && *end == 0 && value >= 0 && value <= 1e9 ? "" : "expected seconds, 0 to 1e9";
}

namespace {

constexpr const char* footer = R"(Exit codes: 0 all holds; 1 an assertion fails (check: wrong); 2 wrong command
line or experiment file; 3 an output cannot be written, a part is missing or
(check) the sampler broke off; 4 inconclusive (check); 130 interrupted.

  crescent run experiments/gallery.toml      the published experiment
  crescent run experiments/gallery.toml --set sphere.s=64 --set seed=7
  crescent list                              what an experiment can name
  crescent schema                            every key of an experiment file)";

void add_list(CLI::App& app, Work& work) {
    std::shared_ptr<ListFlags> f;
    CLI::App* c = command(app, work, "list", "What an experiment can name.", list, f);
    c->add_option(
         "WHAT", f->what, "arms, shapes, lights, brdfs, plates, meters, verdicts, isas or devices; without it, all")
        ->type_name("");
}

void add_schema(CLI::App& app, Work& work) {
    std::shared_ptr<SchemaFlags> f;
    CLI::App* c = command(
        app, work, "schema", "Every key of an experiment file: type, unit, range, default, meaning.", schema, f);
    c->add_flag("--json", f->json, "as a JSON Schema");
}

void add_version(CLI::App& app, Work& work) {
    std::shared_ptr<VersionFlags> f;
    command(app, work, "version", "Version, commit and compiler.", version, f);
    app.add_flag_callback("--version", [] { throw CLI::CallForVersion("", 0); }, "Version, commit and compiler.");
}

/// Commands where none was chosen, else the flags of the chosen one.
std::vector<std::string> words(const CLI::App& command) {
    std::vector<std::string> out;
    for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
        out.push_back(sub->get_name());
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
        const bool second = command.get_name() == "list" && !extra.front().starts_with('-');
        text = second
            ? name + ": takes one topic, and '" + extra.front() + "' is a second one"
            : name + ": no '" + extra.front() + "' here" + (near.empty() ? "" : "; did you mean '" + near + "'?");
    }
    return text + "\n`" + name + " --help` says what it takes\n";
}

Work answer(std::FILE* to, const std::string& text, int code) {
    return [=] {
        if (to == stdout) print(text);
        else print_to_stderr(text);
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
    } catch (const CLI::CallForHelp&) { return answer(stdout, app.help(), held); } catch (const CLI::CallForVersion&) {
        return [] { return version({}); };
    } catch (const CLI::ParseError& e) { return answer(stderr, misuse(app, e), misused); }
    return work ? work : answer(stderr, app.help(), misused);
}

}  // namespace crescent::cli
