// Shared by the files of the command line's grammar: a command is added to the parser together with its implementation.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "commands.h"

namespace crescent::cli {

using Work = std::function<int()>;

/// A command that fills in Flags and then runs `perform`.
template <class Flags> CLI::App* command(CLI::App& app, Work& work, const char* name, const char* means,
    int (*perform)(const Flags&), std::shared_ptr<Flags>& flags) {
    flags = std::make_shared<Flags>();
    CLI::App* sub = app.add_subcommand(name, means);
    sub->callback([&work, flags, perform] { work = [flags, perform] { return perform(*flags); }; });
    return sub;
}

/// Returns what is wrong with the text of a flag, "" if nothing: it is empty; it is not a number of seconds from 0 to
/// 1e9.
std::string not_empty(const std::string& text);
std::string seconds(const std::string& text);
/// Validators for a flag: an integer, a number, one of several words. The error states what was expected.
CLI::Validator whole_number(std::int64_t low, std::int64_t high);
CLI::Validator number(double low, double high);
CLI::Validator one_of(const std::vector<std::string>& words);

/// A flag whose value is a file; and those of the formats of reports.
void add_file(CLI::App& command, const std::string& flag, std::string& file, const char* purpose);
void add_reports(CLI::App& command, ReportFiles& files);
/// --timeout.
void timeout(CLI::App& command, double& to);

// Each adds one command; `work` receives its implementation once the parser finds it.
void add_run(CLI::App& app, Work& work);
void add_join(CLI::App& app, Work& work);
void add_report(CLI::App& app, Work& work);
void add_film(CLI::App& app, Work& work);
void add_check(CLI::App& app, Work& work);
void add_compare(CLI::App& app, Work& work);

}  // namespace crescent::cli
