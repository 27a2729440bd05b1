// A check of a user's sampler: a struct with sample(wo, u) and pdf(wo, wi) in plain floats. Prints what is wrong.
#include <array>
#include <cmath>
#include <cstdio>

#include <crescent/check.h>

struct MySampler {
    struct Drawn {
        std::array<float, 3> wi;
        float pdf;
    };
    Drawn sample(std::array<float, 3> /*wo*/, std::array<float, 2> u) const {
        const float r = std::sqrt(u[0]), phi = 6.2831853f * u[1], z = std::sqrt(1 - u[0]);
        return {{r * std::cos(phi), r * std::sin(phi), z}, z / 3.14159265f};
    }
    float pdf(std::array<float, 3> /*wo*/, std::array<float, 3> wi) const {
        return wi[2] > 0 ? wi[2] / 3.14159265f : 0;
    }
};

int main() {
    const crescent::CheckResult j = crescent::check_sampler("mine", MySampler{});
    std::printf("%s\n%s", crescent::word(j.state).data(), crescent::what_is_wrong(j).c_str());
    return j.state == crescent::State::right ? 0 : 1;
}
