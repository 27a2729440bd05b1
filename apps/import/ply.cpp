// The Stanford polygon format (Turk 1994, "The PLY Polygon File Format"), in ASCII and in binary of either byte order:
// vertices, faces and triangle strips. Counts are checked against the size of the file before memory is taken.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "lines.h"
#include "model.h"
#include "polygon.h"

namespace crescent::importer {

namespace {

enum class Format { ascii, little, big };

struct Type {
    const char* name;
    const char* other_name;
    std::size_t bytes;
    char kind;  // i: signed, u: unsigned, f: real
};
constexpr Type types[] = {{"char", "int8", 1, 'i'}, {"uchar", "uint8", 1, 'u'}, {"short", "int16", 2, 'i'},
    {"ushort", "uint16", 2, 'u'}, {"int", "int32", 4, 'i'}, {"uint", "uint32", 4, 'u'}, {"float", "float32", 4, 'f'},
    {"double", "float64", 8, 'f'}};

struct Property {
    std::string name;
    const Type* type = nullptr;
    const Type* count_type = nullptr;  // of a list; null: a number
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
    std::size_t size = 0;    // bytes
    std::size_t images = 0;  // that comments of MeshLab name
};

const Type& type_named(std::string_view name, std::size_t line) {
    for (const Type& type : types)
        if (name == type.name || name == type.other_name) return type;
    throw ModelError(fmt::format("line {}: expected a type such as float or int32, not '{}'", line, name));
}

Header read_header(std::string_view file) {
    Header out;
    bool has_format = false;
    for (std::size_t line = 1; out.size < file.size(); ++line) {
        const std::size_t end = file.find_first_of("\r\n", out.size);
        if (end == file.npos) break;
        const std::vector<std::string_view> words = words_of(file.substr(out.size, end - out.size));
        out.size = end + (file.substr(end).starts_with("\r\n") ? 2 : 1);
        const auto make_error = [&](std::string_view expected) -> ModelError {
            return ModelError(fmt::format("line {}: expected {}", line, expected));
        };
        if (line == 1) {
            if (words.size() != 1 || words[0] != "ply") throw make_error("the word ply");
        } else if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
            out.images += words.size() > 2 && words[1] == "TextureFile";
        } else if (words[0] == "end_header") {
            if (!has_format) throw make_error("a line 'format ... 1.0' before end_header");
            return out;
        } else if (words[0] == "format" && words.size() == 3) {
            if (words[2] != "1.0") throw make_error("the version 1.0 of the format");
            has_format = true;
            if (words[1] == "ascii") out.format = Format::ascii;
            else if (words[1] == "binary_little_endian") out.format = Format::little;
            else if (words[1] == "binary_big_endian") out.format = Format::big;
            else throw make_error("the format ascii, binary_little_endian or binary_big_endian");
        } else if (words[0] == "element" && words.size() == 3) {
            Element element{std::string(words[1]), 0, {}};
            const auto [stop, error] =
                std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
            if (error != std::errc{} || stop != words[2].data() + words[2].size())
                throw make_error("a number of elements");
            out.elements.push_back(std::move(element));
        } else if (words[0] == "property" && !out.elements.empty() && words.size() == 3) {
            out.elements.back().properties.push_back({std::string(words[2]), &type_named(words[1], line), nullptr});
        } else if (words[0] == "property" && !out.elements.empty() && words.size() == 5 && words[1] == "list") {
            const Type& count = type_named(words[2], line);
            if (count.kind == 'f') throw make_error("a list whose length is an integer");
            out.elements.back().properties.push_back({std::string(words[4]), &type_named(words[3], line), &count});
        } else {
            throw make_error("a line of a PLY header");
        }
    }
    throw ModelError("expected the line end_header");
}

/// The numbers after the header, one after the other.
class Numbers {
public:
    Numbers(std::string_view bytes, Format format) : bytes_(bytes), format_(format) {}

    /// Throws ModelError if fewer bytes are left than so many rows need at least.
    void need_rows(const Element& element) const {
        std::size_t row_bytes = 0;
        for (const Property& property : element.properties)
            row_bytes +=
                format_ == Format::ascii ? 1 : (property.count_type ? property.count_type : property.type)->bytes;
        if (element.count > 0 && (row_bytes == 0 || element.count > (bytes_.size() + 1) / row_bytes))
            throw ModelError(fmt::format(
                "expected {} '{}', the file ends before", counted(element.count, "element[s]"), element.name));
    }
    /// Whether so many numbers of a type can still be there.
    bool has(std::size_t count, const Type& type) const {
        return count <= (bytes_.size() + 1) / (format_ == Format::ascii ? 1 : type.bytes);
    }

