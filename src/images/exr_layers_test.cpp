// Layers by their names, of parts that are in no file.
#include "images/exr_layers.h"

#include <gtest/gtest.h>

namespace crescent {
namespace exr_layers_test {

ExrPart part(const std::vector<std::string>& channels) {
    ExrPart out;
    for (const std::string& name : channels) out.channels.emplace_back().name = name;
    return out;
}

TEST(ExrChannelNames, AreSplitIntoLayerAndColour) {
    const auto found = exr_channels(part({"R", "red", "View.Combined.G", "diffuse_B", "rgba.[blue]", "Z", "depth_z1"}));
    EXPECT_EQ(found.at("").at("r"), "R");  // the first of two spellings
    EXPECT_EQ(found.at("").at("z"), "Z");
    EXPECT_EQ(found.at("").at("depth_z1"), "depth_z1");
    EXPECT_EQ(found.at("View.Combined").at("g"), "View.Combined.G");
    EXPECT_EQ(found.at("diffuse").at("b"), "diffuse_B");
    EXPECT_EQ(found.at("rgba").at("b"), "rgba.[blue]");
}

}  // namespace exr_layers_test
}  // namespace crescent
