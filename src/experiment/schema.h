// The table of an experiment file: every key with its type, unit, range, default and meaning, and where its value is
// stored. The parser, `crescent schema`, the overrides and the nearest-word hints all use this table.
#pragma once

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "experiment/experiment.h"
#include "scene/body.h"

namespace crescent {

/// The smallest roughness. A lobe of 1e-4 is 1,700 steps of single precision (6e-8) wide in a direction's coordinates;
/// of 1e-5 the densities of its samples are not known to a figure, and films have pixels that are not numbers.
inline constexpr double least_alpha = 1e-4;

/// The type of a key's value.
enum class Type {
    text,   // any text on one line
    texts,  // a list of them; a bare text is a list of one
    check,  // a comparison of quantities, see experiment/assertion.h
    word,   // one of Key::words
    flag,   // true or false
    integer,
    number,
    point,      // 3 numbers x, y, z
    factors,    // a number, or 3 for x, y, z
    matrix,     // 12 numbers: 3 rows of 4
    direction,  // a unit vector
    color,      // 3 numbers r, g, b, linear Rec.709
    gray,       // a number, or 3 of a colour
    numbers,    // ascending, a bare number is a list of one
    integers,   // ascending, a bare integer is a list of one
    counts,     // integers in any order, a bare integer is a list of one
    formulas,   // numbers, or texts with formulas, see samplers/weight_formula.h
    box,        // pixels x0, y0, x1, y1, both ends inclusive, origin bottom-left
    sampler,
    arm,
    shape  // the name of one
};

/// Returns "from 0 to 1", "above 0": for messages and the manual.
std::string to_string(const Range& range);

/// Whether a key is required, optional, or has a default.
enum class Requirement { required, optional, defaulted };

/// A checked value between the file and an Experiment; its type determines which field is used.
struct Value {
    bool flag = false;
    int word = 0;       // index into Key::words; flag is set if it is not the first
    double number = 0;  // integers too: exact up to 2^53
    std::vector<double> numbers;
    std::string text;
    std::vector<std::string> texts;
};

/// Where a key's value is stored in its object: how it is written, and how it is read back (false: none was given).
struct Slot {
    void (*store)(void* object, const Value& value);
    bool (*load)(const void* object, Value& value);
};

/// A key of a table: its type, and where its value is stored.
struct Key {
    std::string_view name;
    Type type;
    Range range;
    std::string_view unit;
    Requirement need;
    std::string_view default_value;  // TOML of the default, or words if it depends on other keys
    std::string_view means;
    Slot slot;
    std::vector<std::string> words = {};
    std::string kinds = {};  // the kinds of shape that have this key; empty: all
};

/// How many objects a section represents, and how the file writes them.
enum class Multiplicity {
    one,     // [camera]
    named,   // [shapes.NAME]; names are file-safe
    titled,  // [assertions."any text"], or a list whose tables have a key 'name'
    list,    // [[plates.NAME.runs]] or runs = [{...}]
};

/// The objects of a section inside their parent. Without functions: the parent itself.
struct Family {
    void* (*add)(void* parent, const std::string& name, const SourceLocation& place) = nullptr;
    std::size_t (*size)(const void* parent) = nullptr;
    const void* (*at)(const void* parent, std::size_t index) = nullptr;
    std::string (*name)(const void* object) = nullptr;  // "" if it has none
};

/// A table of the file, or a family of tables under names of the user's choice.
struct Section {
    std::string_view name;
    Multiplicity many;
    Requirement need;
    std::string_view means;
    Family family;
    std::vector<Key> keys;
    std::vector<Section> sections;