    /// The number of bytes after the last number, but for spaces.
    std::size_t rest() const {
        const bool is_blank = format_ == Format::ascii && bytes_.find_first_not_of(" \t\r\n") == bytes_.npos;
        return is_blank ? 0 : bytes_.size();
    }

    std::optional<double> next(const Type& type) {
        if (format_ == Format::ascii) return next_word();
        if (bytes_.size() < type.bytes) return std::nullopt;
        char bytes[8];
        std::memcpy(bytes, bytes_.data(), type.bytes);
        bytes_.remove_prefix(type.bytes);
        if ((format_ == Format::big) != (std::endian::native == std::endian::big))
            std::reverse(bytes, bytes + type.bytes);
        return value_of(bytes, type);
    }

private:
    template <class T> static double as(const char* bytes) {
        T out;
        std::memcpy(&out, bytes, sizeof out);
        return static_cast<double>(out);
    }
    static double value_of(const char* bytes, const Type& type) {
        const bool is_signed = type.kind == 'i';
        if (type.kind == 'f') return type.bytes == 4 ? as<float>(bytes) : as<double>(bytes);
        if (type.bytes == 1) return is_signed ? as<std::int8_t>(bytes) : as<std::uint8_t>(bytes);
        if (type.bytes == 2) return is_signed ? as<std::int16_t>(bytes) : as<std::uint16_t>(bytes);
        return is_signed ? as<std::int32_t>(bytes) : as<std::uint32_t>(bytes);
    }
    std::optional<double> next_word() {
        const std::size_t begin = bytes_.find_first_not_of(" \t\r\n");
        if (begin == bytes_.npos) return std::nullopt;
        bytes_.remove_prefix(begin);
        const std::string_view word = bytes_.substr(0, bytes_.find_first_of(" \t\r\n"));
        bytes_.remove_prefix(word.size());
        return number_in(word);
    }

    std::string_view bytes_;
    Format format_;
};

/// A number of a vertex, by its names.
constexpr std::pair<std::string_view, int> vertex_names[] = {{"x", 0}, {"y", 1}, {"z", 2}, {"nx", 3}, {"ny", 4},
    {"nz", 5}, {"u", 6}, {"v", 7}, {"s", 6}, {"t", 7}, {"texture_u", 6}, {"texture_v", 7}};

class PlyReader {
public:
    Model model;

    explicit PlyReader(std::string_view file)
        : header_(read_header(file)), in_(file.substr(header_.size), header_.format) {
        model.materials.push_back({});
        model.parts.emplace_back();
        for (const Element& element : header_.elements) {
            in_.need_rows(element);
            if (element.name == "vertex") {
                if (!part().positions.empty()) throw ModelError("expected one element 'vertex', found a second one");
                read_vertices(element);
            } else if (element.name == "face") read_lists(element, polygons_);
            else if (element.name == "tristrips") read_lists(element, strips_);
            else {
                for (std::size_t row = 0; row < element.count; ++row)
                    for (const Property& property : element.properties) (void)read(property, element, row);
                leave_out(element.count, element.name);
            }
        }
        for (std::size_t k = 0; k < polygons_.size(); ++k) add_polygon(polygons_[k], k);
        for (std::size_t k = 0; k < strips_.size(); ++k) add_strip(strips_[k], k);
        model.leave_out(header_.images, "image[s] of a comment TextureFile");
        model.leave_out(in_.rest(), "byte[s] after the last element");
        model.leave_out(points_and_lines_, "face[s] of fewer than three corners");
    }

private:
    using List = std::vector<double>;

    Part& part() { return model.parts[0]; }
    void leave_out(std::size_t count, const std::string& what) {
        if (count > 0) model.left_out.push_back(fmt::format("{} '{}'", counted(count, "element[s]"), what));
    }

