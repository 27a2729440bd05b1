// The functions of simd/math.h over arrays, in the packs of one instruction set: math_<isa>_test.cpp makes the table,
// math_isa_test.cpp calls each. Plain arrays and no library calls, because these files are compiled for processors that
// the machine may not have.
#pragma once

#include <cstddef>

#include "math/simd/math.h"

namespace crescent::test {

/// n is a multiple of 32; x, y and out are n long, a and b and unit three arrays of n one after another.
struct MathTable {
    void (*sin)(const float* x, float* out, std::size_t n);
    void (*cos)(const float* x, float* out, std::size_t n);
    void (*exp2)(const float* x, float* out, std::size_t n);
    void (*pow)(const float* x, const float* y, float* out, std::size_t n);
    void (*pow_one_minus)(const float* x, const float* y, float* out, std::size_t n);
    void (*root)(const float* x, const float* y, float* out, std::size_t n);
    void (*root_one_minus)(const float* x, const float* y, float* out, std::size_t n);
    void (*log_one_minus)(const float* u, float* out, std::size_t n);
    void (*cosine_power)(const float* a, const float* b, const float* s, float* out, std::size_t n);
    void (*normalize)(const float* a, float* unit, std::size_t n);
};

MathTable scalar_math();
MathTable sse4_math();
MathTable avx2_math();
MathTable avx512_math();

template <class F, class Work> void each_pack(std::size_t n, Work&& work) {
    for (std::size_t k = 0; k < n; k += Lanes<F>::count) work(k);
}
template <class F> Vec3<F> load_three(const float* a, std::size_t k, std::size_t n) {
    return {load_as<F>(a + k), load_as<F>(a + n + k), load_as<F>(a + 2 * n + k)};
}

template <class F> MathTable math_table() {
    MathTable t;
    t.sin = [](const float* x, float* out, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) { store(sincos_turns(load_as<F>(x + k)).sin, out + k); });
    };
    t.cos = [](const float* x, float* out, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) { store(sincos_turns(load_as<F>(x + k)).cos, out + k); });
    };
    t.exp2 = [](const float* x, float* out, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) { store(exp2(load_as<F>(x + k)), out + k); });
    };
    t.pow = [](const float* x, const float* y, float* out, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) { store(pow(load_as<F>(x + k), load_as<F>(y + k)), out + k); });
    };
    t.pow_one_minus = [](const float* x, const float* y, float* out, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) { store(power(load_as<F>(x + k), load_as<F>(y + k)).one_minus, out + k); });
    };
    t.root = [](const float* x, const float* y, float* out, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) { store(root(load_as<F>(x + k), load_as<F>(y + k)).value, out + k); });
    };
    t.root_one_minus = [](const float* x, const float* y, float* out, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) { store(root(load_as<F>(x + k), load_as<F>(y + k)).one_minus, out + k); });
    };
    t.log_one_minus = [](const float* u, float* out, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) { store(log_one_minus(load_as<F>(u + k)), out + k); });
    };
    t.cosine_power = [](const float* a, const float* b, const float* s, float* out, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) {
            store(cosine_power(load_three<F>(a, k, n), load_three<F>(b, k, n), load_as<F>(s + k)), out + k);
        });
    };
    t.normalize = [](const float* a, float* unit, std::size_t n) {
        each_pack<F>(n, [=](std::size_t k) {
            const Vec3<F> v = normalize(load_three<F>(a, k, n));
            store(v.x, unit + k);
            store(v.y, unit + n + k);
            store(v.z, unit + 2 * n + k);
        });
    };
    return t;
}

}  // namespace crescent::test
