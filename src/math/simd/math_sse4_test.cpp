// The functions of simd/math.h on sse4; the flags stand in tests/CMakeLists.txt.
#define CRESCENT_ISA sse4
#include "math/simd/pack.h"
// clang-format off
#include "tests/support/math_table.h"

namespace crescent::test {

MathTable sse4_math() { return math_table<sse4::Pack>(); }

}  // namespace crescent::test