    List read(const Property& property, const Element& element, std::size_t row) {
        const auto number = [&](const Type& type) {
            const std::optional<double> value = in_.next(type);
            if (!value)
                throw ModelError(fmt::format("{} {}: expected a number for '{}'", element.name, row, property.name));
            return *value;
        };
        if (!property.count_type) return {number(*property.type)};
        const double count = number(*property.count_type);
        constexpr double most_values = 4294967296;
        if (!(count >= 0 && count < most_values) || count != std::floor(count) ||
            !in_.has(static_cast<std::size_t>(count), *property.type))
            throw ModelError(
                fmt::format("{} {}: a list '{}' with the length {}, expected a whole number that the file has",
                    element.name, row, property.name, count));
        List out(static_cast<std::size_t>(count));
        for (double& value : out) value = number(*property.type);
        return out;
    }

    void read_vertices(const Element& element) {
        std::vector<int> meaning;
        bool has[8] = {};
        std::string other_names;
        for (const Property& property : element.properties) {
            const auto* entry = std::ranges::find(
                vertex_names, property.name, [](const auto& pair) -> std::string_view { return pair.first; });
            const bool is_known = entry != std::end(vertex_names) && !property.count_type;
            meaning.push_back(is_known ? entry->second : -1);
            if (is_known) has[entry->second] = true;
            else other_names += (other_names.empty() ? "" : ", ") + property.name;
        }
        if (!has[0] || !has[1] || !has[2]) throw ModelError("expected vertices with x, y and z");
        if (!other_names.empty() && element.count > 0) model.left_out.push_back("of the vertices: " + other_names);
        const bool has_normals = has[3] && has[4] && has[5], has_uv = has[6] && has[7];
        for (std::size_t row = 0; row < element.count; ++row) {
            double values[8] = {};
            for (std::size_t k = 0; k < meaning.size(); ++k) {
                const List list = read(element.properties[k], element, row);
                if (meaning[k] >= 0) values[meaning[k]] = list[0];
            }
            part().positions.push_back({values[0], values[1], values[2]});
            if (has_normals) part().normals.push_back(narrow({values[3], values[4], values[5]}));
            if (has_uv) part().uv.push_back({static_cast<float>(values[6]), static_cast<float>(values[7])});
        }
    }

    void read_lists(const Element& element, std::vector<List>& to) {
        std::string other_names;
        bool has_indices = false;
        for (const Property& property : element.properties) {
            if (is_indices(property)) has_indices = true;
            else other_names += (other_names.empty() ? "" : ", ") + property.name;
        }
        if (!has_indices)
            throw ModelError(fmt::format("expected a list 'vertex_indices' of the element '{}'", element.name));
        if (!other_names.empty() && element.count > 0)
            model.left_out.push_back(fmt::format("of the elements '{}': {}", element.name, other_names));
        for (std::size_t row = 0; row < element.count; ++row)
            for (const Property& property : element.properties) {
                List list = read(property, element, row);
                if (is_indices(property)) to.push_back(std::move(list));
            }
    }
    static bool is_indices(const Property& property) {
        return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
    }

    std::uint32_t checked(double index, const char* what, std::size_t row) {
        const std::size_t count = part().positions.size();
        if (!(index >= 0 && index < static_cast<double>(count)) || index != std::floor(index))
            throw ModelError(fmt::format(
                "{} {}: expected an index below the number of vertices, {}, not {}", what, row, count, index));
        return static_cast<std::uint32_t>(index);
    }

    void add_polygon(const List& list, std::size_t row) {
        if (list.size() > most_corners)
            throw ModelError(
                fmt::format("face {}: expected at most {} corners, found {}", row, most_corners, list.size()));
        std::vector<std::uint32_t> corners;
        for (const double index : list) corners.push_back(checked(index, "face", row));
        if (corners.size() < 3) ++points_and_lines_;
        else triangulate(part().positions, corners, part().triangles);
    }

    /// Every corner from the third on closes a triangle; -1 begins another strip.
    void add_strip(const List& list, std::size_t row) {
        std::vector<std::uint32_t> strip;
        for (const double index : list) {
            if (index == -1) {
                strip.clear();
                continue;
            }
            strip.push_back(checked(index, "tristrips", row));
            const std::size_t n = strip.size();
            if (n < 3) continue;
            const bool is_flipped = n % 2 == 0;
            part().triangles.push_back(
                {strip[n - (is_flipped ? 2 : 3)], strip[n - (is_flipped ? 3 : 2)], strip[n - 1]});
        }
    }

    Header header_;
    Numbers in_;
    std::vector<List> polygons_, strips_;
    std::size_t points_and_lines_ = 0;
};

}  // namespace

Model read_ply(const std::filesystem::path& file) { return PlyReader(bytes_of(file)).model; }

}  // namespace crescent::importer
