#include "lattice_units.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> allocations{0};

}  // namespace

// Counts what this program asks for; what the OpenMP library asks for itself goes past it.
void* operator new(std::size_t bytes)
{
    ++allocations;
    if (void* const p = std::malloc(bytes)) return p;
    throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace {

using namespace lbm;

class Allocations : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Allocations);
    CPPUNIT_TEST(a_step_with_moving_spheres_asks_for_no_memory);
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
};

CPPUNIT_TEST_SUITE_REGISTRATION(Allocations);

}  // namespace
