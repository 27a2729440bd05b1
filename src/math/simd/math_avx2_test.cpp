// The functions of simd/math.h on avx2; tests/CMakeLists.txt has the flags.
#define CRESCENT_ISA avx2
#include "math/simd/pack.h"
// clang-format off
#include "tests/support/math_table.h"

namespace crescent::test {

MathTable avx2_math() { return math_table<avx2::Pack>(); }

}  // namespace crescent::test
