// The protocol of docs/samplers.md in a few lines of Python.
#include "repro_reach.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <sstream>

#include <fmt/format.h>

namespace crescent::cli {

namespace {

std::string python_text(const std::string& text) { return nlohmann::json(text).dump(); }

/// What takes the place of crescent for a sampler's file that imports nothing of it but Sampler; a remark if it imports
/// more; "" if it imports nothing.
std::string replaced_import(const std::filesystem::path& file) {
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    static const std::regex crescent_import("(^|\\n)[ \\t]*(import|from)[ \\t]+crescent\\b");
    static const std::regex further_use(
        "crescent\\.(?!Sampler\\b)|import[ \\t]+crescent[ \\t]+as|from[ \\t]+crescent[ \\t]+import[ "
        "\\t]+(?!Sampler[ \\t]*(\\r?\\n|$))");
    if (!std::regex_search(text, crescent_import)) return "";
    if (std::regex_search(text, further_use)) return "# The file of the sampler needs crescent.\n";
    return "from types import SimpleNamespace as Space\n"
           "def put(sample, pdf=None, f=None, **more): return Space(sample=sample, pdf=pdf, f=f, **more)\n"
           "sys.modules['crescent'] = Space(Sampler=put)  # all that the file of the sampler uses of it\n";
}

}  // namespace

Handshake handshake_with(const std::string& program) {
    Handshake out;
    const std::string command = "printf 'hello 2\\n' | (" + program + "\n) 2>/dev/null";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
    std::string line;
    for (int c = 0; pipe && (c = std::fgetc(pipe.get())) != EOF && c != '\n';) line += static_cast<char>(c);
    static_cast<void>(read_handshake(line, out));
    return out;
}

std::string ask_lines(const Handshake& hello, const std::string& program, std::size_t columns) {
    std::string out = "import subprocess, sys\nimport numpy as np\n\n\ndef ask(verb, *columns):  # the protocol of " +
        std::string(hello.blocks() ? "blocks" : "lines") + "\n    rows = np.hstack(columns)\n";
    if (hello.blocks()) {
        const std::string type = hello.single_blocks() ? "'<f4'" : "'<f8'";
        return out + "    block = verb.encode() + np.uint32(len(rows)).tobytes() + rows.astype(" + type +
            ").tobytes()\n"
            "    said = subprocess.run(" +
            python_text(program) +
            ", shell=True, input=b'hello 2\\n' + block, stdout=-1).stdout\n"
            "    return np.frombuffer(said.split(b'\\n', 1)[1][4:], " +
            type + ").reshape(len(rows), -1).astype(float)\n";
    }
    return out +
        "    lines = ['hello 2', *(' '.join([verb, *map(str, row)]) for row in rows.tolist())]\n"
        "    said = subprocess.run(" +
        python_text(program) +
        fmt::format(
            ", shell=True, text=True, input='\\n'.join(lines) + '\\n', stdout=-1).stdout\n"
            "    words = [line.replace('delta', '-').replace('- ', '-').split() for line in said.splitlines()[1:]]\n"
            "    number = lambda x: np.nan if x == '-' else float.fromhex(x) if 'x' in x else float(x)\n"
            "    return np.array([[number(x) for x in row[:{}]] for row in words])\n",
            columns);
}

std::string import_lines(const std::string& word) {
    namespace fs = std::filesystem;
    const std::size_t colon = word.ends_with(".py") ? std::string::npos : word.rfind(':');
    const std::string file = word.substr(0, colon), name = colon == std::string::npos ? "" : word.substr(colon + 1);
    std::string module = file, folder = fs::current_path().string();
    if (file.ends_with(".py")) {
        const fs::path path = fs::absolute(file).lexically_normal();
        fs::path top = path.parent_path();
        while (fs::exists(top / "__init__.py")) top = top.parent_path();
        folder = top.string();
        module = path.lexically_relative(top).replace_extension().string();
        std::ranges::replace(module, '/', '.');
    }
    std::string out = "import sys; sys.path.insert(0, " + python_text(folder) + ")\nimport numpy as np\n";
    if (file.ends_with(".py")) out += replaced_import(file);
    if (name.empty()) return out + "import " + module + " as sampler\n";
    return out + "from " + module + " import " + name +
        " as sampler\nsampler = sampler() if isinstance(sampler, type) else sampler\n";
}

std::string without_unused(const std::string& lines, const std::string& script) {
    static const std::regex definition("def (sample|pdf|f|target|weigh)\\(.*");
    std::string out;
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line);)
        if (std::smatch name; !std::regex_match(line, name, definition) ||
            std::regex_search(script, std::regex("\\b" + name[1].str() + "\\(")) ||
            (name[1] == "target" && std::regex_search(script, std::regex("\\bweigh\\("))))
            out += line + "\n";
    return out;
}

}  // namespace crescent::cli
