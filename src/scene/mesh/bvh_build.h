// Builds a tree over boxes.
#pragma once

#include <span>

#include "scene/mesh/bvh.h"
#include "scene/mesh/bvh_tree.h"

namespace crescent {

BvhTree build_tree(std::span<const Bounds> items);

}  // namespace crescent
