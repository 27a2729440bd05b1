// Arrays of a query for Python, and the context of its rows in a scene: a dict of arrays, one row a row of u. Of s,
// alpha, rho_d and rho_s those that the sampler uses, and for lights `position`, `normal`, `edge_u`, `edge_v` [n,K,3],
// `shines` [n,K] and the constants `kind` (a list of K texts), `radius` [K] and `radiance` [K,3].
// crescent/_context.py makes a sampler's third argument of it.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "watched.h"

namespace crescent::python {

/// An array that is filled before Python owns it: rows, and the shape of one row. Columns are contiguous: an array
/// [n, K, 3] has one for each of its 3 K components.
class Table {
public:
    Table(std::string name, std::size_t rows, std::vector<std::size_t> of_row);
    const std::string& name() const { return name_; }
    std::size_t columns() const { return columns_; }
    double* column(std::size_t k) { return data_.get() + k * rows_; }
    /// With the lock held, once.
    nb::object take();

private:
    std::string name_;
    std::size_t rows_;
    std::vector<std::size_t> of_row_;
    std::size_t columns_ = 1;
    std::unique_ptr<double[]> data_;
};

/// The random numbers of a query.
Table numbers_of(const NumberRows& u, std::size_t count);
/// w_o of each row of a query.
Table outgoing_of(const SamplerQuery& query);
/// w_i of each pair.
Table incident_of(std::span<const Pair> pairs);
/// The densities of each of K samplers.
Table densities_of(const SamplerQuery& query);

/// The arrays of the quantities in `uses`.
std::vector<Table> context_of(const SceneRows& scene, std::size_t rows, const std::set<std::string>& uses);
/// Adds the constants of the lights, with the lock held.
void put_lights(std::span<const SceneLight> lights, nb::dict& to);

}  // namespace crescent::python
