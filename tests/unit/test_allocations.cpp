#include "lattice_units.hpp"
#include "says.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <string>

namespace {

std::atomic<long> allocations{0};
std::atomic<long> until_failure{-1};  ///< allocations that still succeed before one does not; negative: all do

}  // namespace

// Counts what this program asks for; what the OpenMP library asks for itself goes past it.
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment)
{
    ++allocations;
    if (until_failure >= 0 && until_failure-- == 0) throw std::bad_alloc();
    const auto a = static_cast<std::size_t>(alignment);
    if (void* const p = std::aligned_alloc(a, (bytes + a - 1) / a * a)) return p;
    throw std::bad_alloc();
}
void* operator new(std::size_t bytes) { return operator new(bytes, std::align_val_t(alignof(std::max_align_t))); }
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { operator delete(p); }
void operator delete(void* p, std::align_val_t) noexcept { operator delete(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { operator delete(p); }

namespace {

using namespace lbm;

class Allocations : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Allocations);
    CPPUNIT_TEST(a_step_with_moving_spheres_asks_for_no_memory);
    CPPUNIT_TEST(memory_that_runs_out_is_an_error_that_says_so);
    CPPUNIT_TEST_SUITE_END();

    static std::vector<Solid> spheres(int step)
    {
        std::vector<Solid> all;
        for (int i = 0; i < 27; ++i) {
            Solid s;
            s.id = i;
            s.radius = 3.5;
            s.velocity = {0.02, 0.01, -0.015};
            const int at[] = {i % 3, i / 3 % 3, i / 9};
            for (int d = 0; d < 3; ++d) s.position[d] = 12.0 * at[d] + 0.3 * i + step % 50 * s.velocity[d];
            all.push_back(s);
        }
        return all;
    }

    void a_step_with_moving_spheres_asks_for_no_memory()
    {
        for (const int threads : {1, 2}) {
            FluidConfig c = lbm::test::lattice_config({36, 36, 36}, 0.6);
            c.threads = threads;
            Fluid fluid(c);
            const auto step = [&](int t) {
                const auto solids = spheres(t);
                const long before = allocations;
                fluid.place_solids(solids);
                fluid.step();
                return allocations - before;
            };
            for (int t = 0; t < 50; ++t) step(t);  // buffers grow to what they need
            for (int t = 50; t < 60; ++t) CPPUNIT_ASSERT_EQUAL(0L, step(t));
        }
    }

    /// So many that no loop over them runs in one thread only.
    static std::vector<Solid> pack()
    {
        std::vector<Solid> all;
        for (int i = 0; i < 125; ++i) {
            Solid s;
            s.id = i;
            s.radius = 2;
            const int at[] = {i % 5, i / 5 % 5, i / 25};
            for (int d = 0; d < 3; ++d) s.position[d] = 4.4 * at[d] + 0.01 * i;
            all.push_back(s);
        }
        return all;
    }

    /// Whatever is asked for, of any of the threads: an exception that leaves a parallel region would end the program.
    void memory_that_runs_out_is_an_error_that_says_so()
    {
        FluidConfig c = lbm::test::lattice_config({22, 22, 22}, 0.6);
        c.threads = 2;
        const auto solids = pack();
        int failures = 0;
        for (long n = 0;; n += 1 + n / 8) {
            until_failure = n;
            std::string said;
            try {
                Fluid fluid(c);
                fluid.place_solids(solids);
                fluid.step();
                fluid.film_loads(solids, 1);
                fluid.velocity_field();
            } catch (const ConfigError& error) {
                said = error.what();
                test::assert_says(said, " GB are available; use a larger dx");
            } catch (const RunError& error) {
                said = error.what();
                test::assert_says(said, "no memory is left for");
                test::assert_says(said, " GB already");
            } catch (const std::bad_alloc&) {
                said = "of one who only asked";
            }
            const bool all_succeeded = until_failure >= 0;
            until_failure = -1;
            if (all_succeeded) break;
            failures += !said.empty();  // streams go on without, and say nothing
        }
        CPPUNIT_ASSERT(failures > 20);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Allocations);

}  // namespace
