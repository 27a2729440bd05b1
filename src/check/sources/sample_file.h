// Rows of numbers with named columns, from CSV with a header line or from NPY; every mistake is reported with file,
// line and column.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "check/sources/density_grid.h"
#include "check/sources/sampler_adapter.h"

namespace crescent {

/// Collects the mistakes of one file; throws InputError at the tenth, or in throw_if_any().
struct FileDiagnostics {
    std::string path;
    std::vector<Diagnostic> all;
    /// Throws InputError with all mistakes at the tenth.
    void add(unsigned line, unsigned column, const std::string& message) {
        all.push_back({{path, line, column}, message});
        if (all.size() >= 10) throw InputError(all);
    }
    /// Throws InputError with all mistakes, if there are any.
    void throw_if_any() const {
        if (!all.empty()) throw InputError(all);
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
};

/// .npy has no names: the layout with the same number of columns applies. CSV must have exactly the columns of one
/// layout.
NumberTable read_table_file(FileDiagnostics& in, const std::vector<std::vector<std::string>>& layouts);

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
    bool has_drawn_f_ = false, cells_ = true;
    std::vector<unsigned> lines_;
    DensityGrid grid_;   // of cos theta and phi
    double floor_ = -1;  // the least cos theta; p is 0 below
    void read_samples(const std::string& path);
    void read_table(const std::string& path);
    bool agrees_as_cells() const;
    double of_cell(Vec3d w) const;
};

}  // namespace crescent
