// `crescent schema`: the table as text of at most 80 columns. json_schema.cpp prints it for editors.
#include <fmt/format.h>

#include <utility>

#include "arms/info.h"
#include "experiment/quantity_text.h"
#include "experiment/schema.h"

namespace crescent::inline experiment {

namespace {

constexpr std::size_t columns = 80;

std::string join(const std::string& path, std::string_view name) {
    return path.empty() ? std::string(name) : fmt::format("{}.{}", path, name);
}

std::string path_of(const Section& section, const std::string& parent) {
    std::string path = join(parent, section.name);
    if (section.many == Multiplicity::named || section.many == Multiplicity::titled) path += ".NAME";
    if (section.many == Multiplicity::list) path += ".INDEX";
    return path;
}

/// Words set in lines of at most 80 columns, every line indented, the second and later ones by `hang` more.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t hang = 0) {
    std::string out, line(indent, ' ');
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string_view word = text.substr(at, end - at);
        if (line.size() > indent && line.size() + 1 + word.size() > columns)
            out += line + "\n", indent += std::exchange(hang, 0), line.assign(indent, ' ');
        if (line.size() > indent) line += ' ';
        line += word;
        at = end + 1;
    }
    return out + line + "\n";
}

std::string need_text(const Key& key) {
    if (key.need == Requirement::required) return "required";
    return fmt::format("default {}", key.default_value);
}

std::string key_text(const Key& key) {
    std::string line = fmt::format("{}: {}; {}", key.name, expectation(key), need_text(key));
    if (!key.kinds.empty()) line += "; of a " + alternatives(key.kinds);
    return wrapped(line, 2, 2) + wrapped(key.means, 6);
}

void print(const Section& section, const std::string& parent, std::string& out) {
    const std::string path = path_of(section, parent);
    if (!path.empty()) {
        const std::string header =
            section.many == Multiplicity::list ? "[[" + join(parent, section.name) + "]]" : "[" + path + "]";
        out += fmt::format("\n{}{}\n", header, section.need == Requirement::required ? "  (required)" : "");
    }
    out += wrapped(section.means, 0);
    for (const Key& key : section.keys) out += key_text(key);
    for (const Section& sub : section.sections) print(sub, path, out);
}

}  // namespace

std::string alternatives(std::string_view kinds) {
    std::string out;
    for (std::size_t at = 0; at < kinds.size();) {
        const std::size_t end = std::min(kinds.find(' ', at), kinds.size());
        if (at > 0) out += end == kinds.size() ? " or " : ", ";
        out += kinds.substr(at, end - at);
        at = end + 1;
    }
    return out;
}

std::string manual_of(const Section& root) {
    std::string out;
    print(root, "", out);
    return out;
}

std::string schema_text() {
    std::string out = manual_of(schema());
    out += "\nSamplers\n" + wrapped(listed(sampler_names(), ", "), 2);
    out += "\nQuantities of a check\n";
    for (const QuantityWord& word : quantity_words()) out += wrapped(form_of(word), 2) + wrapped(word.means, 6);
    return out;
}

}  // namespace crescent::inline experiment
