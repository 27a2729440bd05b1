// The identity of an experiment, computed from its values: the text that contains all of them, and the hash of that
// text.
#include "experiment/identity.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <charconv>
#include <cmath>

#include "experiment/input_files.h"
#include "experiment/published.h"
#include "experiment/schema.h"
#include "experiment/schema_table.h"

namespace crescent {

std::string toml_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (byte < 0x20 || byte == 0x7f) out += fmt::format("\\u{:04x}", byte);
        else out += c;
    }
    return out + '"';
}

namespace {

/// Returns the shortest text that is read as the same double. TOML's integer -0 is 0.
std::string number(double x) { return x == 0 && std::signbit(x) ? "-0.0" : fmt::format("{}", x); }

std::string list(const std::vector<double>& values) {
    std::string out;
    for (const double x : values) out += (out.empty() ? "" : ", ") + number(x);
    return "[" + out + "]";
}

std::string toml(const Key& key, const Value& value) {
    switch (key.type) {
        case Type::flag: return value.flag ? "true" : "false";
        case Type::integer:
        case Type::number: return number(value.number);
        case Type::word: return toml_text(key.words[static_cast<std::size_t>(value.word)]);
        case Type::text:
        case Type::check:
        case Type::sampler:
        case Type::arm:
        case Type::shape: return toml_text(value.text);
        case Type::formulas: {
            std::string out;
            for (const std::string& text : value.texts) {
                double x = 0;
                const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
                const bool is_number = error == std::errc{} && end == text.data() + text.size();
                out += (out.empty() ? "" : ", ") + (is_number ? number(x) : toml_text(text));
            }
            return "[" + out + "]";
        }
        case Type::texts: {
            std::string out;
            for (const std::string& text : value.texts) out += (out.empty() ? "" : ", ") + toml_text(text);
            return "[" + out + "]";
        }
        case Type::factors:
        case Type::gray: return value.numbers.size() == 1 ? number(value.numbers[0]) : list(value.numbers);
        default: return list(value.numbers);
    }
}

/// A number of 0 and an empty list represent an optional key that was not given.
bool is_given(const Key& key, const Value& value) {
    if (key.type == Type::sampler) return !value.text.empty();
    if (key.type == Type::integers || key.type == Type::numbers || key.type == Type::counts)
        return !value.numbers.empty();
    if (key.type == Type::formulas || key.type == Type::texts) return !value.texts.empty();
    if (key.need != Requirement::optional) return true;
    return (key.type != Type::integer && key.type != Type::number) || value.number != 0;
}

class Writer {
public:
    explicit Writer(const Experiment& experiment) : experiment_(experiment) {}

    std::string operator()() {
        table(schema(), &experiment_, "");
        return std::move(text_);
    }

private:
    std::vector<std::pair<std::string_view, std::string>> keys(const Section& section, const void* object) const {
        std::vector<std::pair<std::string_view, std::string>> out;
        const std::string kind = kind_of(section, object);
        for (const Key& key : section.keys)
            if (Value value; has_kind(key, kind) && key.slot.load(object, value) && is_given(key, value))
                out.emplace_back(key.name, toml(key, value));
        return out;
    }

    static std::string kind_of(const Section& section, const void* object) {
        Value value;
        const Key* key = section.find_key("kind");
        return key && key->slot.load(object, value) ? key->words[static_cast<std::size_t>(value.word)] : "";
    }

    /// An s that a surface inherits is written as a comment: it is read without one and inherits it again.
    static bool is_inherited(const Section& section, const void* object) {
        if (section.name == "shapes") return static_cast<const Shape*>(object)->material.inherits_s;
        return section.name == "meshes" && static_cast<const MeshObject*>(object)->material.inherits_s;
    }

    void table(const Section& section, const void* object, const std::string& path) {
        if (!path.empty()) text_ += fmt::format("[{}]\n", path);
        const bool inherits = is_inherited(section, object);
        for (const auto& [key, value] : keys(section, object))
            text_ += fmt::format("{}{} = {}\n", inherits && key == "s" ? "# inherited: " : "", key, value);
        for (const Section& sub : section.sections)
            if (sub.many == Multiplicity::list) tables_in_a_list(sub, object);
        for (const Section& sub : section.sections)
            if (sub.many != Multiplicity::list) family(sub, object, path);
    }

    void family(const Section& section, const void* parent, const std::string& path) {
        const std::string full_path =
            path.empty() ? std::string(section.name) : fmt::format("{}.{}", path, section.name);
        if (!section.family.add) return table(section, parent, full_path);
        for (std::size_t i = 0; i < section.family.size(parent); ++i) {
            const void* object = section.family.at(parent, i);
            table(section, object,
                section.many == Multiplicity::one
                    ? full_path
                    : fmt::format("{}.{}", full_path, toml_text(section.family.name(object))));
        }
    }

    void tables_in_a_list(const Section& section, const void* parent) {
        std::string entries;
        for (std::size_t i = 0; i < section.family.size(parent); ++i) {
            std::string entry;
            for (const auto& [key, value] : keys(section, section.family.at(parent, i)))
                entry += fmt::format("{}{} = {}", entry.empty() ? "" : ", ", key, value);
            entries += fmt::format("{}{{{}}}", entries.empty() ? "" : ", ", entry);
        }
        text_ += fmt::format("{} = [{}]\n", section.name, entries);
    }

    const Experiment& experiment_;
    std::string text_;
};

/// Returns every published value, so that other content of the same file is another experiment.
std::string text_of(const Published& published) {
    std::string out =
        fmt::format("{} {}\n", toml_text(published.source), published.seed ? std::to_string(*published.seed) : "");
    for (const auto& [key, value] : published.runs) {
        const auto& [arm, n, s, metric] = key;
        out += fmt::format("{} {} {} {} {}\n", toml_text(arm), n, s, toml_text(metric), value);
    }
    for (const auto& [name, value] : published.furnaces) out += fmt::format("{} {}\n", toml_text(name), value);
    return out;
}

}  // namespace

std::string canonical_text(const Experiment& experiment) { return Writer(experiment)(); }

std::uint64_t hash(const Experiment& experiment) {
    Experiment normal_form = experiment;
    normal_form.seeds = 1;                                  // a longer series is more of the same experiment
    if (experiment.figures) normal_form.published.reset();  // their content counts, not their path
    if (experiment.sky && experiment.sky->content) {
        normal_form.sky->file.clear();
        normal_form.sky->layer.reset();
    }
    for (MeshObject& mesh : normal_form.meshes) {
        const std::optional<std::string> content = mesh.pack ? content_of(mesh) : mesh.content;
        if (!content) continue;
        mesh.file = *content;
        mesh.content.reset();
        for (const TextureKey& key : texture_keys) (mesh.*key.texture).file.reset();
    }
    std::string text = canonical_text(normal_form);
    if (experiment.figures) text += text_of(*experiment.figures);
    text += sampler_file_hashes(experiment);
    if (experiment.s_of != (experiment.exponent ? experiment.exponent->shape : ""))  // made in code: no key says it
        text += toml_text(experiment.s_of);
    return XXH3_64bits(text.data(), text.size());
}

}  // namespace crescent
