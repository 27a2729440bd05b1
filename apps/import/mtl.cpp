// Wavefront's MTL (Ramey, Rose and Tyerman 1995) with the keys Pr and Pm of Clara.io's extension for metal and
// roughness. Keys are compared without case, as exporters write map_Kd and map_kd.
#include "mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "lines.h"

namespace crescent::importer {

namespace {

struct Neutral {
    std::string_view key, value;
};
/// Statements that are not read, at the values at which they change nothing of what is. illum 2: a diffuse colour and a
/// lobe.
constexpr std::array neutral_statements = {Neutral{"d", "1"}, Neutral{"tr", "0"}, Neutral{"tf", "1"},
    Neutral{"tf", "1 1 1"}, Neutral{"ka", "0"}, Neutral{"ka", "0 0 0"}, Neutral{"ni", "1"}, Neutral{"illum", "2"},
    Neutral{"ps", "0"}, Neutral{"pc", "0"}, Neutral{"pcr", "0"}, Neutral{"aniso", "0"}, Neutral{"anisor", "0"}};
constexpr std::array neutral_options = {Neutral{"-blendu", "on"}, Neutral{"-blendv", "on"}, Neutral{"-cc", "off"},
    Neutral{"-clamp", "off"}, Neutral{"-mm", "0 1"}, Neutral{"-t", "0"}, Neutral{"-t", "0 0"}, Neutral{"-t", "0 0 0"}};

bool is_neutral(const auto& table, std::string_view key, std::string_view value) {
    return std::ranges::any_of(table, [&](const Neutral& entry) {
        if (entry.key != key) return false;
        const auto numbers = numbers_of(value);
        return numbers ? numbers == numbers_of(entry.value) : value == entry.value;
    });
}

/// Options of images with how many values: up to so many numbers, or a word.
struct Option {
    std::string_view name;
    std::size_t most_numbers;  // 0: a word
};
constexpr std::array image_options = {Option{"-o", 3}, Option{"-s", 3}, Option{"-t", 3}, Option{"-mm", 2},
    Option{"-bm", 1}, Option{"-boost", 1}, Option{"-texres", 3}, Option{"-blendu", 0}, Option{"-blendv", 0},
    Option{"-cc", 0}, Option{"-clamp", 0}, Option{"-imfchan", 0}, Option{"-type", 0}};

/// Takes the options of an image off; what is left is the name of its file.
void read_image(std::string_view text, MtlMaterial& to, Kinds& left_out) {
    to.uv = {};
    for (;;) {
        std::string_view option_text = text;
        const std::string name = lower_case(take_word(option_text));
        const auto* const option = std::ranges::find(image_options, name, &Option::name);
        if (option == image_options.end()) break;
        text = option_text;
        std::vector<double> numbers;
        const std::size_t begin = text.size();
        const std::string_view values = text;
        if (option->most_numbers == 0) (void)take_word(text);
        while (numbers.size() < option->most_numbers) {
            std::string_view number_text = text;
            const std::optional<double> number = number_in(take_word(number_text));
            if (!number) break;
            numbers.push_back(*number);
            text = number_text;
        }
        Vec2<double>* const placement = name == "-s" ? &to.uv.scale : name == "-o" ? &to.uv.offset : nullptr;
        if (placement && !numbers.empty()) {
            placement->x = numbers[0];
            if (numbers.size() > 1) placement->y = numbers[1];
        } else if (!is_neutral(neutral_options, name, without_blanks_at_ends(values.substr(0, begin - text.size()))))
            ++left_out[name];
    }
    to.image = without_quotes(without_blanks_at_ends(text));
}

/// A colour: three numbers, or one for each channel. Nothing if it is none, or below 0.
std::optional<Vec3f> colour_in(std::string_view text) {
    const auto numbers = numbers_of(text);
    if (!numbers || (numbers->size() != 1 && numbers->size() != 3)) return std::nullopt;
    if (std::ranges::any_of(*numbers, [](double x) { return !(x >= 0); })) return std::nullopt;
    return narrow({numbers->front(), (*numbers)[numbers->size() / 2], numbers->back()});
}

/// Nothing if it is none, or below 0.
std::optional<float> number_in_statement(std::string_view text) {
    const auto numbers = numbers_of(text);
    if (!numbers || numbers->size() != 1 || !(numbers->front() >= 0)) return std::nullopt;
    return static_cast<float>(numbers->front());
}

class MtlReader {
public:
    Mtl result;

