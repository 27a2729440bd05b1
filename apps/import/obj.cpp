// Wavefront's OBJ ("Object Files", version 3.0): vertices, faces, names and libraries of materials. A statement that is
// not read is listed by its name. The numbers are read first, because a face may name a vertex below it.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "lines.h"
#include "model.h"
#include "mtl.h"
#include "polygon.h"

namespace crescent::importer {

namespace {

constexpr std::array<std::string_view, 3> kinds = {"v", "vt", "vn"};
constexpr std::array<std::size_t, 3> least_numbers = {3, 1, 3};

/// The indices of a corner into the positions, texture coordinates and normals, from 1 on; 0: none.
using Corner = std::array<std::uint64_t, 3>;

struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
        return std::hash<std::string_view>{}({reinterpret_cast<const char*>(corner.data()), sizeof corner});
    }
};

class ObjReader {
public:
    Model model;

    ObjReader(const std::filesystem::path& file, const ReadingScope& scope)
        : folder_(std::filesystem::absolute(file).parent_path()), scope_(scope), text_(joined_lines(bytes_of(file))) {
        read_numbers();
        for (const std::string& library : libraries_) read_library(library);
        read_faces();
        list_what_is_left_out();
    }

private:
    // ---- The first pass: numbers and libraries.

    void read_numbers() {
        Statements statements(text_);
        while (const std::optional<Statement> statement = statements.next()) {
            const auto kind = static_cast<std::size_t>(std::ranges::find(kinds, statement->key) - kinds.begin());
            if (kind < kinds.size()) add_numbers(kind, *statement);
            else if (statement->key == "mtllib") libraries_.emplace_back(statement->value);
        }
    }

    void add_numbers(std::size_t kind, const Statement& statement) {
        const auto numbers = numbers_of(without_comment(statement.value));
        if (!numbers || numbers->size() < least_numbers[kind])
            throw ModelError(fmt::format("line {}: expected {} after '{}'", statement.line,
                counted(least_numbers[kind], "number[s]"), kinds[kind]));
        const std::vector<double>& x = *numbers;
        if (kind == 1) {
            uv_.push_back({static_cast<float>(x[0]), x.size() > 1 ? static_cast<float>(x[1]) : 0});
            further_numbers_ += x.size() > 3;
            return;
        }
        if (kind == 2) {
            normals_.push_back(narrow({x[0], x[1], x[2]}));
            further_numbers_ += x.size() > 3;
            return;
        }
        positions_.push_back({x[0], x[1], x[2]});
        // Of curves: polygons have no weights.
        weights_ += (x.size() == 4 || x.size() == 7) && x[3] != 1;
        colours_ += x.size() == 6 || x.size() == 7;
        further_numbers_ += x.size() == 5 || x.size() > 7;
    }

    // ---- Materials.

    /// One name, or several, each of which may have blanks and ends with .mtl.
    void read_library(std::string_view names) {
        if (open_library(without_quotes(names), false)) return;
        names = without_comment_of_name(names);
        std::string_view remainder = names;
        while (!remainder.empty()) {
            const std::string_view text = remainder;
            std::string word;
            do word = lower_case(take_word(remainder));
            while (!remainder.empty() && !word.ends_with(".mtl") && !word.ends_with(".mtl\""));
            const std::string_view name =
                without_quotes(without_blanks_at_ends(text.substr(0, text.size() - remainder.size())));
            if (!name.empty() && !open_library(name, true))
                model.left_out.push_back(fmt::format("the materials of '{}', which cannot be opened", name));
        }
    }

    /// `may_be_other`: the file may be in another folder than the name has.
    bool open_library(std::string_view name, bool may_be_other) {
        const std::optional<FoundFile> file = file_named(name, std::array{folder_}, folder_);
        if (!file || (file->is_other && !may_be_other)) return false;
        note_other_name(*file, name);
        Mtl library = read_mtl(bytes_of(file->path));
        for (const auto& [statement, count] : library.statements) material_statements_[statement] += count;
        before_materials_ += library.before_first;
        for (const auto& [option, count] : library.options) image_options_[option] += count;
        for (MtlMaterial& entry : library.materials) {
            const bool is_new = material_of_name_.try_emplace(entry.material.name, model.materials.size()).second;
            if (!is_new) {
                ++repeated_names_;
                continue;
            }
            if (!entry.image.empty()) add_image(entry, file->path.parent_path());
            model.materials.push_back(std::move(entry.material));
            uv_placements_.push_back(entry.uv);
        }
        return true;
    }

    void add_image(MtlMaterial& to, const std::filesystem::path& folder_of_library) {
        const std::array folders = {folder_of_library, folder_};
        std::string name = to.image;
        std::optional<FoundFile> file = file_named(name, folders, folder_);
        if (!file) {
            name = without_comment_of_name(name);
            file = file_named(name, folders, folder_);
        }
        if (file) note_other_name(*file, name);
        std::ranges::replace(name, '\\', '/');
        to.material.texture = name;
        if (!scope_.images) return;
        const auto [picture, is_new] =
            picture_of_file_.try_emplace(file ? file->path.string() : name, model.pictures.size());
        to.material.colours = picture->second;
        if (is_new) model.pictures.push_back({name, file ? bytes_of(file->path) : ""});
    }

