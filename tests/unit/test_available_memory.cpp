#include "fields/available_memory.hpp"

#include "says.hpp"

#include "lbm/errors.hpp"
#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace {

using namespace lbm;

/// What is left is the least of what the machine and the groups of a program have.
class AvailableMemory : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(AvailableMemory);
    CPPUNIT_TEST(a_machine_has_its_available_memory_and_swap);
    CPPUNIT_TEST(groups_of_the_second_version_limit_it);
    CPPUNIT_TEST(groups_of_the_first_version_limit_it);
    CPPUNIT_TEST(a_system_that_says_nothing_has_no_limit);
    CPPUNIT_TEST(a_fluid_that_does_not_fit_is_refused_before_it_takes_any);
    CPPUNIT_TEST_SUITE_END();

    const std::filesystem::path root_ =
        std::filesystem::temp_directory_path() / ("lbm_available_memory_" + std::to_string(getpid()));

    void write(const std::string& name, const std::string& text)
    {
        const auto file = root_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    double available() const { return available_memory(root_.string()); }

public:
    void setUp() override
    {
        write("proc/meminfo", "MemTotal: 9000 kB\nMemFree: 10 kB\nMemAvailable: 3000 kB\nSwapFree: 1000 kB\n");
    }
    void tearDown() override { std::filesystem::remove_all(root_); }

private:
    void a_machine_has_its_available_memory_and_swap() { CPPUNIT_ASSERT_EQUAL(4000 * 1024.0, available()); }

    void groups_of_the_second_version_limit_it()
    {
        write("proc/self/cgroup", "0::/job/step\n");
        write("sys/fs/cgroup/job/step/memory.max", "max\n");
        write("sys/fs/cgroup/job/step/memory.current", "300000\n");
        CPPUNIT_ASSERT_EQUAL(4000 * 1024.0, available());
        write("sys/fs/cgroup/job/memory.max", "1000000\n");
        write("sys/fs/cgroup/job/memory.current", "400000\n");
        CPPUNIT_ASSERT_EQUAL(600000.0, available());
        write("sys/fs/cgroup/job/memory.stat", "anon 1\nfile 9\ninactive_file 30000\nactive_file 5000\n");
        CPPUNIT_ASSERT_EQUAL(635000.0, available());
        write("sys/fs/cgroup/memory.max", "500000\n");  // as a container sees its own group
        write("sys/fs/cgroup/memory.current", "500001\n");
        CPPUNIT_ASSERT_EQUAL(0.0, available());
    }

    void groups_of_the_first_version_limit_it()
    {
        write("proc/self/cgroup", "5:cpu,memory:/job\n4:cpuset:/\n0::/\n");
        write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
        write("sys/fs/cgroup/memory/memory.usage_in_bytes", "7\n");
        CPPUNIT_ASSERT_EQUAL(4000 * 1024.0, available());
        write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "200000\n");
        write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "150000\n");
        write("sys/fs/cgroup/memory/job/memory.stat", "inactive_file 1\ntotal_inactive_file 1000\n");
        CPPUNIT_ASSERT_EQUAL(51000.0, available());
    }

    void a_system_that_says_nothing_has_no_limit()
    {
        std::filesystem::remove_all(root_);
        CPPUNIT_ASSERT(std::isinf(available()));
    }

    void a_fluid_that_does_not_fit_is_refused_before_it_takes_any()
    {
        CPPUNIT_ASSERT(available_memory() > 0);
        FluidConfig c;
        c.cells = {1200, 1200, 1200};  // 260 GB: some machines promise that, and kill who takes it
        c.dx = c.density = c.viscosity = c.tau = 1;
        if (available_memory() > 200e9) return;
        test::assert_says(test::says<ConfigError>([&] { const Fluid fluid(c); }), " GB are available; use a larger dx");
        test::assert_says(test::says<ConfigError>([&] { Fluid::check(c); }), " GB are available; use a larger dx");
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(AvailableMemory);

}  // namespace
