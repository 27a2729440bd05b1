// What a lobe reflects of an even white light: A(theta_o) = integral of lobe(wo, wi) cos(theta_i) over the upper
// hemisphere. A function of one angle for every isotropic lobe; tabulated once, in double precision.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "lobes/info.h"

namespace crescent::inline reference {

/// Called before every `steps` steps, a tenth of a microsecond each, on the thread that takes them, so that a page
/// stays responsive: near the horizon one albedo takes millions of steps.
using MakeWay = std::function<void(std::size_t steps)>;

/// A at one angle by adaptive quadrature: lobes about R to about 1e-10, lobes about the half vector to about 1e-6.
double lobe_albedo(LobeKind kind, double s, double alpha, double cos_o, const MakeWay& make_way = {});

/// The same for many angles: interpolation through five quadratures a cell, cells halved until their own error is below
/// 1e-7 (1e-6 for the half-vector lobes) or they are 2^-15 of a right angle: those that a lobe's edge runs through.
class LobeAlbedo {
public:
    LobeAlbedo(LobeKind kind, double s, double alpha, const MakeWay& make_way = {});
    double operator()(double cos_o) const;
    /// Largest difference to quadrature seen between the nodes about this angle, and the quadrature's own.
    double error(double cos_o) const;

private:
    struct Cell {
        double from = 0, size = 0;  // theta_o
        std::array<double, 5> value{};
        double error = 0;
    };
    const Cell& cell(double theta) const;
    std::vector<Cell> cells_;
};

}  // namespace crescent::inline reference
