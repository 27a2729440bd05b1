// What mass each bin of a trial should hold: int p over rings and sectors about the normal or about the lobe.
#pragma once

#include <optional>
#include <vector>

#include "trials/integrals.h"

namespace crescent::inline trials {

/// The bins of one technique's density and their expected mass.
struct Density {
    SphereMap map{Vec3d{0, 0, 1}};
    bool about_n = true;
    std::vector<double> rings;  // ascending edges of a = 1 - cos, first 0, last 2
    int sectors = 0;
    Integral mass;
    std::optional<Integral> second;         // in other coordinates, where the first does not come to one
    std::vector<double> tabulation_errors;  // by bin, where p was tabulated; else empty
    double tabulation_error = 0;            // their sum
    double nothing = 0, nothing_se = 0;     // share of draws that draw nothing or a delta part, randomised lattice
    double delta = 0;                       // of these a delta part
    std::size_t bin_of(Vec2d at) const;
};

/// The layer of a trial that bins.
class Densities : public Integrals {
public:
    using Integrals::Integrals;
    void measure_density();  // fills density(); apart, since an invalid sampler has none
    const Density& density(int technique) const { return density_[static_cast<std::size_t>(technique)]; }

private:
    std::vector<Density> density_;
    std::optional<Vec3d> banded_;  // the axis about which p jumps at heights alone
    std::vector<double> heights_;  // these, as 1 - cos
    struct Lobe;
    static Lobe lobe_of(const SampleBatch& b);
    Density density_of(int technique);
    std::optional<Density> table_density(int technique);
    Density density_of_estimates(int technique, Vec3d axis);
    Density density_about(int technique, Vec3d axis, bool about_n, std::size_t evaluations, double edge_mass = 4e-4,
        std::optional<std::size_t> known = {})
        const;  // known: answers that cost nothing; throws where questions run out
    Integral second_mass(int technique, Vec3d axis, bool about_n) const;
    std::optional<Integral> mass_by_caps(int technique, const Density& bins) const;
    bool measure_by_caps(int technique, Density& d) const;
    void measure_about_others(int technique, const Lobe& lobe, Density& d) const;
    void measure_further(int technique, Density& d) const;
    Integral mass_inside_pole(int technique, const Density& d, std::vector<Rect> cells, const Effort& effort) const;
    Density bins_about(Vec3d axis, bool about_n) const;
    void add_edges_of_support(Density& d) const;
    std::vector<Rect> cells_of(const Density& d) const;
    Batch while_affordable(Batch ask) const;
    Batch batch_of(int technique, const SphereMap& map) const;
    SamplesPerBin samples_per_bin_of(int technique, const Density& d) const;
    void grant_tabulation_error(int technique, Density& d) const;
    void refine_table(int technique, Density& d) const;
    void share_nothing(int technique, Density& d) const;
    void estimate_null_fraction(int technique, Density& d, std::uint64_t points, std::optional<double> told) const;
    bool all_alike_below(int technique) const;
};

}  // namespace crescent::inline trials