    void note_other_name(const FoundFile& file, std::string_view name) {
        if (file.is_other)
            model.assumed.push_back(fmt::format("'{}' is '{}' of another folder", file.path.filename().string(), name));
    }

    /// Of a name in `usemtl`; a grey one if no library has it.
    std::size_t material_named(std::string_view name) {
        const auto entry = material_of_name_.find(name);
        if (entry != material_of_name_.end()) return entry->second;
        if (const std::string_view shorter = without_comment_of_name(name); shorter != name)
            return material_named(shorter);
        if (!name.empty()) unknown_materials_.emplace_back(name);
        const std::size_t index = model.materials.size();
        material_of_name_.emplace(name, index);
        model.materials.push_back({std::string(name)});
        uv_placements_.emplace_back();
        return index;
    }

    // ---- The second pass: faces with their names and materials.

    void read_faces() {
        Statements statements(text_);
        while (const std::optional<Statement> statement = statements.next()) {
            const std::string_view key = statement->key;
            const auto kind = static_cast<std::size_t>(std::ranges::find(kinds, key) - kinds.begin());
            if (kind < kinds.size()) ++counts_[kind];
            else if (key == "f" || key == "fo") add_face(*statement);  // fo: before version 3.0
            else if (key == "o" || key == "g") {
                (key == "o" ? object_ : group_) = statement->value;
                is_changed_ = true;
            } else if (key == "usemtl") {
                material_ = statement->value;
                is_changed_ = true;
            } else if (key == "s") {
                const std::string_view word = without_blanks_at_ends(without_comment(statement->value));
                is_smooth_ = !word.empty() && word != "off" && word != "0";
            } else if (key == "p" || key == "l") ++points_and_lines_;
            else if (key == "curv" || key == "curv2" || key == "surf") ++curves_;
            else if (key != "mtllib") count_kind(statements_, std::string(key));
        }
    }

