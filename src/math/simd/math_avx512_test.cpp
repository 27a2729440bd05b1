// The functions of simd/math.h on avx512; tests/CMakeLists.txt has the flags.
#define CRESCENT_ISA avx512
#include "math/simd/pack.h"
// clang-format off
#include "tests/support/math_table.h"

namespace crescent::test {

MathTable avx512_math() { return math_table<avx512::Pack>(); }

}  // namespace crescent::test