    /// Returns null if the section itself has no key of that name.
    const Key* find_key(std::string_view key) const;
    const Section* find_section(std::string_view section) const;
};

/// Returns the manual of a table: a line or two per key, at most 80 columns.
std::string manual_of(const Section& root);

/// Returns whether a key belongs to this kind of shape; an empty kind (not known yet) has every key.
bool has_kind(const Key& key, std::string_view kind);

/// Returns "a number above 0 (m)", the values that a key accepts, for messages and for the manual.
std::string expectation(const Key& key);

/// Returns kinds separated by blanks, as in Key::kinds, as words: "sphere disk box" -> "sphere, disk or box".
std::string alternatives(std::string_view kinds);

/// Returns "a, b, c".
template <class T> std::string listed(const std::vector<T>& items, std::string_view separator = ", ") {
    std::string text;
    for (const T& item : items) (text += text.empty() ? std::string_view() : separator) += fmt::to_string(item);
    return text;
}

/// Returns the valid words of a section, for hints: keys of this kind and sections.
std::vector<std::string> words_of(const Section& section, std::string_view kind = {});

// --- from a Value into a member, and back -----------------------------------------------------------------------

/// Returns a number within the table's range as an integer.
template <class T> T whole(double x) {
    ensure(x >= static_cast<double>(std::numeric_limits<T>::min()) &&
            x <= static_cast<double>(std::numeric_limits<T>::max()),
        "the range of a key fits the type it is stored in");
    return static_cast<T>(x);
}

/// Stores a checked value in a member, by the member's type.
inline void assign(double& to, const Value& v) { to = v.number; }
inline void assign(bool& to, const Value& v) { to = v.flag; }
inline void assign(std::string& to, const Value& v) { to = v.text; }
inline void assign(std::vector<std::string>& to, const Value& v) { to = v.texts; }
inline void assign(Vec3d& to, const Value& v) { to = {v.numbers[0], v.numbers[1], v.numbers[2]}; }
inline void assign(Rgb& to, const Value& v) { to = {v.numbers[0], v.numbers[1], v.numbers[2]}; }
inline void assign(std::array<double, 12>& to, const Value& v) { std::copy_n(v.numbers.begin(), 12, to.begin()); }
inline void assign(std::vector<double>& to, const Value& v) { to = v.numbers; }
inline void assign(std::vector<std::uint64_t>& to, const Value& v) {
    to.clear();
    for (const double x : v.numbers) to.push_back(whole<std::uint64_t>(x));
}
/// Pixels x0, y0, x1, y1.
inline void assign(Box& to, const Value& v) {
    const auto number = [&](int i) { return whole<int>(v.numbers[static_cast<std::size_t>(i)]); };
    to = {number(0), number(1), number(2), number(3)};
}
template <class T>
    requires(std::is_integral_v<T> && !std::is_same_v<T, bool>)
void assign(T& to, const Value& v) {
    to = whole<T>(v.number);
}
template <class T>
    requires std::is_enum_v<T>
void assign(T& to, const Value& v) {
    to = static_cast<T>(v.word);
}
template <class T> void assign(std::optional<T>& to, const Value& v) { assign(to.emplace(), v); }

/// Reads a member back into a value; false if it holds none.
inline bool fetch(double from, Value& v) { return v.number = from, true; }
inline bool fetch(bool from, Value& v) { return v.flag = from, v.word = from, true; }
inline bool fetch(const std::string& from, Value& v) { return v.text = from, true; }
inline bool fetch(const std::vector<std::string>& from, Value& v) { return v.texts = from, true; }
inline bool fetch(const Vec3d& from, Value& v) { return v.numbers = {from.x, from.y, from.z}, true; }
inline bool fetch(const Rgb& from, Value& v) { return v.numbers.assign(from.begin(), from.end()), true; }
inline bool fetch(const std::array<double, 12>& from, Value& v) {
    return v.numbers.assign(from.begin(), from.end()), true;
}
inline bool fetch(const std::vector<double>& from, Value& v) { return v.numbers = from, true; }
inline bool fetch(const std::vector<std::uint64_t>& from, Value& v) {
    return v.numbers.assign(from.begin(), from.end()), true;
}
/// Pixels x0, y0, x1, y1.
inline bool fetch(const Box& from, Value& v) {
    v.numbers.clear();
    for (const int x : {from.x0, from.y0, from.x1, from.y1}) v.numbers.push_back(x);
    return true;
}
template <class T>
    requires(std::is_integral_v<T> && !std::is_same_v<T, bool>)
bool fetch(T from, Value& v) {
    return v.number = static_cast<double>(from), true;
}
template <class T>
    requires std::is_enum_v<T>
bool fetch(T from, Value& v) {
    return v.word = static_cast<int>(from), true;
}
template <class T> bool fetch(const std::optional<T>& from, Value& v) { return from && fetch(*from, v); }

/// The class of a pointer to member.
template <class T> struct OwnerOf;
template <class T, class C> struct OwnerOf<T C::*> {
    using type = C;
};

/// A member, or a member of a member.
template <auto First, auto... Rest> auto& member_of(auto& object) {
    if constexpr (sizeof...(Rest) == 0) return object.*First;
    else return member_of<Rest...>(object.*First);
}

/// A key stored in a member of an Owner, or in a member of a member.
template <class Owner, auto First, auto... Rest> constexpr Slot to_owner = {
    [](void* object, const Value& value) { assign(member_of<First, Rest...>(*static_cast<Owner*>(object)), value); },
    [](const void* object, Value& value) {
        return fetch(member_of<First, Rest...>(*static_cast<const Owner*>(object)), value);
    }};

/// The same if the first member's class is the object's own: to<&Shape::material, &Material::rho_s>.
template <auto First, auto... Rest> constexpr Slot to =
    to_owner<typename OwnerOf<decltype(First)>::type, First, Rest...>;

/// Returns the object that the next table is read into: the member itself, or a new element.
template <class T> T* emplaced(T& member) { return &member; }
template <class T> T* emplaced(std::optional<T>& member) { return &member.emplace(); }
template <class T> T* emplaced(std::vector<T>& member) { return &member.emplace_back(); }

/// Returns the objects that a member holds: itself, none or one, or its elements.
template <class T> std::span<const T> all_of(const T& member) { return {&member, 1}; }
template <class T> std::span<const T> all_of(const std::optional<T>& member) {
    return member ? std::span<const T>(&*member, 1) : std::span<const T>();
}
template <class T> std::span<const T> all_of(const std::vector<T>& member) { return member; }

/// Returns the objects that a section's keys are stored into: the member itself, or its elements.
template <auto M, class Owner = typename OwnerOf<decltype(M)>::type>
constexpr Family in = {.add = [](void* parent, const std::string& name, const SourceLocation& place) -> void* {
                           auto* object = emplaced(static_cast<Owner*>(parent)->*M);
                           if constexpr (requires { object->name; }) object->name = name;
                           if constexpr (requires { object->location; }) object->location = place;
                           return object;
                       },
    .size = [](const void* parent) { return all_of(static_cast<const Owner*>(parent)->*M).size(); },
    .at = [](const void* parent, std::size_t index) -> const void* {
        return &all_of(static_cast<const Owner*>(parent)->*M)[index];
    },
    .name = [](const void* object) -> std::string {
        using Object = typename decltype(all_of(std::declval<const Owner&>().*M))::value_type;
        if constexpr (requires(const Object& o) { o.name; }) return static_cast<const Object*>(object)->name;
        else return "";
    }};

// ---- Keys of tables with a `kind`: made from the parameters of each kind of a list (scene/body.h).

/// Returns the type of a key, from that of the member it is stored in.
inline Type type_of(const std::type_identity<double>&, bool) { return Type::number; }
inline Type type_of(const std::type_identity<bool>&, bool) { return Type::flag; }
inline Type type_of(const std::type_identity<Vec3d>&, bool unit) { return unit ? Type::direction : Type::point; }
inline Type type_of(const std::type_identity<std::optional<Rgb>>&, bool) { return Type::color; }

/// Returns the name of the parameter at `index`, counted through all kinds.
template <class... Kind> constexpr std::string_view parameter_name(KindList<Kind...>, std::size_t index) {
    std::string_view name;
    std::size_t k = 0;
    KindList<Kind...>::each_parameter([&](std::string_view, const auto& parameter) {
        if (k++ == index) name = parameter.name;
    });
    return name;
}
template <class... Kind> constexpr std::size_t parameter_count(KindList<Kind...>) {
    return (Kind::parameters().size() + ... + 0);
}

/// A parameter of an object of any kind; empty if its kind has no parameter of that name.
using AnyParameter = std::variant<std::monostate, double*, bool*, Vec3d*, std::optional<Rgb>*>;

/// Returns the parameter of that name of the kind that `any` holds.
template <class Any> AnyParameter parameter_named(Any& any, std::string_view name) {
    AnyParameter match;
    std::visit(
        [&](auto& kind) {
            for (const auto& parameter : std::remove_cvref_t<decltype(kind)>::parameters())
                if (parameter.name == name) std::visit([&](auto member) { match = &(kind.*member); }, parameter.member);
        },
        any);
    return match;
}
inline void assign(const AnyParameter& to, const Value& value) {
    std::visit(
        [&]<class T>(T target) {
            if constexpr (std::is_pointer_v<T>) assign(*target, value);
        },
        to);
}
inline bool fetch(const AnyParameter& from, Value& value) {
    const auto read = [&]<class T>(T target) {
        if constexpr (std::is_pointer_v<T>) return fetch(*target, value);
        else return false;
    };
    return std::visit(read, from);
}

/// The key `kind` of objects whose member Form is one of these kinds.
template <class List, auto Form> constexpr Slot kind_slot = {[](void* object, const Value& value) {
                                                                 using Owner = typename OwnerOf<decltype(Form)>::type;
                                                                 static_cast<Owner*>(object)->*Form =
                                                                     List::make(static_cast<std::size_t>(value.word));
                                                             },
    [](const void* object, Value& value) {
        using Owner = typename OwnerOf<decltype(Form)>::type;
        value.word = static_cast<int>((static_cast<const Owner*>(object)->*Form).index());
        return true;
    }};

/// The parameter at `index` of the kind that the object holds.
template <class List, auto Form, std::size_t index> constexpr Slot parameter_slot = {
    [](void* object, const Value& value) {
        using Owner = typename OwnerOf<decltype(Form)>::type;
        assign(parameter_named(static_cast<Owner*>(object)->*Form, parameter_name(List{}, index)), value);
    },
    [](const void* object, Value& value) {
        using Owner = typename OwnerOf<decltype(Form)>::type;
        // The lookup needs a mutable object; it is only read here.
        auto& form = const_cast<Owner*>(static_cast<const Owner*>(object))->*Form;
        return fetch(parameter_named(form, parameter_name(List{}, index)), value);
    }};

/// The key `kind` of a table that holds one of a list of types.
template <class List, auto Form> Key kind_key() {
    Key key{"kind", Type::word, {}, "", Requirement::required, "", "What it is.", kind_slot<List, Form>};
    for (const std::string_view name : List::names) key.words.emplace_back(name);
    return key;
}

/// Returns a key for every name among the parameters of the kinds; `kinds` lists the kinds that have it.
template <class List, auto Form> std::vector<Key> parameter_keys() {
    std::vector<Key> keys;
    std::vector<Slot> slots;
    [&]<std::size_t... index>(std::index_sequence<index...>) { slots = {parameter_slot<List, Form, index>...}; }(
        std::make_index_sequence<parameter_count(List{})>{});
    std::size_t next_slot = 0;
    List::each_parameter([&](std::string_view kind, const auto& p) {
        const Slot& slot = slots[next_slot++];
        const auto is_same = [&](const Key& key) { return key.name == p.name; };
        if (const auto listed_key = std::find_if(keys.begin(), keys.end(), is_same); listed_key != keys.end()) {
            listed_key->kinds += " " + std::string(kind);
            return;
        }
        const Type type = std::visit(
            [&]<class Kind, class T>(T Kind::*) { return type_of(std::type_identity<T>{}, p.unit_vector); }, p.member);
        const Requirement need = p.default_value.empty() ? Requirement::required
            : type == Type::flag                         ? Requirement::defaulted
                                                         : Requirement::optional;
        keys.push_back({p.name, type, p.range, p.unit, need, p.default_value, p.means, slot, {}, std::string(kind)});
    });
    return keys;
}

}  // namespace crescent