    explicit MtlReader(std::string_view text) {
        Statements statements(text);
        while (const std::optional<Statement> statement = statements.next()) read(*statement);
        end_material();
    }

private:
    void read(const Statement& statement) {
        const std::string key = lower_case(statement.key);
        if (key == "newmtl") return begin_material(without_comment_of_name(statement.value));
        if (result.materials.empty()) ++result.before_first;
        else if (!has_effect(key, statement.value)) leave_out(key, statement);
    }

    void begin_material(std::string_view name) {
        end_material();
        result.materials.emplace_back();
        result.materials.back().material.name = name;
        has_colour_ = has_image_of_emission_ = false;
        of_exponent_ = 1;  // Ns 0
        roughness_.reset();
        omissions_.clear();
    }
    void end_material() {
        if (result.materials.empty()) return;
        MtlMaterial& to = result.materials.back();
        // An image alone is the colour.
        if (!has_colour_ && !to.image.empty()) to.material.rho_d = {1, 1, 1};
        to.material.alpha = roughness_ ? *roughness_ * *roughness_ : of_exponent_;
        // The numbers of an emission with an image are a factor of it.
        const Vec3f emission = to.material.emission;
        if (!has_image_of_emission_ || !(emission.x + emission.y + emission.z > 0)) return;
        to.material.emission = {};
        count_kind(result.statements, "Ke");
    }

    /// Reads a statement; false if it is not one of those that are read.
    bool has_effect(const std::string& key, std::string_view value) {
        MtlMaterial& to = result.materials.back();
        const auto take_colour = [&](Vec3f& out) {
            const std::optional<Vec3f> colour = colour_in(without_comment(value));
            if (colour) out = *colour;
            return colour.has_value();
        };
        if (key == "kd") {
            const bool is_colour = take_colour(to.material.rho_d);
            has_colour_ = has_colour_ || is_colour;
            return is_colour;
        }
        if (key == "ks") return take_colour(to.material.rho_s);
        if (key == "ke") return take_colour(to.material.emission);
        if (key == "map_kd") {
            read_image(value, to, result.options);
            return !to.image.empty();
        }
        has_image_of_emission_ = has_image_of_emission_ || key == "map_ke";
        if (key != "ns" && key != "pr" && key != "pm") return false;
        const std::optional<float> number = number_in_statement(without_comment(value));
        if (!number) return false;
        if (key == "ns") of_exponent_ = std::sqrt(2 / (*number + 2));
        else if (key == "pr") roughness_ = number;
        else to.material.metal = *number;
        return true;
    }

    /// By its name, and by the word in place of its numbers: 'Ks spectral'.
    void leave_out(const std::string& key, const Statement& statement) {
        constexpr std::array with_numbers = {"ka", "kd", "ks", "ke", "tf", "ns", "ni", "d", "tr", "illum", "pr", "pm",
            "ps", "pc", "pcr", "aniso", "anisor", "sharpness"};
        std::string_view value = without_blanks_at_ends(without_comment(statement.value));
        if (is_neutral(neutral_statements, key, value)) return;
        std::string name(statement.key);
        const bool is_number = std::ranges::find(with_numbers, key) != with_numbers.end();
        if (const std::string_view word = take_word(value); is_number && !(number_in(word) >= 0.0))
            name += word.empty() ? "" : " " + std::string(word);
        if (omissions_.insert(name).second) count_kind(result.statements, name);
    }

    std::set<std::string> omissions_;  // of the present material
    bool has_colour_ = false, has_image_of_emission_ = false;
    float of_exponent_ = 1;
    std::optional<float> roughness_;
};

}  // namespace

Mtl read_mtl(std::string_view file) { return MtlReader(joined_lines(file)).result; }

}  // namespace crescent::importer
