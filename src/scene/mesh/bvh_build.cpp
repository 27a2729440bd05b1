// Builds a tree over boxes: binned SAH (Wald 2007) into two children, then the children of each node are opened until
// it has eight: the one of the largest area first, but subtrees that fill one node last, and only whole. The cost of a
// leaf counts groups of four, because four triangles are tested at once. Each subtree has a range of the array of its
// own, so that threads do not change the result.
#include "scene/mesh/bvh_build.h"

#include <algorithm>

#include "base/errors.h"
#include "base/parallel.h"
#include "scene/mesh/bvh_tree.h"

namespace crescent {

namespace {

constexpr std::size_t bins = 16;
constexpr int deepest_by_cost = 48;     // below it nodes are halved: at most 31 more levels, see most_levels
constexpr std::size_t chunk = 1 << 14;  // items that one thread bins at a time
constexpr std::size_t parallel_from = 1 << 12;

/// Returns half of the surface area.
float area(const Bounds& b) {
    const Vec3f d = b.high - b.low;
    return d.x < 0 ? 0.0f : d.x * d.y + d.y * d.z + d.z * d.x;
}

/// A node of the binary tree.
struct Split {
    Bounds box;
    std::uint32_t begin = 0, count = 0, left = 0, right = 0;  // left 0: a leaf
    std::uint32_t leaves = 1;                                 // below it
};

struct Bin {
    Bounds box;
    std::size_t count = 0;
};
using Bins = std::array<std::array<Bin, bins>, 3>;

class Builder {
public:
    explicit Builder(std::span<const Bounds> items)
        : items_(items), order_(items.size()), centers_(items.size()), splits_(2 * items.size()) {
        for_each_index(items.size() < parallel_from, (items.size() + chunk - 1) / chunk, [&](std::size_t c) {
            for (std::size_t i = c * chunk; i < std::min(items.size(), (c + 1) * chunk); ++i) {
                order_[i] = static_cast<std::uint32_t>(i);
                centers_[i] = 0.5f * items[i].low + 0.5f * items[i].high;
            }
        });
    }

    BvhTree operator()() {
        BvhTree tree;
        if (items_.empty()) return tree;
        split(0, 0, items_.size(), 0);
        tree.nodes.emplace_back();
        emit(tree, 0, 0);
        return tree;
    }

private:
    /// Calls work(part, begin, end) for chunks of a range and returns the parts in their order.
    template <class Part, class Work>
    std::vector<Part> in_chunks(std::size_t begin, std::size_t end, const Work& work) {
        const std::size_t count = end - begin < parallel_from ? 1 : (end - begin + chunk - 1) / chunk;
        std::vector<Part> parts(count);
        for_each_index(count == 1, count, [&](std::size_t c) {
            work(parts[c], begin + c * chunk, count == 1 ? end : std::min(end, begin + (c + 1) * chunk));
        });
        return parts;
    }

    /// Fills splits_[at] with the items order_[begin, end); its subtree is in splits_[at, at + 2 (end - begin)).
    void split(std::size_t index, std::size_t begin, std::size_t end, int depth) {
        struct Boxes {
            Bounds items, centers;
        };
        Boxes boxes;
        for (const Boxes& part : in_chunks<Boxes>(begin, end, [&](Boxes& b, std::size_t from, std::size_t to) {
                 for (std::size_t i = from; i < to; ++i) {
                     b.items.add(items_[order_[i]]);
                     b.centers.add(centers_[order_[i]]);
                 }
             })) {
            boxes.items.add(part.items);
            boxes.centers.add(part.centers);
        }
        Split& node = splits_[index];
        node.box = boxes.items;
        node.begin = static_cast<std::uint32_t>(begin);
        node.count = static_cast<std::uint32_t>(end - begin);
        if (end - begin <= group) return;
        const std::size_t middle = depth < deepest_by_cost ? partition(begin, end, boxes.centers) : (begin + end) / 2;
        const std::size_t left_child = index + 1, right = index + 2 * (middle - begin);
        node.left = static_cast<std::uint32_t>(left_child);
        node.right = static_cast<std::uint32_t>(right);
        const auto first = [&] { split(left_child, begin, middle, depth + 1); };
        const auto second = [&] { split(right, middle, end, depth + 1); };
        if (end - begin >= parallel_from) side_by_side(first, second);
        else {
            first();
            second();
        }
        node.leaves = splits_[left_child].leaves + splits_[right].leaves;
    }

