// What limits of control groups, affinity and batch systems leave a process. The files that Linux
// would show stand in a folder of the test.
#include <gtest/gtest.h>
#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include "src/machine/available_cores.h"
#include "src/machine/available_memory.h"
#include "tests/support/temporary_folder.h"

namespace needlework {
namespace {

// As Docker shows them with version 2: the process is in the root of what it can see.
const char* const version_2_mount =
    "30 23 0:26 / /sys/fs/cgroup ro,nosuid - cgroup2 cgroup rw,nsdelegate\n";
// As Docker shows them with version 1: the group's path is that of the host, and so is that of the
// folder that is mounted.
const char* const version_1_mounts =
    "31 23 0:28 / /proc rw - proc proc rw\n"
    "32 31 0:29 /docker/a /sys/fs/cgroup/memory ro shared:7 - cgroup cgroup rw,memory\n"
    "33 31 0:30 /docker/a /sys/fs/cgroup/cpu,cpuacct ro - cgroup cgroup rw,cpuacct,cpu\n";
const char* const version_1_groups =
    "5:memory:/docker/a/job\n4:cpuacct,cpu:/docker/a/job\n1:name=systemd:/docker/a\n0::/else\n";

class ControlGroups : public testing::Test {
 protected:
  using Files = std::map<std::string, std::string>;

  ControlGroups() {
    // What is around the test shall not matter.
    if (const char* text = std::getenv("SLURM_CPUS_PER_TASK")) slurm_ = text;
    unsetenv("SLURM_CPUS_PER_TASK");
  }
  ~ControlGroups() override {
    if (!slurm_.empty()) setenv("SLURM_CPUS_PER_TASK", slurm_.c_str(), 1);
  }

  void write(const Files& files) const {
    for (const auto& [name, text] : files) {
      const auto path = root_.path() / name;
      std::filesystem::create_directories(path.parent_path());
      std::ofstream(path) << text;
    }
  }
  void write_version_2(const std::string& group, const Files& files) const {
    write({{"proc/self/mountinfo", version_2_mount}, {"proc/self/cgroup", "0::" + group + "\n"}});
    write(files);
  }
  void write_version_1(const Files& files) const {
    write({{"proc/self/mountinfo", version_1_mounts}, {"proc/self/cgroup", version_1_groups}});
    write(files);
  }

  AvailableCores cores() const { return available_cores(root_.path()); }
  double quota() const { return cores().quota.value_or(0); }
  // With so many cores that nothing but the files limits them.
  int usable() const {
    AvailableCores out = cores();
    out.online = out.affinity = 64;
    return out.usable();
  }
  std::string name_of(const std::filesystem::path& file) const {
    return file.lexically_relative(root_.path()).string();
  }

