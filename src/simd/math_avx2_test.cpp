// The functions of simd/math.h on avx2; the flags stand in laws/CMakeLists.txt.
#define CRESCENT_ISA avx2
#include "simd/pack.h"
// clang-format off
#include "simd/math_table_test.h"

namespace crescent::test {

MathTable avx2_math() { return math_table<avx2::Pack>(); }

}  // namespace crescent::test