    /// Orders a range by the cheapest split between bins and returns where its second part begins; halves the range if
    /// all centres are in one bin.
    std::size_t partition(std::size_t begin, std::size_t end, const Bounds& centers) {
        std::array<float, 3> low{}, per{};
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = axis_of(centers.low, k);
            const float size = axis_of(centers.high, k) - low[k];
            per[k] = size > 1e-30f ? static_cast<float>(bins) / size : 0.0f;
        }
        const auto bin_of = [&](std::uint32_t item, std::size_t k) {
            return std::min(static_cast<std::size_t>((axis_of(centers_[item], k) - low[k]) * per[k]), bins - 1);
        };
        Bins sums{};
        for (const Bins& part : in_chunks<Bins>(begin, end, [&](Bins& b, std::size_t from, std::size_t to) {
                 for (std::size_t i = from; i < to; ++i)
                     for (std::size_t k = 0; k < 3; ++k) {
                         Bin& bin = b[k][bin_of(order_[i], k)];
                         bin.box.add(items_[order_[i]]);
                         ++bin.count;
                     }
             }))
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t j = 0; j < bins; ++j) {
                    sums[k][j].box.add(part[k][j].box);
                    sums[k][j].count += part[k][j].count;
                }
        const auto [axis, bin] = cheapest(sums);
        if (bin == 0) return (begin + end) / 2;
        std::size_t i = begin, j = end;
        for (;;) {
            while (i < j && bin_of(order_[i], axis) < bin) ++i;
            while (i < j && bin_of(order_[j - 1], axis) >= bin) --j;
            if (i >= j) return i;
            std::swap(order_[i++], order_[--j]);
        }
    }

    /// The axis of the cheapest split, and the first bin of its second part; 0: there is none.
    struct Plane {
        std::size_t axis = 0, bin = 0;
    };
    static Plane cheapest(const Bins& sums) {
        Plane best;
        float lowest_cost = infinity;
        for (std::size_t k = 0; k < 3; ++k) {
            std::array<Bin, bins> right;  // all bins from j on
            Bin sum;
            for (std::size_t j = bins; j-- > 1;) {
                sum.box.add(sums[k][j].box);
                sum.count += sums[k][j].count;
                right[j] = sum;
            }
            Bin left;
            for (std::size_t j = 1; j < bins; ++j) {
                left.box.add(sums[k][j - 1].box);
                left.count += sums[k][j - 1].count;
                if (left.count == 0 || right[j].count == 0) continue;
                const auto groups = [](const Bin& b) { return static_cast<float>((b.count + group - 1) / group); };
                const float cost = area(left.box) * groups(left) + area(right[j].box) * groups(right[j]);
                if (cost < lowest_cost) {
                    lowest_cost = cost;
                    best = {k, j};
                }
            }
        }
        return best;
    }

    /// Returns which child of a node becomes two, `count`: none. First those with more leaves than a node has children,
    /// the widest; then those whose leaves all have room in this node, the ones with the fewest, so that nodes are
    /// full.
    std::size_t to_open(const std::array<std::uint32_t, children>& opened, std::size_t count) const {
        std::size_t widest = count, smallest = count;
        for (std::size_t c = 0; c < count; ++c) {
            const Split& child = splits_[opened[c]];
            if (!child.left) continue;
            if (child.leaves > children) {
                if (widest == count || area(child.box) > area(splits_[opened[widest]].box)) widest = c;
            } else if (count - 1 + child.leaves <= children) {
                if (smallest == count || child.leaves < splits_[opened[smallest]].leaves) smallest = c;
            }
        }
        return widest < count ? widest : smallest;
    }

    /// Writes splits_[at], and all below it, into nodes[to] and new nodes.
    void emit(BvhTree& tree, std::size_t index, std::size_t to) const {
        std::array<std::uint32_t, children> opened{static_cast<std::uint32_t>(index)};
        std::size_t count = 1;
        while (count < children) {
            const std::size_t c = to_open(opened, count);
            if (c == count) break;
            const Split& inner = splits_[opened[c]];
            opened[c] = inner.left;
            opened[count++] = inner.right;
        }
        for (std::size_t c = 0; c < children; ++c) {
            const Bounds box = c < count ? splits_[opened[c]].box : Bounds{};
            for (std::size_t k = 0; k < 3; ++k) {
                tree.nodes[to].side[0][k][c] = axis_of(box.low, k);
                tree.nodes[to].side[1][k][c] = axis_of(box.high, k);
            }
            tree.nodes[to].child[c] = 0;
            if (c >= count) continue;
            const Split& child = splits_[opened[c]];
            if (child.left) {
                const std::size_t next = tree.nodes.size();
                tree.nodes.emplace_back();
                tree.nodes[to].child[c] = static_cast<std::int32_t>(next);
                emit(tree, opened[c], next);
            } else {
                Leaf leaf;
                leaf.fill(no_item);
                std::copy_n(order_.begin() + child.begin, child.count, leaf.begin());
                tree.nodes[to].child[c] = ~static_cast<std::int32_t>(tree.leaves.size());
                tree.leaves.push_back(leaf);
            }
        }
    }

    std::span<const Bounds> items_;
    std::vector<std::uint32_t> order_;
    std::vector<Vec3f> centers_;
    std::vector<Split> splits_;
};

}  // namespace

BvhTree build_tree(std::span<const Bounds> items) {
    ensure(items.size() < (std::size_t{1} << 30), "a tree has at most 2^30 items");
    return Builder(items)();
}

}  // namespace crescent
