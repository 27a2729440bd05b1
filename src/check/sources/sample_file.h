// Rows of numbers with named columns, from CSV with a header line or from NPY; every mistake is reported with file,
// line and column.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "check/sources/density_grid.h"
#include "check/sources/recorded_sampler.h"

namespace crescent {

/// Collects the mistakes of one file; throws InputError at the tenth, or in throw_if_any().
struct FileDiagnostics {
    std::string path;
    std::vector<Diagnostic> diagnostics;
    /// Throws InputError with all mistakes at the tenth.
    void add(unsigned line, unsigned column, const std::string& message) {
        diagnostics.push_back({{path, line, column}, message});
        if (diagnostics.size() >= 10) throw InputError(diagnostics);
    }
    /// Throws InputError with all mistakes, if there are any.
    void throw_if_any() const {
        if (!diagnostics.empty()) throw InputError(diagnostics);
    }
};

/// Named columns of numbers, row by row.
struct NumberTable {
    std::vector<std::string> columns;
    std::vector<double> values;   // row by row
    std::vector<unsigned> lines;  // line of the file by row; empty if it has none
    std::size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
    double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
    int column(std::string_view name) const;
    double value(std::size_t row, std::string_view name) const {
        return at(row, static_cast<std::size_t>(column(name)));
    }
    /// The line of the file; 0 if it has none.
    unsigned line(std::size_t row) const { return lines.empty() ? 0 : lines[row]; }
};

/// .npy has no names: the layout with the same number of columns applies. CSV must have exactly the columns of one
/// layout.
NumberTable read_table_file(FileDiagnostics& in, const std::vector<std::vector<std::string>>& layouts);

// ---- What files of draws have in common, over directions and over points.

/// Draws of which there are enough for a check. Throws InputError.
NumberTable read_draws(FileDiagnostics& in, const std::vector<std::vector<std::string>>& layouts);
/// Reports u1 and u2 of a row, if there are such columns, that are not in [0, 1].
void check_numbers(FileDiagnostics& in, const NumberTable& draws, std::size_t row);
/// The grid of a table. Throws InputError with what it lacks.
DensityGrid grid_of(FileDiagnostics& in, std::vector<GridAxis> axes, std::span<const double> rows);
/// Reports axes whose entries end more than a step before the domain does: p beyond them is not known. rows: as of
/// grid_of().
void check_coverage(FileDiagnostics& in, const NumberTable& table, std::span<const GridAxis> axes,
    const DensityGrid& grid, std::span<const double> rows);
/// cos theta and phi of directions; number: appended to the names.
std::array<GridAxis, 2> direction_axes(bool is_sphere, const std::string& number = "");
/// "samples.csv:17", or "samples.npy, row 16" without lines.
std::string place_of_row(const std::string& name, std::span<const unsigned> lines, std::size_t row);

/// A table is read as cells if nine of ten draws have exactly the value of their cell.
struct CellAgreement {
    std::size_t draw_count = 0, agreement_count = 0;
    /// A draw with pdf p > 0 in a cell with this value.
    void add(double cell_value, double p) {
        ++draw_count;
        agreement_count += std::fabs(cell_value - p) <= 1e-4 * p;
    }
    /// Whether the table is read as cells.
    bool holds() const { return 10 * agreement_count >= 9 * draw_count; }
};

// ---- Samples of a user's sampler, from a file, at one w_o: CSV with a header line, or NPY (a plain float array,
// columns in this order).
//   u1,u2,wix,wiy,wiz,pdf[,f]         f without the cosine, 1/sr
// The density is from a table, wix,wiy,wiz,pdf or cos_theta,phi,pdf (phi in radians): a full grid in cos theta and phi,
// over the sphere or over the hemisphere. It is read as cells, with constant p and the entries at their centres, if the
// pdf of the samples agrees with that; otherwise as a grid of points with bilinear p, which is known only to the
// curvature between points, and the tests allow for that error.

/// Draws from a file, with the density from an optional second file. docs/samplers.md has both formats.
class SampleFile : public RecordedSampler {
public:
    /// Throws InputError with file, line and column of every mistake, at most ten.
    SampleFile(const std::string& samples, const std::string& table);
    std::string name() const override { return name_; }
    bool has_drawn_f() const override { return has_drawn_f_; }
    void pdf(int, std::span<const Pair> pairs, std::span<double> out) const override;
    double tabulation_error(Vec3d w) const override;
    std::string place(std::size_t row) const override;

private:
    std::string name_;
    bool has_drawn_f_ = false, has_cells_ = true;
    std::vector<unsigned> lines_;
    DensityGrid grid_;   // of cos theta and phi
    double floor_ = -1;  // the least cos theta; p is 0 below
    void read_samples(const std::string& path);
    void read_table(const std::string& path);
    bool agrees_as_cells() const;
    double cell_value(Vec3d w) const;
};

}  // namespace crescent
