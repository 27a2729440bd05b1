// JSON that was written earlier and may have been changed since: whoever reads a field that is missing or of another
// type gets the field and what was expected.
#pragma once

#include <concepts>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "output/format.h"

namespace crescent {

/// "runs[3].seed: expected a number, found \"seven\"".
struct StoredJsonError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What a reader expects in the place of a T, in words.
template <class T> std::string json_words() {
    if constexpr (std::same_as<T, bool>) return "true or false";
    else if constexpr (std::same_as<T, std::string>) return "a text";
    else if constexpr (std::unsigned_integral<T>) return "a whole number of at least 0";
    else if constexpr (std::is_arithmetic_v<T>) return "a number";
    else if constexpr (requires { typename T::mapped_type; })
        return "an object, each value " + json_words<typename T::mapped_type>();
    else if constexpr (requires { typename T::value_type; })
        return "a list, each entry " + json_words<typename T::value_type>();
    else if constexpr (requires { typename T::first_type; })
        return "a list of two, each " + json_words<typename T::first_type>();
    else return "another value";
}

/// A value with its place in the file. It refers to the value, which must outlive it. Its members have the names and
/// the meaning of nlohmann::json's, and throw StoredJsonError.
class StoredJson {
public:
    /// place: of the value in the file, "runs[3]"; "": it is the whole file.
    StoredJson(const Json& json, std::string place = "") : json_(&json), place_(std::move(place)) {}

    /// The value without its place.
    const Json& value() const { return *json_; }
    /// The member of an object.
    StoredJson at(const std::string& key) const {
        const auto match = json_->is_object() ? json_->find(key) : json_->end();
        if (!json_->is_object()) refuse(expected_object(key));
        if (match == json_->end()) missing(key);
        return {*match, member(key)};
    }
    /// The entry of a list.
    StoredJson at(std::size_t index) const {
        if (!json_->is_array() || index >= json_->size())
            refuse("expected a list of at least " + std::to_string(index + 1));
        return {(*json_)[index], entry(index)};
    }
    /// Whether it is an object with this member.
    bool contains(const std::string& key) const { return json_->is_object() && json_->contains(key); }
    /// Whether it is null.
    bool is_null() const { return json_->is_null(); }
    /// Whether it is null, or a list or object without entries.
    bool empty() const { return json_->empty(); }
    /// The number of entries; 1 of a number, a text or a flag.
    std::size_t size() const { return json_->size(); }
    /// Whether its value is this one.
    bool operator==(const auto& x) const { return *json_ == x; }

    /// The value as a T. Integers must be those of the type.
    template <class T> T get() const {
        if constexpr (std::integral<T> && !std::same_as<T, bool>)
            if (!json_->is_number_integer() || !fits<T>()) refuse("expected " + json_words<T>());
        try {
            return json_->get<T>();
        } catch (const Json::exception&) { refuse("expected " + json_words<T>()); }
    }
    /// The same, stored in `to`.
    void get_to(auto& to) const { to = get<std::remove_cvref_t<decltype(to)>>(); }
    /// The member, or `otherwise` if there is none.
    template <class T> T value(const std::string& key, const T& otherwise) const {
        return contains(key) ? at(key).get<T>() : otherwise;
    }
    /// The same of a text.
    std::string value(const std::string& key, const char* otherwise) const {
        return value(key, std::string(otherwise));
    }
    /// What number() made of a double.
    double number() const;
    /// The same; none if it is null.
    std::optional<double> optional_number() const { return is_null() ? std::nullopt : std::optional(number()); }

    /// The entries of a list.
    std::vector<StoredJson> entries() const;
    /// The members of an object.
    std::vector<std::pair<std::string, StoredJson>> items() const;

    /// As a part of other JSON: a single value, since a list or an object has a type of its own.
    friend void to_json(Json& to, const StoredJson& from) {
        if (from.json_->is_structured()) from.refuse("expected a text, a number, true, false or null");
        to = from.value();
    }

    /// Throws with the place: "runs[3]: expected a picture, found 7".
    [[noreturn]] void refuse(const std::string& message) const;

private:
    const Json* json_;
    std::string place_;

    /// Whether an integer is one of this type.
    template <std::integral T> bool fits() const {
        if (json_->is_number_unsigned()) return std::in_range<T>(json_->get<std::uint64_t>());
        return std::in_range<T>(json_->get<std::int64_t>());
    }
    std::string member(const std::string& key) const { return place_.empty() ? key : place_ + "." + key; }
    std::string entry(std::size_t index) const { return place_ + "[" + std::to_string(index) + "]"; }
    static std::string expected_object(const std::string& key) { return "expected an object with '" + key + "'"; }
    [[noreturn]] void missing(const std::string& key) const;
};

/// What is wrong, without the codes of the library, for readers that do not know the place.
std::string unreadable_json(const Json::exception& error);

}  // namespace crescent
