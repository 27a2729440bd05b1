// JSON against a JSON Schema (2020-12), for the keywords that docs/metrics.schema.json uses. An unknown keyword is a
// complaint too, so that the schema cannot say more than is checked.
#pragma once

#include <algorithm>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

namespace crescent::testing {

class SchemaCheck {
public:
    using Json = nlohmann::json;
    explicit SchemaCheck(Json schema) : root_(std::move(schema)) {}

    /// "" where `value` fits, else the first thing that does not.
    std::string complaint(const Json& value) const { return check(root_, value, "$"); }

private:
    static bool is(const std::string& type, const Json& v) {
        if (type == "integer") return v.is_number_integer();
        if (type == "number") return v.is_number();
        return type == v.type_name();
    }

    std::string check(const Json& schema, const Json& v, const std::string& at) const {
        for (const auto& [key, rule] : schema.items()) {
            const std::string say = keyword(schema, key, rule, v, at);
            if (!say.empty()) return say;
        }
        return {};
    }

    std::string keyword(
        const Json& schema, const std::string& key, const Json& rule, const Json& v, const std::string& at) const {
        static const std::set<std::string> words{"$schema", "title", "description", "$defs"};
        if (words.count(key)) return {};
        if (key == "$ref") return check(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), v, at);
        if (key == "type") return is(rule, v) ? "" : at + ": not a " + rule.get<std::string>();
        if (key == "const") return v == rule ? "" : at + ": not " + rule.dump();
        if (key == "enum")
            return std::find(rule.begin(), rule.end(), v) != rule.end() ? "" : at + ": none of " + rule.dump();
        if (key == "minimum") return !v.is_number() || v >= rule ? "" : at + ": below " + rule.dump();
        if (key == "minItems") return v.size() >= rule.get<std::size_t>() ? "" : at + ": too short";
        if (key == "maxItems") return v.size() <= rule.get<std::size_t>() ? "" : at + ": too long";
        if (key == "anyOf") return any_of(rule, v, at);
        if (key == "items") return items(rule, v, at);
        if (key == "required") return required(rule, v, at);
        if (key == "properties") return properties(rule, v, at);
        if (key == "additionalProperties") return additional(schema, rule, v, at);
        return "the check does not know the keyword " + key;
    }

    std::string any_of(const Json& all, const Json& v, const std::string& at) const {
        for (const Json& one : all)
            if (check(one, v, at).empty()) return {};
        return at + ": fits none of anyOf";
    }
    std::string items(const Json& rule, const Json& v, const std::string& at) const {
        for (std::size_t i = 0; v.is_array() && i < v.size(); ++i)
            if (const std::string say = check(rule, v[i], at + "[" + std::to_string(i) + "]"); !say.empty()) return say;
        return {};
    }
    std::string required(const Json& names, const Json& v, const std::string& at) const {
        for (const Json& name : names)
            if (!v.contains(name.get<std::string>())) return at + ": lacks " + name.get<std::string>();
        return {};
    }
    std::string properties(const Json& rules, const Json& v, const std::string& at) const {
        for (const auto& [name, rule] : rules.items())
            if (v.contains(name))
                if (const std::string say = check(rule, v[name], at + "." + name); !say.empty()) return say;
        return {};
    }
    std::string additional(const Json& schema, const Json& rule, const Json& v, const std::string& at) const {
        for (const auto& [name, value] : v.items()) {
            if (schema.contains("properties") && schema["properties"].contains(name)) continue;
            if (rule == false) return at + ": unknown " + name;
            if (const std::string say = check(rule, value, at + "." + name); !say.empty()) return say;
        }
        return {};
    }

    Json root_;
};

}  // namespace crescent::testing
