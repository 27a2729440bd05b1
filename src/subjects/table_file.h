// Rows of numbers under named columns, from CSV with a header line or from NPY; every mistake with its file, line and
// column.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace crescent::inline subjects {

/// Collects the mistakes of one file; throws InputError at the tenth, or in throw_if_any().
struct FileDiagnostics {
    std::string path;
    std::vector<Diagnostic> all;
    void add(unsigned line, unsigned column, const std::string& message) {
        all.push_back({{path, line, column}, message});
        if (all.size() >= 10) throw InputError(all);
    }
    void throw_if_any() const {
        if (!all.empty()) throw InputError(all);
    }
};

struct NumberTable {
    std::vector<std::string> columns;
    std::vector<double> values;   // row by row
    std::vector<unsigned> lines;  // of the file, by row; empty where it has none
    std::size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
    double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
    int column(std::string_view name) const;
};

/// .npy has no names: the one of `layouts` with as many columns applies. CSV must have all columns of one layout and no
/// others.
NumberTable read_table_file(FileDiagnostics& in, const std::vector<std::vector<std::string>>& layouts);

}  // namespace crescent::inline subjects
