// `crescent schema --json`: the table as a JSON Schema of draft 7, the draft that TOML editors read (Taplo, Even Better
// TOML). It contains the constraints on single values: type, range, words, the keys that a kind of shape needs. The
// parser checks constraints on several values (names that must exist, unit vectors, boxes inside the image).
#include "experiment/json_schema.h"

#include <nlohmann/json.hpp>

#include "experiment/assertion.h"
#include "experiment/combinations.h"
#include "experiment/schema.h"
#include "experiment/schema_table.h"
#include "samplers/info.h"

namespace crescent {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view name_pattern = "^[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}$";  // names become file names
constexpr int most_schema_characters = 4096, most_schema_items = 64, longest_title = 200;

/// Returns a number of the key's range; box coordinates and counts are integers.
Json number(const Key& key, bool is_whole) {
    Json out = {{"type", is_whole ? "integer" : "number"}};
    if (key.range.low == key.range.high) return out;
    const auto bound = [&](double x) { return is_whole ? Json(static_cast<std::int64_t>(x)) : Json(x); };
    out[key.range.low_open ? "exclusiveMinimum" : "minimum"] = bound(key.range.low);
    out[key.range.high_open ? "exclusiveMaximum" : "maximum"] = bound(key.range.high);
    return out;
}

Json list(const Json& item, int count) {
    return {{"type", "array"}, {"items", item}, {"minItems", count}, {"maxItems", count}};
}

/// An ascending list, or a bare number for a list of one.
Json one_or_more(const Json& item) {
    Json array = {{"type", "array"}, {"items", item}, {"minItems", 1}, {"maxItems", most_schema_items}};
    array["uniqueItems"] = true;
    return {{"anyOf", {item, array}}};
}

Json type_of(const Key& key) {
    switch (key.type) {
        case Type::text:
        case Type::check:
        case Type::arm:
        case Type::shape: return {{"type", "string"}, {"maxLength", most_schema_characters}};
        case Type::texts: return one_or_more({{"type", "string"}, {"maxLength", most_schema_characters}});
        case Type::word: return {{"type", "string"}, {"enum", key.words}};
        case Type::sampler: return {{"type", "string"}, {"enum", sampler_words()}};
        case Type::flag: return {{"type", "boolean"}};
        case Type::integer: return number(key, true);
        case Type::number: return number(key, false);
        case Type::point:
        case Type::direction:
        case Type::color: return list(number(key, false), 3);
        case Type::factors:
        case Type::gray: return {{"anyOf", {number(key, false), list(number(key, false), 3)}}};
        case Type::matrix: return list(number(key, false), 12);
        case Type::box: return list(number(key, true), 4);
        case Type::numbers: return one_or_more(number(key, false));
        case Type::integers: return one_or_more(number(key, true));
        case Type::counts:
            return {{"anyOf",
                {number(key, true),
                    {{"type", "array"}, {"items", number(key, true)}, {"minItems", 1},
                        {"maxItems", most_schema_items}}}}};
        case Type::formulas:
            return {{"type", "array"},
                {"items",
                    {{"anyOf", {{{"type", "number"}}, {{"type", "string"}, {"maxLength", most_schema_characters}}}}}},
                {"minItems", 1}, {"maxItems", most_schema_items}};
    }
    return {};
}

/// Returns what an editor shows for the key.
std::string description(const Key& key) {
    std::string text = std::string(key.means) + " Expects " + expectation(key) + ".";
    if (key.need != Requirement::required) text += " Default: " + std::string(key.default_value) + ".";
    if (key.type != Type::check) return text;
    text += " Quantities:";
    for (const QuantityWord& word : quantity_words()) text += " " + form_of(word) + ";";
    text.back() = '.';
    return text;
}

Json property(const Key& key) {
    Json out = type_of(key);
    out["description"] = description(key);
    if (key.need == Requirement::defaulted && key.type != Type::sampler)
        out["default"] = Json::parse(key.default_value);
    return out;
}

/// For tables with a key `kind`: the keys that each kind needs, and that it has no keys of other kinds.
Json kinds_of(const Section& section, const std::vector<std::string>& kinds) {
    Json rules = Json::array();
    for (const std::string& kind : kinds) {
        Json required_keys = Json::array(), foreign_keys = Json::object();
        for (const Key& key : section.keys) {
            if (!has_kind(key, kind)) foreign_keys[std::string(key.name)] = false;
            else if (key.need == Requirement::required && !key.kinds.empty()) required_keys.push_back(key.name);
        }
        rules.push_back({{"if", {{"properties", {{"kind", {{"const", kind}}}}}, {"required", {"kind"}}}},
            {"then", {{"required", required_keys}, {"properties", foreign_keys}}}});
    }
    return rules;
}

Json family(const Section& section);

Json table(const Section& section) {
    Json out = {{"type", "object"}, {"description", section.means}, {"properties", Json::object()}};
    Json required = Json::array();
    for (const Key& key : section.keys) {
        out["properties"][std::string(key.name)] = property(key);
        if (key.need == Requirement::required && key.kinds.empty()) required.push_back(key.name);
    }
    for (const Section& sub : section.sections) {
        out["properties"][std::string(sub.name)] = family(sub);
        if (sub.need == Requirement::required) required.push_back(sub.name);
    }
    out["additionalProperties"] = false;
    if (!required.empty()) out["required"] = required;
    const Key* kind = section.find_key("kind");
    const auto of_some_kinds = [](const Key& k) { return !k.kinds.empty(); };
    const bool has_kinds = std::any_of(section.keys.begin(), section.keys.end(), of_some_kinds);
    if (kind && has_kinds) out["allOf"] = kinds_of(section, kind->words);
    return out;
}

/// Returns a table, tables under names of the user's choice, or a list of tables.
Json family(const Section& section) {
    const Json entry = table(section);
    const Json array = {{"type", "array"}, {"items", entry}, {"description", section.means}};
    Json object = {{"type", "object"}, {"description", section.means}};
    switch (section.many) {
        case Multiplicity::one: return entry;
        case Multiplicity::list: return array;
        case Multiplicity::named:
            object["patternProperties"] = {{name_pattern, entry}};
            object["additionalProperties"] = false;
            if (section.need == Requirement::required) object["minProperties"] = 1;
            return object;
        case Multiplicity::titled: break;
    }
    object["additionalProperties"] = entry;  // [assertions."any text"], or a list whose tables contain their own name
    Json item = entry;
    item["properties"]["name"] = {{"type", "string"}, {"minLength", 1}, {"maxLength", longest_title}};
    item["required"].push_back("name");
    return {{"anyOf", {object, Json{{"type", "array"}, {"items", item}}}}, {"description", section.means}};
}

}  // namespace

std::string json_schema_of(const Section& root, const char* title) {
    Json out = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
    out.update(table(root));
    return out.dump(2) + "\n";
}

std::string schema_json() { return json_schema_of(schema(), "crescent experiment"); }

}  // namespace crescent
