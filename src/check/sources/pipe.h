// A sampler in another process over its stdin and stdout: a program, a Python file or a shader. The handshake starts
// with `hello 2`, and the program answers with its declaration. Requests are text lines, or blocks of numbers if the
// program declares them; docs/samplers.md has the grammar. The program ends at the end of its input.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "check/sources/external.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

inline constexpr int default_neighbours = 8;

/// Starts `command` with /bin/sh -c: a sampler whose requests are sequential, also for several callers. Throws
/// SamplerError with the request, the answer and the expected answer; InputError if the shell cannot start it, or if it
/// answers `error TEXT` to the handshake, where TEXT may begin with FILE:LINE:COLUMN; OutputError if it answers
/// `missing TEXT`. `label` is the prefix of its stderr output and of that text; "": the command. `domain`: what it
/// draws, if its handshake does not say so. `neighbours`: supplied to a program that merges reservoirs.
std::shared_ptr<const SamplerAdapter> start_pipe(const std::string& command, const PipeLimits& limits = {},
    const std::string& label = "", const std::optional<Domain>& domain = {}, int neighbours = default_neighbours);

// ---- The declaration of a program; docs/samplers.md has the keys.

inline constexpr const char* handshake_form = "'hello 2 NAME [KEY=VALUE]...'";

/// The declaration in the first line of a program.
struct Handshake {
    std::string name;
    Traits traits;
    bool hemisphere = false;         // a draw below the horizon is no sample
    bool states_wo = false;          // the key wo is given
    std::optional<Domain> domain{};  // other than directions
    bool f_cos = false;              // f includes |cos|
    bool weight = false, delta = false;
    std::size_t block_number = 0;   // bytes of a number in blocks; 0: lines
    bool memory = false;            // rows of blocks are in shared memory
    bool merge = false;             // a draw merges the reservoirs of neighbours
    std::vector<std::string> uses;  // of context_names()
    EvaluationDevice device{};
    bool blocks() const { return block_number > 0; }
    bool single_blocks() const { return block_number == sizeof(float); }
    bool uses_lights() const { return std::ranges::find(uses, "lights") != uses.end(); }
};

/// The expected handshake, and the received one; both empty if it is valid.
struct HandshakeError {
    std::string expected, answer_text;
    explicit operator bool() const { return !answer_text.empty(); }
};
/// Reads the first line of a program.
HandshakeError read_handshake(std::string_view answer, Handshake& out);

// ---- Samplers in Python files: `crescent check mine.py:sampler`, and the key `python` of an arm.

/// Whether the word is FILE.py, FILE.py:NAME or module:NAME.
bool names_python_sampler(const std::string& word);

/// Starts the Python interpreter with crescent.serve, which answers for this sampler over a pipe. The interpreter is
/// CRESCENT_PYTHON, which the installed command sets to its own, or else python3. Throws InputError if the sampler
/// cannot be loaded, OutputError if the interpreter or the package is missing.
std::shared_ptr<const SamplerAdapter> start_python_sampler(
    const std::string& word, const PipeLimits& limits, int neighbours = default_neighbours);

// ---- Samplers in shader files: `crescent check bsdf.wgsl`.

/// Whether the word is a file of WGSL, GLSL, HLSL or Slang, by its suffix.
bool names_shader(const std::string& word);

/// Starts the Python interpreter with crescent_shader, which answers for this file over a pipe; `words` are its options
/// (docs/shaders.md). Throws InputError for a mistake in the file or a snippet, with its place; OutputError if a
/// compiler, a driver or the package is missing. `shaders`: how many are open at the same time and share the processes.
std::shared_ptr<const SamplerAdapter> start_shader(
    const std::string& file, const std::vector<std::string>& words, const PipeLimits& limits, std::size_t shaders = 1);

/// The shell command that runs a Python module with these words.
std::string python_command(const std::string& module, const std::vector<std::string>& words);

}  // namespace crescent