    void add_face(const Statement& statement) {
        std::string_view text = without_comment(statement.value);
        corners_.clear();
        bool has_uv = true, has_normals = true, has_some_uv = false;
        for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
            if (corners_.size() == most_corners)
                throw ModelError(
                    fmt::format("line {}: expected a face of at most {} corners", statement.line, most_corners));
            corners_.push_back(corner_of(word, statement.line));
            has_uv = has_uv && corners_.back()[1] > 0;
            has_some_uv = has_some_uv || corners_.back()[1] > 0;
            has_normals = has_normals && corners_.back()[2] > 0;
        }
        if (corners_.size() < 3) {
            ++points_and_lines_;
            return;
        }
        unsmoothed_ += is_smooth_ && !has_normals;
        half_textured_ += has_some_uv && !has_uv;
        const std::size_t index = part_for(has_uv);
        Part& part = model.parts[index];
        vertices_.clear();
        for (Corner& corner : corners_) {
            if (!has_uv) corner[1] = 0;
            vertices_.push_back(vertex(part, vertex_of_corner_[index], corner));
        }
        triangulate(part.positions, vertices_, part.triangles);
    }

    /// v, v/vt, v//vn or v/vt/vn; an index below 0 counts back from the last one above.
    Corner corner_of(std::string_view word, std::size_t line) const {
        Corner out{};
        const auto make_error = [&] {
            return ModelError(
                fmt::format("line {}: expected an index, v, v/vt, v//vn or v/vt/vn, not '{}'", line, word));
        };
        std::string_view text = word;
        for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
            const std::string_view digits = text.substr(0, text.find('/'));
            const bool is_last = digits.size() == text.size();
            text.remove_prefix(std::min(digits.size() + 1, text.size()));
            if (digits.empty() && kind == 0) throw make_error();
            if (!digits.empty()) out[kind] = index_in(digits, kind, line).value_or(0);
            if (!digits.empty() && out[kind] == 0) throw make_error();
            if (is_last) return out;
        }
        if (!text.empty() || std::ranges::count(word, '/') > 2) throw make_error();
        return out;
    }
    std::optional<std::uint64_t> index_in(std::string_view digits, std::size_t kind, std::size_t line) const {
        const std::array<std::size_t, 3> totals = {positions_.size(), uv_.size(), normals_.size()};
        if (digits.starts_with('+')) digits.remove_prefix(1);
        std::int64_t index = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error != std::errc{} || end != digits.data() + digits.size() || index == 0) return std::nullopt;
        const auto count = static_cast<std::int64_t>(counts_[kind]);
        if (index < -count)
            throw ModelError(fmt::format("line {}: the index {} of '{}', of which {} above", line, index, kinds[kind],
                counts_[kind] == 1 ? "1 is" : fmt::format("{} are", counts_[kind])));
        if (index > static_cast<std::int64_t>(totals[kind]))
            throw ModelError(fmt::format("line {}: the index {} of '{}', of which there {}", line, index, kinds[kind],
                totals[kind] == 1 ? "is 1" : fmt::format("are {}", totals[kind])));
        return static_cast<std::uint64_t>(index > 0 ? index : count + index + 1);
    }

    /// The part of the present names and material, with or without texture coordinates.
    std::size_t part_for(bool has_uv) {
        if (is_changed_) current_ = {};
        is_changed_ = false;
        std::optional<std::size_t>& current = current_[has_uv];
        if (current) return *current;
        const std::size_t material = material_named(material_);
        std::vector<std::string> names;
        if (scope_.whole_scene)
            for (const std::string_view name : {object_, group_})
                if (!name.empty()) names.emplace_back(name);
        const auto [part, is_new] = part_of_.try_emplace({names, material, has_uv}, model.parts.size());
        current = part->second;
        if (!is_new) return part->second;
        vertex_of_corner_.emplace_back();
        model.parts.emplace_back();
        model.parts.back().material = material;
        model.parts.back().names = std::move(names);
        return part->second;
    }

    std::uint32_t vertex(
        Part& part, std::unordered_map<Corner, std::uint32_t, CornerHash>& indices, const Corner& corner) {
        const auto [index, is_new] = indices.try_emplace(corner, static_cast<std::uint32_t>(part.positions.size()));
        if (!is_new) return index->second;
        part.positions.push_back(positions_[corner[0] - 1]);
        // A corner without a normal has that of its triangle.
        if (corner[2] > 0) part.normals.resize(part.positions.size() - 1);
        if (corner[2] > 0) part.normals.push_back(normals_[corner[2] - 1]);
        else if (!part.normals.empty()) part.normals.emplace_back();
        if (corner[1] > 0) {
            const UvPlacement& placement = uv_placements_[part.material];
            const Vec2<float> uv = uv_[corner[1] - 1];
            part.uv.push_back({static_cast<float>(placement.scale.x * static_cast<double>(uv.x) + placement.offset.x),
                static_cast<float>(placement.scale.y * static_cast<double>(uv.y) + placement.offset.y)});
        }
        return index->second;
    }

    void list_what_is_left_out() {
        model.leave_out(curves_, "curve[s] or surface[s]");
        model.leave_out(points_and_lines_, "point[s] or line[s]");
        model.leave_out(weights_, "weight[s] of vertices");
        model.leave_out(colours_, "colour[s] of vertices");
        model.leave_out(further_numbers_, "vert[ex|ices] with more numbers than are read");
        model.leave_out(half_textured_, "face[s] with texture coordinates at some corners alone: the coordinates");
        model.leave_out(unsmoothed_, "face[s] of smoothing groups without normals: the smoothing (--smooth DEG)");
        model.leave_out(repeated_names_, "material[s] with a name that another one has");
        model.leave_out(before_materials_, "statement[s] of libraries before their first material");
        if (const std::size_t count = unknown_materials_.size(); count > 0)
            model.left_out.push_back(fmt::format("{}, which no library has: grey in place of {}",
                counted(count, "material[s]"), some_of(unknown_materials_)));
        for (const auto& [key, count] : statements_)
            model.left_out.push_back(key == other_kinds ? counted(count, "other statement[s]")
                                                        : fmt::format("{} '{}'", counted(count, "statement[s]"), key));
        for (const auto& [key, count] : material_statements_)
            model.left_out.push_back(fmt::format(
                "{} of {}", key == other_kinds ? "other statements" : "'" + key + "'", counted(count, "material[s]")));
        for (const auto& [key, count] : image_options_)
            model.left_out.push_back(fmt::format("the option '{}' of {}", key, counted(count, "image[s]")));
    }

    std::filesystem::path folder_;
    ReadingScope scope_;
    std::string text_;
    std::vector<std::string> libraries_, unknown_materials_;
    std::vector<Vec3d> positions_;
    std::vector<Vec2<float>> uv_;
    std::vector<Vec3f> normals_;
    std::map<std::string, std::size_t, std::less<>> material_of_name_;
    std::vector<UvPlacement> uv_placements_;  // of each material
    std::map<std::string, std::size_t> picture_of_file_;
    // Of the second pass.
    std::array<std::size_t, 3> counts_{};  // above the present line
    std::string_view object_, group_, material_;
    bool is_smooth_ = false, is_changed_ = false;
    std::array<std::optional<std::size_t>, 2> current_{};  // parts, without and with texture coordinates
    std::map<std::tuple<std::vector<std::string>, std::size_t, bool>, std::size_t> part_of_;
    std::vector<std::unordered_map<Corner, std::uint32_t, CornerHash>> vertex_of_corner_;  // of each part
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> vertices_;
    Kinds statements_, material_statements_, image_options_;
    std::size_t curves_ = 0, points_and_lines_ = 0, weights_ = 0, colours_ = 0, further_numbers_ = 0,
                half_textured_ = 0, unsmoothed_ = 0, repeated_names_ = 0, before_materials_ = 0;
};

}  // namespace

Model read_obj(const std::filesystem::path& file, const ReadingScope& scope) { return ObjReader(file, scope).model; }

}  // namespace crescent::importer
