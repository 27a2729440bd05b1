// src/gl/shaders/integers.glsl against draws() of src/math/simd/random.h, bit by bit, on 20 blocks of 512 x 512 pixels;
// and that a flipped bit and another seed are counted.
#include "backend.h"

#include <gtest/gtest.h>

#include "tests/support/gl_test_scene.h"

namespace crescent::gl {
namespace integers_test {

/// Returns pairs of samples from the first to the last for an N of 2^32, both dimensions' blocks and one that no
/// sampler uses, seeds with few bits and with many: 512 x 512 pixels each, 20 million integers.
std::vector<IntegerBlock> many_blocks() {
    std::vector<IntegerBlock> out;
    for (const std::uint32_t pair : {0u, 1u, 31u, 32767u, 0x7fffffffu})
        for (const auto& [block, seed] : {std::pair{0u, 0u}, {0u, 329363537u}, {1u, 1374605335u}, {2u, 0xffffffffu}})
            out.push_back({512, 512, pair, block, seed});
    return out;
}

TEST(Integers, EveryBitOfEveryDrawIsTheCpus) {
    const std::vector<IntegerBlock> blocks = many_blocks();
    const auto integers = driver_integers(test::context(), blocks);
    for (std::size_t k = 0; k < blocks.size(); ++k)
        EXPECT_EQ(unlike_integers(blocks[k], integers[k]), 0u)
            << "pair " << blocks[k].pair << ", block " << blocks[k].block << ", seed " << blocks[k].seed;
}

TEST(Integers, AFlippedBitAndAnotherSeedAreCounted) {
    const IntegerBlock block{16, 16, 3, 1, 7};
    std::vector<std::uint32_t> integers = driver_integers(test::context(), {block})[0];
    integers[100] ^= 1u << 31;
    EXPECT_EQ(unlike_integers(block, integers), 1u);
    EXPECT_EQ(unlike_integers({16, 16, 3, 1, 8}, integers), 4u * 256u);
}

}  // namespace integers_test
}  // namespace crescent::gl
