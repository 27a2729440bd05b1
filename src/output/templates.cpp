// Rendered by kainjow::mustache, which writes nothing in place of a value that the model lacks: the context below
// throws instead. Text is escaped by escape(), which also replaces what XML forbids.
#include "output/templates.h"

#include <algorithm>
#include <fmt/format.h>
#include <kainjow/mustache.hpp>
#include <map>

#include "base/errors.h"
#include "base/text.h"

namespace crescent {

namespace {

namespace mustache = kainjow::mustache;

/// "" becomes false, which is written as "" and leaves its section out. Each list x has a has_x.
mustache::data data_of(const Json& json) {
    if (json.is_string()) {
        const auto& text = json.get_ref<const std::string&>();
        return text.empty() ? mustache::data(false) : mustache::data(text);
    }
    if (json.is_boolean()) return mustache::data(json.get<bool>());
    if (json.is_number_float()) return mustache::data(shortest(json.get<double>()));
    if (json.is_number()) return mustache::data(json.dump());
    if (json.is_null()) return mustache::data(false);
    mustache::data out(json.is_array() ? mustache::data::type::list : mustache::data::type::object);
    for (const auto& [key, value] : json.items())
        if (json.is_array()) out.push_back(data_of(value));
        else {
            out[key] = data_of(value);
            if (value.is_array()) out["has_" + key] = mustache::data(!value.empty());
        }
    return out;
}

/// Knows all templates, and throws if a name is unknown.
class StrictContext : public mustache::context<std::string> {
public:
    StrictContext(Templates templates, std::string_view page, const mustache::data& model)
        : context(&model), templates_(templates), page_(page) {}

    const mustache::data* get(const std::string& name) const override {
        if (name.starts_with("count.")) return &(count_ = mustache::data(std::to_string(++counts_[name])));
        const mustache::data* value = context::get(name);
        ensure(value != nullptr, fmt::format("{}: the model has no value '{}'", page_, name));
        return value;
    }
    const mustache::data* get_partial(const std::string& name) const override {
        std::string text = text_of(name);
        if (text.ends_with('\n')) text.pop_back();  // so that it can be included inside a sentence
        partial_ = mustache::data(text);
        return &partial_;
    }
    std::string text_of(std::string_view name) const {
        for (const Templates& templates : {templates_, output_templates()})
            if (const auto match = std::ranges::find(templates, name, &Template::name); match != templates.end())
                return std::string(match->text);
        throw Bug(std::source_location::current(), fmt::format("{}: there is no template '{}'", page_, name));
    }

private:
    Templates templates_;
    std::string page_;
    mutable mustache::data partial_, count_;
    mutable std::map<std::string, int> counts_;
};

}  // namespace

std::string render_page(Templates templates, std::string_view name, const Json& model) {
    const mustache::data data = data_of(model);
    StrictContext context(templates, name, data);
    mustache::mustache page(context.text_of(name));
    page.set_custom_escape([](const std::string& text) { return escape(text); });
    std::ostringstream out;
    page.render(context, out);
    ensure(page.is_valid(), fmt::format("{}: {}", name, page.error_message()));
    return std::move(out).str();
}

}  // namespace crescent
