#include "verdicts/samples.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "base/errors.h"
#include "simd/scalar.h"

namespace crescent {

namespace {

/// Rows of numbers under named columns.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<double>> rows;
    int column(std::string_view name) const {
        const auto at = std::find(columns.begin(), columns.end(), name);
        return at == columns.end() ? -1 : static_cast<int>(at - columns.begin());
    }
};

struct Reader {
    std::string path;
    std::vector<Complaint> complaints;
    void complain(unsigned line, unsigned column, const std::string& say) {
        complaints.push_back({{path, line, column}, say});
        if (complaints.size() >= 10) throw InputError(complaints);
    }
    void settle() const {
        if (!complaints.empty()) throw InputError(complaints);
    }
};

std::string trimmed(std::string s) {
    const auto from = s.find_first_not_of(" \t\r");
    return from == std::string::npos ? "" : s.substr(from, s.find_last_not_of(" \t\r") - from + 1);
}

Table read_csv(Reader& in, std::istream& file) {
    Table t;
    std::string text;
    for (unsigned line = 1; std::getline(file, text); ++line) {
        if (trimmed(text).empty()) continue;
        std::vector<double> row;
        unsigned column = 1;
        std::stringstream cells(text);
        for (std::string cell; std::getline(cells, cell, ','); column += static_cast<unsigned>(cell.size()) + 1) {
            const std::string word = trimmed(cell);
            if (t.columns.empty() || t.rows.empty() ? line == 1 : false) {
                row.push_back(0);
                t.columns.push_back(word);
                continue;
            }
            double v = 0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v);
            if (error != std::errc{} || end != word.data() + word.size()) in.complain(line, column, "expected a number, not '" + word.substr(0, 40) + "'");
            row.push_back(v);
        }
        if (line == 1) continue;
        if (row.size() != t.columns.size()) in.complain(line, 1, fmt::format("expected {} values, as the header has, not {}", t.columns.size(), row.size()));
        else t.rows.push_back(std::move(row));
    }
    if (t.columns.empty()) in.complain(1, 1, "the file is empty; expected a header line");
    in.settle();
    return t;
}

Table read_npy(Reader& in, std::istream& file, const std::vector<std::string>& names) {
    char magic[10];
    if (!file.read(magic, 10) || std::memcmp(magic, "\x93NUMPY", 6) != 0) in.complain(0, 0, "not an NPY file"), in.settle();
    std::uint32_t length = static_cast<unsigned char>(magic[8]) | static_cast<unsigned>(static_cast<unsigned char>(magic[9])) << 8;
    if (magic[6] > 1) {
        char more[2];
        file.read(more, 2);
        length |= static_cast<unsigned>(static_cast<unsigned char>(more[0])) << 16 | static_cast<unsigned>(static_cast<unsigned char>(more[1])) << 24;
    }
    if (length > 65536) in.complain(0, 0, "the NPY header is too long"), in.settle();
    std::string header(length, ' ');
    file.read(header.data(), static_cast<std::streamsize>(length));
    std::smatch type, shape;
    const bool known = std::regex_search(header, type, std::regex("'descr':\\s*'<f([48])'")) && std::regex_search(header, shape, std::regex("'shape':\\s*\\((\\d+),\\s*(\\d+)\\)")) &&
                       header.find("'fortran_order': False") != std::string::npos;
    if (!known) in.complain(0, 0, "expected a two-dimensional array of <f4 or <f8 in C order, not " + trimmed(header).substr(0, 100)), in.settle();
    const std::size_t rows = std::stoull(shape[1]), columns = std::stoull(shape[2]), size = type[1] == "4" ? 4 : 8;
    if (columns < 6 || columns > names.size()) in.complain(0, 0, fmt::format("expected 6 or 7 columns, u1,u2,wix,wiy,wiz,pdf[,f], not {}", columns)), in.settle();
    Table t;
    t.columns.assign(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(columns));
    std::vector<char> raw(columns * size);
    for (std::size_t r = 0; r < rows; ++r) {
        if (!file.read(raw.data(), static_cast<std::streamsize>(raw.size()))) in.complain(0, 0, fmt::format("the file ends in row {} of {}", r + 1, rows)), in.settle();
        std::vector<double> row;
        for (std::size_t c = 0; c < columns; ++c) {
            float single;
            double whole;
            if (size == 4) std::memcpy(&single, &raw[4 * c], 4), row.push_back(static_cast<double>(single));
            else std::memcpy(&whole, &raw[8 * c], 8), row.push_back(whole);
        }
        t.rows.push_back(std::move(row));
    }
    return t;
}

