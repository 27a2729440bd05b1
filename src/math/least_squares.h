// A few unknowns by least squares of rows whose products should equal one.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
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

/// x with x . row = 1 at most rows, by least squares, repeated twice without the tenth with the largest residuals,
/// keeping at least `fewest`. Empty if the rows are nearly dependent (`least`, see solved()).
inline std::optional<std::vector<double>> solved_for_one(
    std::span<const std::vector<double>> rows, std::size_t fewest, double least) {
    if (rows.size() < fewest || rows.empty()) return {};
    const std::size_t n = rows[0].size();
    std::vector<std::pair<double, std::size_t>> at;  // residual and row
    for (std::size_t k = 0; k < rows.size(); ++k) at.push_back({0, k});
    std::optional<std::vector<double>> x;
    for (int round = 0; round < 3; ++round) {
        std::vector<std::vector<double>> normal(n, std::vector<double>(n));
        std::vector<double> right(n);
        for (const auto& [off, k] : at)
            for (std::size_t i = 0; i < n; ++i) {
                right[i] += rows[k][i];
                for (std::size_t j = 0; j < n; ++j) normal[i][j] += rows[k][i] * rows[k][j];
            }
        x = solved(std::move(normal), std::move(right), least);
        if (!x) return {};
        for (auto& [off, k] : at) {
            double sum = -1;
            for (std::size_t i = 0; i < n; ++i) sum += (*x)[i] * rows[k][i];
            off = std::fabs(sum);
        }
        std::sort(at.begin(), at.end());
        at.resize(std::max(at.size() * 9 / 10, fewest));
    }
    return x;
}

}  // namespace crescent::inline statistics
