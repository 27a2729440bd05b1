// Linear equations of a few unknowns.
#pragma once

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace crescent::inline statistics {

/// Gauss elimination, the largest pivot first; empty if a pivot is below `least` of its original value.
inline std::optional<std::vector<double>> solved(
    std::vector<std::vector<double>> a, std::vector<double> b, double least) {
    const std::size_t n = b.size();
    std::vector<double> size(n);
    for (std::size_t k = 0; k < n; ++k) size[k] = a[k][k];
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k; i < n; ++i)
            if (std::fabs(a[i][k]) > std::fabs(a[pivot][k])) pivot = i;
        if (!(std::fabs(a[pivot][k]) > least * size[k])) return {};
        std::swap(a[k], a[pivot]), std::swap(b[k], b[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double by = a[i][k] / a[k][k];
            for (std::size_t j = k; j < n; ++j) a[i][j] -= by * a[k][j];
            b[i] -= by * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return b;
}

}  // namespace crescent::inline statistics
