// Keys of tables that say their kind: made from the parameters of each kind of a list (scene/parameter.h).
#pragma once

#include "experiment/schema.h"
#include "scene/parameter.h"

namespace crescent::inline experiment {

/// The type of a key, from that of the member it is stored in.
inline Type type_of(const std::type_identity<double>&, bool) { return Type::number; }
inline Type type_of(const std::type_identity<bool>&, bool) { return Type::flag; }
inline Type type_of(const std::type_identity<Vec3d>&, bool unit) { return unit ? Type::direction : Type::point; }
inline Type type_of(const std::type_identity<std::optional<Rgb>>&, bool) { return Type::color; }

/// The name of the parameter at `index`, counted through all kinds.
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

/// A parameter of an object, whatever its kind; empty where its kind has no parameter of that name.
using AnyParameter = std::variant<std::monostate, double*, bool*, Vec3d*, std::optional<Rgb>*>;

/// The parameter of that name of the kind that `any` holds.
template <class Any> AnyParameter parameter_named(Any& any, std::string_view name) {
    AnyParameter found;
    std::visit(
        [&](auto& kind) {
            for (const auto& parameter : std::remove_cvref_t<decltype(kind)>::parameters())
                if (parameter.name == name) std::visit([&](auto member) { found = &(kind.*member); }, parameter.member);
        },
        any);
    return found;
}
inline void assign(const AnyParameter& to, const Value& value) {
    std::visit(
        [&]<class T>(T at) {
            if constexpr (std::is_pointer_v<T>) assign(*at, value);
        },
        to);
}
inline bool fetch(const AnyParameter& from, Value& value) {
    const auto read = [&]<class T>(T at) {
        if constexpr (std::is_pointer_v<T>) return fetch(*at, value);
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

/// The parameter at `index` of whichever kind the object holds.
template <class List, auto Form, std::size_t index> constexpr Slot parameter_slot = {
    [](void* object, const Value& value) {
        using Owner = typename OwnerOf<decltype(Form)>::type;
        assign(parameter_named(static_cast<Owner*>(object)->*Form, parameter_name(List{}, index)), value);
    },
    [](const void* object, Value& value) {
        using Owner = typename OwnerOf<decltype(Form)>::type;
        // A member is found in what may be written; it is only read here.
        auto& form = const_cast<Owner*>(static_cast<const Owner*>(object))->*Form;
        return fetch(parameter_named(form, parameter_name(List{}, index)), value);
    }};

template <class List, auto Form> Key kind_key() {
    Key key{"kind", Type::word, {}, "", Requirement::required, "", "What it is.", kind_slot<List, Form>};
    for (const std::string_view name : List::names) key.words.emplace_back(name);
    return key;
}

/// A key for every name among the parameters of the kinds; `kinds` says whose it is.
template <class List, auto Form> std::vector<Key> parameter_keys() {
    std::vector<Key> keys;
    std::vector<Slot> slots;
    [&]<std::size_t... index>(std::index_sequence<index...>) { slots = {parameter_slot<List, Form, index>...}; }(
        std::make_index_sequence<parameter_count(List{})>{});
    std::size_t at = 0;
    List::each_parameter([&](std::string_view kind, const auto& p) {
        const Slot& slot = slots[at++];
        const auto same = [&](const Key& key) { return key.name == p.name; };
        if (const auto known = std::find_if(keys.begin(), keys.end(), same); known != keys.end()) {
            known->kinds += " " + std::string(kind);
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

}  // namespace crescent::inline experiment
