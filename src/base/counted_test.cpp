// The forms of words with one thing, none and several, and patterns that are no forms.
#include "base/counted.h"

#include <gtest/gtest.h>

namespace crescent {
namespace counted_test {

TEST(Counted, HasTheSingularForOneAlone) {
    EXPECT_EQ(counted(1, "mesh[es] that emit[s|]"), "1 mesh that emits");
    EXPECT_EQ(counted(2, "mesh[es] that emit[s|]"), "2 meshes that emit");
    EXPECT_EQ(counted(0, "cop[y|ies]"), "0 copies");
    EXPECT_EQ(counted(1, "cop[y|ies]"), "1 copy");
    EXPECT_EQ(counted(3, "camera"), "3 camera");
    EXPECT_EQ(counted(3, "camera[s"), "3 camera[s");
}

}  // namespace counted_test
}  // namespace crescent
