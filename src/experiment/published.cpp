// Published values from JSON. For wrong syntax the place in the file is known; for other errors a JSON pointer is
// given.
#include "experiment/published.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "experiment/experiment.h"
#include "output/stored_json.h"

namespace crescent {

namespace {

using nlohmann::json;

SourceLocation place_of_byte(std::string_view text, std::size_t byte, const std::string& file) {
    const std::string_view prefix = text.substr(0, std::min(byte > 0 ? byte - 1 : 0, text.size()));
    const std::size_t line_start = prefix.rfind('\n') == std::string_view::npos ? 0 : prefix.rfind('\n') + 1;
    return {file, static_cast<unsigned>(std::count(prefix.begin(), prefix.end(), '\n') + 1),
        static_cast<unsigned>(prefix.size() - line_start + 1)};
}

class Reader {
public:
    explicit Reader(const std::string& file) : file_(file) {}

    Published read(const json& root) {
        Published published;
        if (!root.is_object()) fail("", "an object with 'runs' and 'furnaces'", root);
        for (const auto& [key, value] : root.items()) {
            if (key == "source")
                published.source = value.is_string() ? value.get<std::string>() : (fail("/source", "text", value), "");
            else if (key == "seed")
                published.seed = value.is_number_unsigned() && value.get<std::uint64_t>() <= 0xffffffffu
                    ? value.get<std::uint32_t>()
                    : (fail("/seed", "a seed, 0 to 4294967295", value), 0u);
            else if (key == "runs") runs(value, published);
            else if (key == "furnaces") furnaces(value, published);
            else fail("/" + key, "one of the keys source, seed, runs, furnaces", key);
        }
        return published;
    }

private:
    static bool is_metric(const std::string& key) {
        return key.starts_with("rmse.") || key.starts_with("var.") || key == "fireflies" || key == "horizon_frac" ||
            key == "y_mean" || key == "rmse_frame";
    }

    [[noreturn]] void fail(const std::string& pointer, const std::string& expected, const json& value) const {
        std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
        if (text.size() > 40) text = text.substr(0, 37) + "...";
        throw InputError(
            {file_, 0, 0}, fmt::format("{}: expected {}, found {}", pointer.empty() ? "/" : pointer, expected, text));
    }

    void runs(const json& list, Published& published) const {
        if (!list.is_array()) fail("/runs", "a list of objects", list);
        for (std::size_t i = 0; i < list.size(); ++i) run(list[i], fmt::format("/runs/{}", i), published);
    }

    void run(const json& run, const std::string& pointer, Published& published) const {
        const auto arm = run.find("arm"), n = run.find("n"), s = run.find("s");
        if (!run.is_object() || arm == run.end() || !arm->is_string() || n == run.end() || !n->is_number_unsigned() ||
            s == run.end() || !s->is_number())
            fail(pointer, "an object with arm (text), n (integer) and s (number)", run);
        for (const auto& [key, value] : run.items()) {
            if (key == "arm" || key == "n" || key == "s") continue;
            if (!is_metric(key))
                fail(
                    pointer + "/" + key, "rmse.REGION, var.REGION, fireflies, horizon_frac, y_mean or rmse_frame", key);
            if (!value.is_number()) fail(pointer + "/" + key, "a number", value);
            const bool is_new =
                published.runs
                    .emplace(std::tuple(arm->get<std::string>(), n->get<std::uint64_t>(), s->get<double>(), key),
                        value.get<double>())
                    .second;
            if (!is_new) fail(pointer + "/" + key, "a figure that was not given before", value);
        }
    }

    void furnaces(const json& object, Published& published) const {
        if (!object.is_object()) fail("/furnaces", "an object", object);
        for (const auto& [key, value] : object.items()) {
            if (!value.is_number()) fail("/furnaces/" + key, "a number", value);
            published.furnaces[key] = value.get<double>();
        }
    }

    const std::string& file_;
};

}  // namespace

std::optional<double> Published::find(
    const std::string& arm, std::uint64_t n, double s, const std::string& metric) const {
    const auto it = runs.find({arm, n, s, metric});
    return it == runs.end() ? std::nullopt : std::optional(it->second);
}

std::optional<double> Published::furnace(const std::string& name) const {
    const auto it = furnaces.find(name);
    return it == furnaces.end() ? std::nullopt : std::optional(it->second);
}

Published parse_published(std::string_view text, const std::string& name) {
    try {
        return Reader(name).read(json::parse(text));
    } catch (const json::parse_error& error) {
        throw InputError(place_of_byte(text, error.byte, name), fmt::format("not JSON: {}", unreadable_json(error)));
    } catch (const json::exception& error) {
        throw InputError({name, 0, 0}, fmt::format("expected published figures: {}", unreadable_json(error)));
    }
}

std::optional<Published> load_published(const std::string& path) {
    if (path.empty()) return {};
    return parse_published(read_text(path, "a JSON of published figures"), path);
}

}  // namespace crescent
