// Samplers known only from files: a table of p at points is less informative beyond its last row.
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "check/report/summary.h"
#include "check/sources/sample_file.h"
#include "check/user.h"
#include "math/simd/frame.h"
#include "tests/known_samplers/correct/right.h"

namespace crescent {
namespace samples_test {

/// A von Mises-Fisher lobe of kappa 20 about `axis`, its draws and p at the centres of 128 x 64 cells.
std::shared_ptr<const SamplerAdapter> lobe_in_files(Vec3d axis) {
    constexpr double kappa = 20;
    // Two of these programs may run at the same time.
    const std::string samples = testing::TempDir() + fmt::format("lobe-samples-{}.csv", ::getpid());
    const std::string table = testing::TempDir() + fmt::format("lobe-p-{}.csv", ::getpid());
    const Frame<double> frame = frame_about(axis);
    const auto p = [&](Vec3d w) {
        return kappa / (2 * pi * (1 - std::exp(-2 * kappa))) * std::exp(kappa * (dot(w, axis) - 1));
    };
    Rng dice(7);
    std::ofstream s(samples), t(table);
    s << "u1,u2,wix,wiy,wiz,pdf\n";
    for (int i = 0; i < 40000; ++i) {
        const double u = dice.uniform(0, 1), v = dice.uniform(0, 1),
                     c = 1 + std::log(u + (1 - u) * std::exp(-2 * kappa)) / kappa, r = std::sqrt(1 - c * c);
        const Vec3d w = frame.to_world({r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), c});
        s << fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", u, v, w.x, w.y, w.z, p(w));
    }
    t << "cos_theta,phi,pdf\n";
    for (int i = 0; i < 128; ++i)
        for (int k = 0; k < 64; ++k) {
            const double z = (i + 0.5) / 64 - 1, phi = 2 * pi * (k + 0.5) / 64, r = std::sqrt(1 - z * z);
            t << fmt::format("{:.9g},{:.9g},{:.9g}\n", z, phi, p({r * std::cos(phi), r * std::sin(phi), z}));
        }
    s.close();
    t.close();
    const auto out = std::make_shared<SampleFile>(samples, table);
    std::filesystem::remove(samples);
    std::filesystem::remove(table);
    return out;
}

TEST(SamplesOfFiles, CoarseTableNearAPoleIsNotWrong) {
    for (const double degrees : {5.0, 20.0}) {
        const double angle = degrees * pi / 180;
        ProgressMonitor monitor;
        const CheckCase check_case = make_user_case(lobe_in_files({std::sin(angle), 0, std::cos(angle)}), 0, 0);
        const CheckResult j = run_checks({&check_case, 1}, TestSettings::quick(), monitor);
        EXPECT_NE(j.state, State::wrong) << degrees << " deg: " << what_is_wrong(j);
    }
}

}  // namespace samples_test
}  // namespace crescent