  test::TemporaryFolder root_;
  std::string slurm_;
};

TEST_F(ControlGroups, LimitNothingWhereThereAreNone) {
  EXPECT_FALSE(cores().quota);
  EXPECT_EQ(cores().usable(), omp_get_num_procs());
  write_version_2("/", {{"sys/fs/cgroup/cpu.max", "max 100000\n"}});
  EXPECT_FALSE(cores().quota);
  write_version_1({{"sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1\n"},
                   {"sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n"}});
  EXPECT_FALSE(cores().quota);
}

TEST_F(ControlGroups, OfVersion2LimitCores) {
  write_version_2("/", {{"sys/fs/cgroup/cpu.max", "300000 100000\n"}});
  EXPECT_EQ(quota(), 3);
  EXPECT_EQ(usable(), 3);
  EXPECT_EQ(name_of(cores().quota_file), "sys/fs/cgroup/cpu.max");
}

TEST_F(ControlGroups, OfVersion1LimitCores) {
  write_version_1({{"sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "200000\n"},
                   {"sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_period_us", "50000\n"}});
  EXPECT_EQ(quota(), 4);
  EXPECT_EQ(usable(), 4);
  EXPECT_EQ(name_of(cores().quota_file), "sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us");
}

TEST_F(ControlGroups, LimitWhatLiesInThem) {
  write_version_2("/batch/job/step", {{"sys/fs/cgroup/batch/job/step/cpu.max", "max 100000\n"},
                                      {"sys/fs/cgroup/batch/job/cpu.max", "250000 100000\n"},
                                      {"sys/fs/cgroup/batch/cpu.max", "800000 100000\n"}});
  EXPECT_EQ(quota(), 2.5);
  write_version_1({{"sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "700000\n"},
                   {"sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n"}});
  EXPECT_EQ(quota(), 7) << "of the container, which the process sees as the root";
}

TEST_F(ControlGroups, AreFoundWhereBothVersionsAreMounted) {
  write_version_1({{"sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "300000\n"},
                   {"sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n"}});
  write(
      {{"proc/self/mountinfo", std::string(version_1_mounts) +
                                   "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n"},
       {"sys/fs/cgroup/unified/else/cpu.max", "200000 100000\n"}});
  EXPECT_EQ(quota(), 2);
}

// A process that was started in another namespace than that of its mount.
TEST_F(ControlGroups, OutsideOfTheMountAreTakenAsItsRoot) {
  for (const char* group : {"/../../other", "/..", "/other"}) {
    write_version_2(group, {{"sys/fs/cgroup/cpu.max", "100000 100000\n"}});
    EXPECT_EQ(quota(), 1) << group;
  }
  write({{"proc/self/mountinfo", "30 23 0:26 /docker/a /sys/fs/cgroup ro - cgroup2 cgroup rw\n"},
         {"proc/self/cgroup", "0::/docker/ab\n"}});
  EXPECT_EQ(quota(), 1);
}

TEST_F(ControlGroups, MayBeMountedWhereNamesHaveBlanks) {
  write({{"proc/self/mountinfo", "30 23 0:26 / /my\\040groups rw - cgroup2 cgroup rw\n"},
         {"proc/self/cgroup", "0::/\n"},
         {"my groups/cpu.max", "100000 100000\n"}});
  EXPECT_EQ(quota(), 1);
}

TEST_F(ControlGroups, AreFoundInTheUsualPlacesWithoutMounts) {
  write({{"sys/fs/cgroup/cpu.max", "300000 100000\n"}});
  EXPECT_EQ(quota(), 3);
  write({{"sys/fs/cgroup/cpu/cpu.cfs_quota_us", "200000\n"},
         {"sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n"}});
  EXPECT_EQ(quota(), 2);
}

TEST_F(ControlGroups, LeaveWholeCoresAndAtLeastOne) {
  const auto usable_of = [&](const char* limits) {
    write_version_2("/", {{"sys/fs/cgroup/cpu.max", limits}});
    return usable();
  };
  EXPECT_EQ(usable_of("50000 100000\n"), 1);
  EXPECT_EQ(usable_of("150000 100000\n"), 1);
  EXPECT_EQ(usable_of("299000 100000\n"), 2);
  EXPECT_EQ(usable_of("30000 10000\n"), 3);
  EXPECT_EQ(usable_of("6400000000 100000\n"), 64);
}

TEST_F(ControlGroups, ThatCannotBeReadLimitNothing) {
  for (const char* text :
       {"", "many 100000\n", "100000\n", "0 100000\n", "100000 0\n", "-1 -1\n"}) {
    write_version_2("/", {{"sys/fs/cgroup/cpu.max", text}});
    EXPECT_FALSE(cores().quota) << text;
  }
  write({{"proc/self/mountinfo", "30 23 - cgroup2\n - \n\\0\n"}, {"proc/self/cgroup", "0:\n"}});
  EXPECT_FALSE(cores().quota);
}

TEST_F(ControlGroups, LimitMemory) {
  write({{"proc/meminfo", "MemTotal: 4096 kB\nMemAvailable: 2048 kB\n"}});
  EXPECT_EQ(available_memory(root_.path()), 2048 * 1024);
  write_version_2("/job", {{"sys/fs/cgroup/memory.max", "1000000\n"},
                           {"sys/fs/cgroup/job/memory.max", "max\n"}});
  EXPECT_EQ(available_memory(root_.path()), 1000000);
  write_version_1({{"sys/fs/cgroup/memory/job/memory.limit_in_bytes", "500000\n"},
                   {"sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n"}});
  EXPECT_EQ(available_memory(root_.path()), 500000);
}

TEST_F(ControlGroups, AndSlurmAndAffinityTogetherSayHowManyCoresAreUsable) {
  setenv("SLURM_CPUS_PER_TASK", "3", 1);
  EXPECT_EQ(cores().slurm_per_task, 3);
  EXPECT_EQ(usable(), 3);
  for (const char* text : {"", "0", "-2", "2x", "many"}) {
    setenv("SLURM_CPUS_PER_TASK", text, 1);
    EXPECT_FALSE(cores().slurm_per_task) << text;
  }
  unsetenv("SLURM_CPUS_PER_TASK");

  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&one);
  int first = 0;
  while (!CPU_ISSET(first, &all)) ++first;
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(cores().affinity, 1);
  EXPECT_EQ(cores().usable(), 1);
  sched_setaffinity(0, sizeof all, &all);
}

TEST_F(ControlGroups, AreNamedWhereTheyLimit) {
  AvailableCores cores{
      .online = 8, .affinity = 8, .quota = {}, .quota_file = {}, .slurm_per_task = {}};
  EXPECT_EQ(cores.text(), "8");
  cores.quota = 16;
  cores.slurm_per_task = 8;
  EXPECT_EQ(cores.text(), "8");
  cores.quota = 2.5;
  cores.quota_file = "/sys/fs/cgroup/cpu.max";
  EXPECT_EQ(cores.text(), "2 of 8: CPU quota of 2.5 (/sys/fs/cgroup/cpu.max)");
  cores.affinity = 4;
  cores.slurm_per_task = 1;
  EXPECT_EQ(cores.text(),
            "1 of 8: the process may run on 4, CPU quota of 2.5 (/sys/fs/cgroup/cpu.max), "
            "SLURM_CPUS_PER_TASK=1");
}

}  // namespace
}  // namespace needlework
