// crescent list: the words that an experiment and the command line can name. All of them come from the tables used by
// the rest of the program.
#include <fmt/format.h>

#include "commands.h"
#include "crescent/crescent.h"

namespace crescent::cli {

namespace {

struct Word {
    std::string word, means;
};

/// Returns the kinds of a list, such as that of shapes.
template <class Kinds> std::vector<Word> kinds() {
    std::vector<Word> out;
    for (std::size_t k = 0; k < Kinds::count; ++k)
        out.push_back({std::string(Kinds::names[k]), std::string(Kinds::summaries[k])});
    return out;
}

std::vector<Word> plates() {
    std::vector<Word> out;
    for (const PlateInfo& plate : plate_infos) out.push_back({std::string(plate.name), std::string(plate.shows)});
    return out;
}

std::vector<Word> arms() {
    std::vector<Word> out;
    for (const SamplerInfo& arm : sampler_infos()) {
        out.push_back({std::string(arm.name), std::string(arm.summary)});
        if (!arm.misses.empty()) out.back().means += fmt::format("; cannot reach {}", arm.misses);
        if (arm.techniques > 1) out.back().means += fmt::format("; {} directions a sample", arm.techniques);
    }
    return out;
}

std::vector<Word> lobes() {
    std::vector<Word> out;
    for (const LobeInfo& lobe : lobe_infos()) out.push_back({std::string(lobe.name), std::string(lobe.summary)});
    return out;
}

std::vector<Word> metrics() {
    std::vector<Word> out;
    for (const QuantityWord& word : quantity_words()) out.push_back({form_of(word), std::string(word.means)});
    return out;
}

std::vector<Word> verdicts() {
    std::vector<Word> out;
    for (std::size_t k = 0; k < verdict_names.size(); ++k)
        out.push_back({std::string(verdict_names[k]), std::string(verdict_questions[k])});
    return out;
}

std::vector<Word> instruction_sets() {
    std::vector<Word> out;
    for (const std::string& isa : isas()) out.push_back({isa, ""});
    return out;
}

/// Returns the devices that --gl-device can name, by number.
std::vector<Word> devices() {
    std::vector<Word> out;
    for (const auto& kind : backend_kinds())
        for (const BackendDevice& device : kind->devices())
            out.push_back({fmt::format("{}  {}", device.number, device.means), ""});
    return out;
}

struct Topic {
    std::string name, means;
    std::vector<Word> (*words)();
    bool by_name_alone = false;  // finding them takes a while
};
const std::vector<Topic>& topics() {
    static const std::vector<Topic> table = {
        {"arms", "built-in samplers", arms},
        {"shapes", "kinds of shape", kinds<Shapes>},
        {"lights", "kinds of light", kinds<LightKinds>},
        {"brdfs", "lobes in addition to the Lambert term", lobes},
        {"plates", "kinds of picture", plates},
        {"metrics", "quantities that a check can name", metrics},
        {"verdicts", "the tests of `check`, in this order", verdicts},
        {"isas", "instruction sets that this machine has, the best last", instruction_sets},
        {"devices", "GL devices that this machine has, by the number that --gl-device takes", devices, true},
    };
    return table;
}

std::string lines(const std::vector<Word>& words, const char* indent) {
    std::string out;
    for (const Word& w : words)
        out += indent + (w.means.empty() ? w.word : fmt::format("{:<32}  {}", w.word, w.means)) + "\n";
    return out;
}

[[noreturn]] void unknown(const std::string& what) {
    std::vector<std::string> names;
    for (const Topic& topic : topics()) names.push_back(topic.name);
    throw InputError({"crescent list", 0, 0}, expected_one_of(names, what));
}

}  // namespace

int list(const ListFlags& flags) {
    std::string out;
    bool is_known = flags.what.empty();
    for (const Topic& topic : topics()) {
        is_known = is_known || flags.what == topic.name;
        if (flags.what.empty())
            out += (out.empty() ? "" : "\n") + topic.name + ": " + topic.means + "\n" +
                (topic.by_name_alone ? "  `crescent list " + topic.name + "` queries the machine\n"
                                     : lines(topic.words(), "  "));
        if (flags.what == topic.name) out = lines(topic.words(), "");
    }
    if (!is_known) unknown(flags.what);
    print(out);
    return passed;
}

// ---- crescent schema and crescent version: descriptions of the input and of the program.

int schema(const SchemaFlags& flags) {
    print(flags.json ? schema_json() : schema_text());
    return passed;
}

int version(const VersionFlags&) {
    print("crescent " + crescent::version() + " (" + commit() + ", " + compiler() + ")\n");
    return passed;
}

}  // namespace crescent::cli
