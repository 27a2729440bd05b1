// The one table of an experiment file: every key with its type, unit, range, default and meaning, and where its value
// goes. The reader, `crescent schema`, the overrides and the nearest-word hints all walk this table.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "experiment/experiment.h"

namespace crescent {

enum class Type {
    text,   // any text on one line
    check,  // a comparison of quantities, see experiment/quantity_text.h
    word,   // one of Key::words
    flag,   // true or false
    integer,
    number,
    point,      // 3 numbers x, y, z
    direction,  // a unit vector
    color,      // 3 numbers r, g, b, linear Rec.709
    numbers,    // ascending, a bare number is a list of one
    integers,   // ascending, a bare integer is a list of one
    box,        // pixels x0, y0, x1, y1, both ends inclusive, origin bottom-left
    sampler,
    arm,
    shape  // the name of one
};

/// Bounds of a number or of every number in a list.
struct Range {
    double low = 0, high = 0;
    bool low_open = false, high_open = false;
    bool holds(double x) const { return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high); }
};
std::string to_string(const Range& range);

enum class Need { required, optional, defaulted };

/// A checked value on its way from the file into an Experiment; which field counts follows from the type.
struct Value {
    bool flag = false;
    int word = 0;       // index into Key::words; flag is set where it is not the first
    double number = 0;  // integer as well: exact up to 2^53
    std::vector<double> numbers;
    std::string text;
};

struct Key {
    std::string_view name;
    Type type;
    Range range;
    std::string_view unit;
    Need need;
    std::string_view fallback;  // TOML of the default, or in words where it depends on other keys
    std::string_view means;
    void (*store)(void* object, const Value& value);
    std::vector<std::string> words = {};
    std::string_view kinds = {};  // the kinds of shape that have this key; empty: all
};

enum class Many {
    one,     // [camera]
    named,   // [shapes.NAME]; names are file-safe
    titled,  // [assertions."any text"], or a list whose tables have a key 'name'
    list,    // [[plates.NAME.runs]] or runs = [{...}]
};

/// A table of the file, or a family of tables under names of the user's choice.
struct Section {
    std::string_view name;
    Many many;
    Need need;
    std::string_view means;
    void* (*add)(void* parent, const std::string& name, const Place& at);
    std::vector<Key> keys;
    std::vector<Section> sections;

    const Key* find_key(std::string_view key) const;
    const Section* find_section(std::string_view section) const;
};

/// The whole file.
const Section& schema();

/// Whether a key belongs to this kind of shape; an empty kind (not known yet) has every key.
bool has_kind(const Key& key, std::string_view kind);

/// "a number above 0 (m)": what a key takes, for messages and for the manual.
std::string expectation(const Key& key);

/// "a, b, c".
template <class T> std::string listed(const std::vector<T>& all, std::string_view between = ", ") {
    std::string text;
    for (const T& one : all) (text += text.empty() ? std::string_view() : between) += fmt::to_string(one);
    return text;
}

/// The valid words of a section, for hints: keys of this kind and sections.
std::vector<std::string> words_of(const Section& section, std::string_view kind = {});

// --- from a Value into a member ---------------------------------------------------------------------------------

inline void assign(double& to, const Value& v) { to = v.number; }
inline void assign(bool& to, const Value& v) { to = v.flag; }
inline void assign(std::string& to, const Value& v) { to = v.text; }
inline void assign(Vec3d& to, const Value& v) { to = {v.numbers[0], v.numbers[1], v.numbers[2]}; }
inline void assign(Rgb& to, const Value& v) { to = {v.numbers[0], v.numbers[1], v.numbers[2]}; }
inline void assign(std::vector<double>& to, const Value& v) { to = v.numbers; }
inline void assign(std::vector<std::uint64_t>& to, const Value& v) { to.assign(v.numbers.begin(), v.numbers.end()); }
inline void assign(Box& to, const Value& v) {
    const auto at = [&](int i) { return static_cast<int>(v.numbers[static_cast<std::size_t>(i)]); };
    to = {at(0), at(1), at(2), at(3)};
}
template <class T> requires(std::is_integral_v<T> && !std::is_same_v<T, bool>) void assign(T& to, const Value& v) {
    to = static_cast<T>(v.number);
}
template <class T> requires std::is_enum_v<T> void assign(T& to, const Value& v) { to = static_cast<T>(v.word); }
template <class T> void assign(std::optional<T>& to, const Value& v) { assign(to.emplace(), v); }

template <class T> struct OwnerOf;
template <class T, class C> struct OwnerOf<T C::*> {
    using type = C;
};

/// Stores into a member, or a member of a member: to<&Shape::material, &Material::rho_s>.
template <auto First, auto... Rest> void to(void* object, const Value& value) {
    auto& owner = *static_cast<typename OwnerOf<decltype(First)>::type*>(object);
    if constexpr (sizeof...(Rest) == 0) assign(owner.*First, value);
    else to<Rest...>(&(owner.*First), value);
}

template <class T> T* make_room(T& member) { return &member; }
template <class T> T* make_room(std::optional<T>& member) { return &member.emplace(); }
template <class T> T* make_room(std::vector<T>& member) { return &member.emplace_back(); }

/// The object that a section's keys are stored into: the member itself, or a new element of it.
template <auto M> void* in(void* parent, const std::string& name, const Place& at) {
    auto* object = make_room(static_cast<typename OwnerOf<decltype(M)>::type*>(parent)->*M);
    if constexpr (requires { object->name; }) object->name = name;
    if constexpr (requires { object->at; }) object->at = at;
    return object;
}

}  // namespace crescent