/// Centres -> edges of cells.
std::vector<double> edges_of(const std::vector<double>& centres, double first, double last) {
    std::vector<double> out = {first};
    for (std::size_t i = 0; i + 1 < centres.size(); ++i) out.push_back(0.5 * (centres[i] + centres[i + 1]));
    out.push_back(last);
    return out;
}

std::vector<double> distinct(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    std::vector<double> out;
    for (double x : v)
        if (out.empty() || x - out.back() > 1e-6) out.push_back(x);
    return out;
}

std::size_t cell_of(const std::vector<double>& edges, double v) {
    const auto at = std::upper_bound(edges.begin(), edges.end(), v) - edges.begin() - 1;
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(edges.size()) - 2));
}

double turned(double phi) { return phi < 0 ? phi + 2 * pi : phi; }

}  // namespace

SampleFile::SampleFile(const std::string& samples, const std::string& table) : name_(samples) {
    Reader in{samples, {}};
    std::ifstream file(samples, std::ios::binary);
    if (!file) in.complain(0, 0, "cannot be read"), in.settle();
    const std::vector<std::string> names = {"u1", "u2", "wix", "wiy", "wiz", "pdf", "f"};
    const Table t = samples.ends_with(".npy") ? read_npy(in, file, names) : read_csv(in, file);
    int column[6];
    for (std::size_t i = 0; i < 6; ++i)
        if ((column[i] = t.column(names[i])) < 0) in.complain(1, 1, "no column '" + names[i] + "'; expected u1,u2,wix,wiy,wiz,pdf[,f]");
    in.settle();
    if (t.rows.size() < 1000) in.complain(0, 0, fmt::format("{} samples are too few to judge; expected 1000 at least", t.rows.size())), in.settle();
    for (const std::vector<double>& r : t.rows) {
        const auto at = [&](int i) { return r[static_cast<std::size_t>(column[i])]; };
        u_.push_back({at(0), at(1)});
        draws_.push_back({{at(2), at(3), at(4)}, at(5), {}});
    }
    read_table(table);
}

void SampleFile::read_table(const std::string& path) {
    Reader in{path, {}};
    std::ifstream file(path);
    if (!file) in.complain(0, 0, "cannot be read"), in.settle();
    const Table t = read_csv(in, file);
    const bool polar = t.column("cos_theta") >= 0;
    const std::vector<std::string> wanted = polar ? std::vector<std::string>{"cos_theta", "phi", "pdf"} : std::vector<std::string>{"wix", "wiy", "wiz", "pdf"};
    for (const std::string& name : wanted)
        if (t.column(name) < 0) in.complain(1, 1, "no column '" + name + "'; expected wix,wiy,wiz,pdf or cos_theta,phi,pdf");
    in.settle();
    std::vector<double> cos, phi, p;
    for (const std::vector<double>& r : t.rows) {
        const auto at = [&](const char* name) { return r[static_cast<std::size_t>(t.column(name))]; };
        cos.push_back(polar ? at("cos_theta") : at("wiz"));
        phi.push_back(turned(polar ? at("phi") : std::atan2(at("wiy"), at("wix"))));
        p.push_back(at("pdf"));
    }
    const std::vector<double> rows = distinct(cos), columns = distinct(phi);
    if (rows.size() < 2 || columns.size() < 2 || rows.size() * columns.size() != p.size())
        in.complain(0, 0, fmt::format("expected a full grid: {} heights of cos theta and {} angles phi are not {} entries", rows.size(), columns.size(), p.size())), in.settle();
    cos_ = edges_of(rows, rows.front() < 0 ? -1 : 0, 1);
    phi_ = edges_of(columns, 0, 2 * pi);
    values_.assign(p.size(), 0);
    for (std::size_t i = 0; i < p.size(); ++i) values_[cell_of(cos_, cos[i]) * columns.size() + cell_of(phi_, phi[i])] = p[i];
}

void SampleFile::pdf(int, std::span<const Pair> at, std::span<double> out) const {
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Vec3d w = at[i].wi;
        out[i] = w.z < cos_.front() ? 0 : values_[cell_of(cos_, w.z) * (phi_.size() - 1) + cell_of(phi_, turned(std::atan2(w.y, w.x)))];
    }
}

}  // namespace crescent
