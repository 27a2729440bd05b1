// The limits of a process are read from its control groups, v1 and v2; the smallest applies.
#include "base/machine.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace crescent {
namespace machine_test {

namespace fs = std::filesystem;

class Machines : public testing::Test {
protected:
    fs::path root_ = fs::path(testing::TempDir()) / ("machine-" + std::to_string(getpid()));
    std::string own_ = root_ / "own";
    void TearDown() override { fs::remove_all(root_); }
    void put(const std::string& name, const std::string& text) const {
        fs::create_directories((root_ / name).parent_path());
        std::ofstream(root_ / name) << text;
    }
};

TEST_F(Machines, CgroupV2GrantsTheSmallestLimit) {
    put("own", "0::/jobs/mine\n");
    EXPECT_EQ(granted_processors(root_, own_), 0);
    EXPECT_EQ(granted_memory(root_, own_), ~std::uint64_t{0});
    put("sys/fs/cgroup/jobs/cpu.max", "150000 100000\n");
    put("sys/fs/cgroup/jobs/mine/cpu.max", "max 100000\n");
    put("sys/fs/cgroup/jobs/mine/memory.max", "1000000\n");
    put("sys/fs/cgroup/jobs/mine/memory.current", "700000\n");
    put("sys/fs/cgroup/jobs/mine/memory.stat", "anon 5\ninactive_file 200000\n");
    put("sys/fs/cgroup/jobs/memory.max", "max\n");
    EXPECT_EQ(granted_processors(root_, own_), 1.5);
    EXPECT_EQ(granted_memory(root_, own_), 500000u);
}

TEST_F(Machines, CgroupV1GrantsItsLimits) {
    put("own", "4:memory:/\n3:cpu,cpuacct:/box\n0::/\n");
    put("sys/fs/cgroup/cpu/box/cpu.cfs_quota_us", "50000\n");
    put("sys/fs/cgroup/cpu/box/cpu.cfs_period_us", "100000\n");
    put("sys/fs/cgroup/memory/memory.limit_in_bytes", "4096\n");
    put("sys/fs/cgroup/memory/memory.usage_in_bytes", "5000\n");
    EXPECT_EQ(granted_processors(root_, own_), 0.5);
    EXPECT_EQ(granted_memory(root_, own_), 0u);
}

TEST_F(Machines, BoundToOneProcessorUseOneThread) {
    cpu_set_t before, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    for (int k = 0; k < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++k)
        if (CPU_ISSET(k, &before)) CPU_SET(k, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(usable_threads(), 1);
    sched_setaffinity(0, sizeof before, &before);
    EXPECT_GE(usable_threads(), 1);
    EXPECT_GT(available_memory(), 0u);
}

}  // namespace machine_test
}  // namespace crescent
