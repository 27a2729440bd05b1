// The functions of simd/math.h on avx512; the flags stand in laws/CMakeLists.txt.
#define CRESCENT_ISA avx512
#include "simd/pack.h"
// clang-format off
#include "simd/math_table_test.h"

namespace crescent::test {

MathTable avx512_math() { return math_table<avx512::Pack>(); }

}  // namespace crescent::test
