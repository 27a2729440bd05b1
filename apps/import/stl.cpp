// STL (3D Systems 1989, "StereoLithography Interface Specification"), in ASCII and in binary. A binary file has 84
// bytes and 50 for each triangle; its first word may be `solid` too. Normals are those of the triangles, and are not
// read.
#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "lines.h"
#include "little_endian.h"
#include "model.h"
#include "polygon.h"

namespace crescent::importer {

namespace {

constexpr std::size_t header_bytes = 80, triangle_bytes = 50;

void add_polygon(const std::vector<Vec3d>& corners, Part& to) {
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    std::vector<std::uint32_t> indices;
    for (std::uint32_t k = 0; k < corners.size(); ++k) indices.push_back(first + k);
    to.positions.insert(to.positions.end(), corners.begin(), corners.end());
    triangulate(to.positions, indices, to.triangles);
}

Model read_binary(std::string_view file) {
    Model out;
    out.materials.emplace_back();
    out.parts.emplace_back();
    const std::size_t count = little_endian<std::uint32_t>(file.data() + header_bytes);
    for (const char* word : {"COLOR=", "MATERIAL="})  // of Materialise Magics
        if (file.substr(0, header_bytes).find(word) != file.npos)
            out.left_out.push_back(fmt::format("{} of the header", word));
    file.remove_prefix(header_bytes + 4);
    if (file.size() / triangle_bytes < count)
        throw ModelError(fmt::format("byte {}: expected {}, the file ends after {}", header_bytes,
            counted(count, "triangle[s]"), file.size() / triangle_bytes));
    std::size_t attributes = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const char* bytes = file.data() + k * triangle_bytes;
        Triangle triangle;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const char* from = bytes + 12 * (corner + 1);
            triangle[corner] = static_cast<std::uint32_t>(3 * k + corner);
            out.parts[0].positions.push_back(widen(
                Vec3f{little_endian<float>(from), little_endian<float>(from + 4), little_endian<float>(from + 8)}));
        }
        out.parts[0].triangles.push_back(triangle);
        attributes += little_endian<std::uint16_t>(bytes + 48) != 0;
    }
    out.leave_out(attributes, "attribute[s] or colour[s] of triangles");
    out.leave_out(file.size() - count * triangle_bytes, "byte[s] after the last triangle");
    return out;
}

/// Statements of the text: solid NAME, facet normal X Y Z, outer loop, three times vertex X Y Z, endloop, endfacet,
/// endsolid. Blanks and ends of lines separate words alike, but for names.
Model read_ascii(std::string_view file, const ReadingScope& scope) {
    Model out;
    out.materials.emplace_back();
    std::vector<Vec3d> corners;
    std::size_t line = 0, begin_of_loop = 0;
    const auto make_error = [&](std::string_view expected) {
        return ModelError(fmt::format("line {}: expected {}", line, expected));
    };
    const std::string text = joined_lines(file, false);
    Statements statements(text);
    while (const std::optional<Statement> statement = statements.next()) {
        line = statement->line;
        std::string key = lower_case(statement->key);
        std::string_view words = statement->value;
        if (key == "solid") {
            begin_of_loop = 0;
            out.parts.emplace_back();
            if (!words.empty() && scope.whole_scene) out.parts.back().names.emplace_back(words);
            continue;
        }
        if (out.parts.empty()) throw make_error("the word solid");
        // Several statements of a facet may be on a line.
        for (; !key.empty() && key != "endsolid"; key = lower_case(take_word(words))) {
            const auto numbers = [&] {
                std::array<double, 3> x{};
                for (double& value : x) {
                    const std::optional<double> number = number_in(take_word(words));
                    if (!number)
                        throw make_error(fmt::format("three numbers after '{}'", key == "facet" ? "normal" : key));
                    value = *number;
                }
                return Vec3d{x[0], x[1], x[2]};
            };
            if (key == "facet") {
                if (lower_case(take_word(words)) != "normal") throw make_error("'normal' after 'facet'");
                (void)numbers();
            } else if (key == "outer") {
                if (lower_case(take_word(words)) != "loop") throw make_error("'loop' after 'outer'");
                corners.clear();
                begin_of_loop = line;
            } else if (key == "vertex") {
                if (begin_of_loop == 0) throw make_error("'outer loop' before 'vertex'");
                corners.push_back(numbers());
                if (corners.size() > most_corners) throw make_error(fmt::format("at most {} corners", most_corners));
            } else if (key == "endloop") {
                if (corners.size() < 3) throw make_error("three corners before 'endloop'");
                add_polygon(corners, out.parts.back());
                begin_of_loop = 0;
            } else if (key != "endfacet") {
                throw make_error(
                    fmt::format("facet, outer loop, vertex, endloop, endfacet or endsolid, not '{}'", key));
            }
        }
    }
    if (begin_of_loop > 0)
        throw ModelError(fmt::format("line {}: expected 'endloop' after 'outer loop'", begin_of_loop));
    return out;
}

}  // namespace

Model read_stl(const std::filesystem::path& file, const ReadingScope& scope) {
    const std::string bytes = bytes_of(file);
    const std::size_t text_begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
    const bool says_solid =
        lower_case(std::string_view(bytes).substr(text_begin, 5)) == "solid" || bytes.starts_with("\xef\xbb\xbf");
    const bool has_header = bytes.size() >= header_bytes + 4;
    // Text has no byte 0, which the lengths and exponents of a binary file have.
    const bool is_text = says_solid && bytes.find('\0') == bytes.npos;
    if (is_text) return read_ascii(bytes, scope);
    if (!has_header) throw ModelError("expected the word solid, or a header of 84 bytes");
    return read_binary(bytes);
}

}  // namespace crescent::importer
