// A table of keys, each with what it takes, from which the messages are made too. The name is all that stands before
// the first word with '='.
#include "subjects/pipe_greeting.h"

#include <array>
#include <charconv>
#include <fmt/format.h>
#include <functional>
#include <set>
#include <vector>

#include "base/hint.h"
#include "base/text.h"
#include "subjects/pipe_text.h"

namespace crescent::inline subjects {

namespace {

bool one_of(std::string_view value, std::initializer_list<std::string_view> words, int& which) {
    which = 0;
    for (std::string_view w : words) {
        if (w == value) return true;
        ++which;
    }
    return false;
}

bool whole_number(std::string_view value, int low, int high, int& out) {
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), out);
    return error == std::errc{} && end == value.data() + value.size() && out >= low && out <= high;
}

/// One index, or one a channel, separated by commas.
bool indices(std::string_view value, std::optional<Vec3d>& out) {
    std::vector<double> v;
    std::string text(value);
    for (char& c : text)
        if (c == ',') c = ' ';
    for (std::string_view rest = text; !blank(rest);) {
        v.emplace_back();
        if (!take_float(rest, v.back()) || !(v.back() > 0) || !(v.back() < 1e6)) return false;
    }
    if (v.size() != 1 && v.size() != 3) return false;
    out = v.size() == 1 ? Vec3d{v[0], v[0], v[0]} : Vec3d{v[0], v[1], v[2]};
    return true;
}

struct GreetingKey {
    const char* name;
    const char* values;
    std::function<bool(std::string_view, Greeting&)> read;
};

const std::array<GreetingKey, 14>& keys() {
    using S = std::string_view;
    static const std::array<GreetingKey, 14> all = {{
        {"u", "a whole number from 1 to 8",
            [](S v, Greeting& g) { return whole_number(v, 1, Numbers::most, g.traits.numbers); }},
        {"domain", "hemisphere or sphere",
            [](S v, Greeting& g) {
                g.hemisphere = v == "hemisphere";
                return g.hemisphere || v == "sphere";
            }},
        {"wo", "upper, both or none",
            [](S v, Greeting& g) {
                int which = 0;
                const bool known = one_of(v, {"upper", "both", "none"}, which);
                g.traits.wo = which == 1 ? Traits::Asked::both
                    : which == 2         ? Traits::Asked::none
                                         : Traits::Asked::upper;
                return known;
            }},
        {"channels", "1 or 3",
            [](S v, Greeting& g) { return whole_number(v, 1, 3, g.traits.channels) && g.traits.channels != 2; }},
        {"weight", "yes or no", [](S v, Greeting& g) { return (g.weight = v == "yes") || v == "no"; }},
        {"delta", "yes or no", [](S v, Greeting& g) { return (g.delta = v == "yes") || v == "no"; }},
        {"pdf", "yes or no", [](S v, Greeting& g) { return (g.traits.has_pdf = v == "yes") || v == "no"; }},
        {"f", "cos or nocos", [](S v, Greeting& g) { return (g.f_cos = v == "cos") || v == "nocos"; }},
        {"eta", "a number over 0 and under 1e6, or three separated by commas",
            [](S v, Greeting& g) { return indices(v, g.traits.eta); }},
        {"transport", "radiance or importance",
            [](S v, Greeting& g) { return (g.traits.importance = v == "importance") || v == "radiance"; }},
        {"reciprocal", "yes or no", [](S v, Greeting& g) { return (g.traits.reciprocal = v == "yes") || v == "no"; }},
        {"random", "own or given", [](S v, Greeting& g) { return (g.traits.own_random = v == "own") || v == "given"; }},
        {"real", "f32 or f64",
            [](S v, Greeting& g) {
                g.traits.bits = v == "f32" ? 24 : 53;
                return v == "f32" || v == "f64";
            }},
        {"block", "f64", [](S v, Greeting& g) { return (g.blocks = v == "f64"); }},
    }};
    return all;
}

GreetingFault unknown(std::string_view name) {
    std::vector<std::string> known;
    for (const GreetingKey& k : keys()) known.emplace_back(k.name);
    return {fmt::format("one of {} before the '='", fmt::join(known, ", ")),
        fmt::format("got the unknown key {}{}", shown(name), did_you_mean(name, known))};
}

GreetingFault read_key(std::string_view word, Greeting& out) {
    const std::size_t equals = word.find('=');
    const std::string_view name = word.substr(0, equals), value = equals == word.npos ? "" : word.substr(equals + 1);
    if (equals == word.npos) return {"KEY=VALUE", fmt::format("got the word {} after the keys", shown(word))};
    for (const GreetingKey& k : keys()) {
        if (name != k.name) continue;
        if (k.read(value, out)) return {};
        return {fmt::format("{} for {}", k.values, k.name), "got " + shown(value)};
    }
    return unknown(name);
}

}  // namespace

GreetingFault read_greeting(std::string_view answer, Greeting& out) {
    const std::string form = "'hello 2 NAME [KEY=VALUE]...' or 'hello 1 NAME'";
    const bool one = answer.starts_with("hello 1 "), two = answer.starts_with("hello 2 ");
    if ((!one && !two) || blank(answer.substr(8))) return {form, "got " + shown(answer) + only_answers};
    out.protocol = one ? 1 : 2;
    std::string_view rest = answer.substr(8), name = rest;
    const std::size_t key = two ? rest.find('=') : rest.npos;
    if (key != rest.npos) {
        const std::size_t before = rest.find_last_of(" \t", key);
        if (before == rest.npos || blank(rest.substr(0, before))) return {form, "got no name in " + shown(answer)};
        name = rest.substr(0, before);
        rest = rest.substr(before);
        std::set<std::string_view> seen;
        while (!blank(rest)) {
            rest.remove_prefix(rest.find_first_not_of(" \t"));
            const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
            if (const GreetingFault fault = read_key(rest.substr(0, end), out); fault) return fault;
            const std::string_view name_of_key = rest.substr(0, rest.find('='));
            if (!seen.insert(name_of_key).second)
                return {"each key once", fmt::format("got the key {} twice", shown(name_of_key))};
            rest.remove_prefix(end);
        }
    }
    name.remove_prefix(name.find_first_not_of(" \t"));
    while (name.ends_with(' ') || name.ends_with('\t')) name.remove_suffix(1);
    out.name = printable(name, 60);
    if (out.delta && !out.weight)
        return {"weight=yes beside delta=yes, since a draw of a delta part needs its weight", "got no weight=yes"};
    out.traits.delta = out.delta;
    return {};
}

}  // namespace crescent::inline subjects
