// The place of a value is built as it is reached; messages are made where reading fails.
#include "output/stored_json.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"

namespace crescent {

double StoredJson::number() const {
    if (json_->is_number()) return json_->get<double>();
    for (const double x : {HUGE_VAL, -HUGE_VAL, std::nan("")})
        if (*json_ == crescent::number(x)) return x;
    refuse("expected a number, \"nan\", \"inf\" or \"-inf\"");
}

std::vector<StoredJson> StoredJson::entries() const {
    if (!json_->is_array()) refuse("expected a list");
    std::vector<StoredJson> out;
    for (std::size_t k = 0; k < json_->size(); ++k) out.emplace_back((*json_)[k], entry(k));
    return out;
}

std::vector<std::pair<std::string, StoredJson>> StoredJson::items() const {
    if (!json_->is_object()) refuse("expected an object");
    std::vector<std::pair<std::string, StoredJson>> out;
    for (const auto& [key, value] : json_->items()) out.emplace_back(key, StoredJson(value, member(key)));
    return out;
}

void StoredJson::refuse(const std::string& message) const {
    constexpr std::size_t longest = 40;
    std::string description = json_->is_object() ? "an object"
        : json_->is_array()                      ? fmt::format("a list of {}", json_->size())
                                                 : json_->dump(-1, ' ', true, Json::error_handler_t::replace);
    if (description.size() > longest) description = description.substr(0, longest - 3) + "...";
    throw StoredJsonError(
        fmt::format("{}{}, found {}", place_.empty() ? "" : printable(place_) + ": ", message, description));
}

void StoredJson::missing(const std::string& key) const {
    throw StoredJsonError(
        fmt::format("{}{}, found none", place_.empty() ? "" : printable(place_) + ": ", expected_object(key)));
}

std::string unreadable_json(const Json::exception& error) {
    std::string text = error.what();
    if (text.starts_with("[json.exception")) text.erase(0, std::min(text.find("] ") + 2, text.size()));
    if (text.starts_with("parse error ")) text.erase(0, std::string_view("parse error ").size());
    if (text.starts_with("key '") && text.ends_with("' not found"))
        return fmt::format("expected an object with {}, found none",
            text.substr(4, text.size() - 4 - std::string_view(" not found").size()));
    if (const std::size_t position = text.find(" with "); text.starts_with("cannot use ") && position != text.npos)
        return fmt::format("expected a value of another type, found {}", text.substr(position + 6));
    const std::string_view prefix = "type must be ", infix = ", but is ";
    if (const std::size_t position = text.find(infix); text.starts_with(prefix) && position != text.npos)
        return fmt::format("expected a value of type {}, found {}",
            text.substr(prefix.size(), position - prefix.size()), text.substr(position + infix.size()));
    return text;
}

}  // namespace crescent
