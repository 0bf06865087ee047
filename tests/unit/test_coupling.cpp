#include "close.hpp"
#include "lattice/vec3.hpp"
#include "lattice_units.hpp"
#include "physics/load_ledger.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace {

using namespace lbm;

constexpr double kRoundOff = 1e-12;
constexpr double kConserved = 1e-10;
/// Measured 6e-4: the way of a sphere through the cells.
constexpr double kGalilean = 2e-3;

double volume(double R) { return 4 * std::numbers::pi / 3 * R * R * R; }

Solid free_sphere(std::int64_t id, double R, double density, const Vec3& position)
{
    Solid s;
    s.id = id;
    s.radius = R;
    s.position = position;
    s.mass = density * volume(R);
    s.inertia = 0.4 * s.mass * R * R;
    return s;
}

/// A coupled step as a grain code would do it: load, velocity, position.
void coupled_step(Fluid& fluid, std::vector<Solid>& solids, const Vec3& weight_acceleration = {})
{
    fluid.place_solids(solids);
    fluid.step();
    for (std::size_t i = 0; i < solids.size(); ++i) {
        Solid& s = solids[i];
        s.velocity += (1 / s.mass) * fluid.loads()[i].force + weight_acceleration;
        s.angular_velocity += (1 / s.inertia) * fluid.loads()[i].torque;
        s.position += s.velocity;
    }
}

Vec3 momentum(const Fluid& fluid, const std::vector<Solid>& solids)
{
    Vec3 sum = fluid.total_momentum();
    for (const Solid& s : solids) sum += s.mass * s.velocity;
    return sum;
}

class Coupling : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Coupling);
    CPPUNIT_TEST(ledger_passes_on_all_that_was_taken);
    CPPUNIT_TEST(fluid_and_grains_keep_their_momentum);
    CPPUNIT_TEST(a_light_sphere_stays_stable);
    CPPUNIT_TEST(sphere_at_rest_feels_the_force_of_archimedes);
    CPPUNIT_TEST(loads_of_a_fixed_bed_balance_the_drive);
    CPPUNIT_TEST(stokes_drag_does_not_depend_on_tau);
    CPPUNIT_TEST(drag_of_a_cubic_array_agrees_with_the_series);
    CPPUNIT_TEST(drag_of_an_array_does_not_depend_on_how_it_lies);
    CPPUNIT_TEST(rotating_sphere_feels_the_stokes_torque_at_any_tau);
    CPPUNIT_TEST(a_sphere_that_joins_the_flow_gets_no_kick);
    CPPUNIT_TEST(drag_of_a_towed_sphere_is_that_of_a_fixed_one_in_a_stream);
    CPPUNIT_TEST_SUITE_END();

    void ledger_passes_on_all_that_was_taken()
    {
        LoadLedger ledger;
        Vec3 passed{}, taken{};
        for (int t = 0; t < 50; ++t) {
            const Vec3 force{0.1 * t, -1.0, 0.3};
            taken -= force;
            passed += ledger.settle(force, {}, {}, {}, 0.2 + 0.01 * t, 1).force;
        }
        for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(taken[d], passed[d] + ledger.owed[d], kRoundOff, norm(taken));
        CPPUNIT_ASSERT_EQUAL(1.0, load_share(std::numeric_limits<double>::infinity(), 3));
        LBM_ASSERT_CLOSE(1 / 13.0, load_share(1, 3), kRoundOff, 1.0);
    }

    void fluid_and_grains_keep_their_momentum()
    {
        for (const double density : {0.5, 1.0, 2.5}) {
            const FluidConfig c = test::lattice_config({20, 18, 16}, 0.6);
            Fluid fluid(c);
            std::vector<Solid> solids{free_sphere(0, 3.2, density, {6, 6, 6}),
                                      free_sphere(1, 2.7, density, {12.1, 6.4, 6.2})};
            solids[0].velocity = {0.04, 0.01, -0.02};
            solids[0].angular_velocity = {0, 0.005, 0.003};
            solids[1].velocity = {-0.02, 0.0, 0.01};
            fluid.place_solids(solids);
            const Vec3 before = momentum(fluid, solids);
            const double scale = solids[0].mass * norm(solids[0].velocity);
            for (int t = 0; t < 400; ++t) {
                coupled_step(fluid, solids);
                const Vec3 now = momentum(fluid, solids);
                for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(before[d], now[d], kConserved, scale);
            }
            CPPUNIT_ASSERT(norm(solids[0].velocity) < 0.02);  // most of it is in the fluid by now
        }
    }

    void a_light_sphere_stays_stable()
    {
        const FluidConfig c = test::lattice_config({24, 24, 24}, 0.6);
        Fluid fluid(c);
        std::vector<Solid> solids{free_sphere(0, 4.5, 0.5, {12, 12, 12})};
        const double V = volume(4.5), g = -2e-5;
        FluidConfig driven = c;
        driven.acceleration = {0, 0, 0.5 * V * g / (24.0 * 24 * 24)};  // no net force on the box
        Fluid box(driven);
        double last = 0;
        for (int t = 0; t < 3000; ++t) {
            coupled_step(box, solids, {0, 0, -0.5 * V * g / solids[0].mass});  // buoyancy minus weight
            if (t == 2000) last = solids[0].velocity[2];
        }
        CPPUNIT_ASSERT(last > 0);
        LBM_ASSERT_CLOSE(last, solids[0].velocity[2], 0.01, last);
    }

    void sphere_at_rest_feels_the_force_of_archimedes()
    {
        FluidConfig c = test::lattice_config({12, 12, 12}, 0.7);
        c.gravity = {1e-4, 0, -3e-4};
        for (int axis = 0; axis < 3; ++axis) test::walls(c, axis);
        Fluid fluid(c);
        Solid s;
        s.radius = 3.3;
        s.position = {6.2, 5.9, 6.4};
        for (int t = 0; t < 200; ++t) {
            fluid.place_solids({s});
            fluid.step();
        }
        for (int d = 0; d < 3; ++d)
            LBM_ASSERT_CLOSE(-volume(s.radius) * c.gravity[d], fluid.loads()[0].force[d], kRoundOff,
                             volume(s.radius) * 3e-4);
        CPPUNIT_ASSERT_EQUAL(0.0, fluid.max_mach());
    }

    void loads_of_a_fixed_bed_balance_the_drive()
    {
        FluidConfig c = test::lattice_config({14, 14, 14}, 0.8);
        c.acceleration = {1e-6, 2e-6, 0};
        Fluid fluid(c);
        std::vector<Solid> bed(2);
        bed[0].radius = 3;
        bed[0].position = {3.3, 4, 5};
        bed[1].id = 1;
        bed[1].radius = 3.5;
        bed[1].position = {9.6, 10.1, 9};
        fluid.place_solids(bed);
        for (int t = 0; t < 6000; ++t) fluid.step();
        const double V = 14.0 * 14 * 14;
        for (int d = 0; d < 3; ++d)
            LBM_ASSERT_CLOSE(V * c.acceleration[d], fluid.loads()[0].force[d] + fluid.loads()[1].force[d], 1e-8,
                             V * 2e-6);
    }

    /// Drag of an array, K = rho a V / (6 pi mu R U N), with spheres at these places of a cell of n cubed; flow along y.
    static double array_K(const std::vector<Vec3>& places, double c_solid, const std::array<int, 3>& n, double tau,
                          double lambda, int steps)
    {
        FluidConfig c = test::lattice_config(n, tau);
        c.magic_parameter = lambda;
        c.acceleration = {0, 1e-6, 0};
        c.inertia = false;
        Fluid fluid(c);
        std::vector<Solid> solids(places.size());
        const double V = 1.0 * n[0] * n[1] * n[2], N = static_cast<double>(solids.size());
        const Vec3 first{0.5 * n[0] + 0.3, 0.5 * n[1], 0.5 * n[2] - 0.1};
        for (std::size_t i = 0; i < solids.size(); ++i) {
            solids[i].id = static_cast<std::int64_t>(i);
            solids[i].radius = std::cbrt(c_solid * V / (N * volume(1)));
            for (int d = 0; d < 3; ++d) solids[i].position[d] = std::fmod(first[d] + places[i][d] * n[d], n[d]);
        }
        fluid.place_solids(solids);
        for (int t = 0; t < steps; ++t) fluid.step();
        return 1e-6 * V / (N * 6 * std::numbers::pi * c.viscosity * solids[0].radius * fluid.average_velocity()[1]);
    }
    static double cubic_array_K(double c_solid, int n, double tau, double lambda, int steps)
    {
        return array_K({{0, 0, 0}}, c_solid, {n, n, n}, tau, lambda, steps);
    }

    void stokes_drag_does_not_depend_on_tau()
    {
        // Pressure inside the solid settles slowly and moves the drag by some 1e-7 meanwhile; the validation waits for 1e-10.
        constexpr double kUnsettled = 2e-6;
        for (const double lambda : {0.125, 0.1875}) {
            const double K = cubic_array_K(0.125, 10, 1.0, lambda, 6000);
            LBM_ASSERT_CLOSE(K, cubic_array_K(0.125, 10, 0.6, lambda, 6000), kUnsettled, K);
            LBM_ASSERT_CLOSE(K, cubic_array_K(0.125, 10, 3.0, lambda, 12000), kUnsettled, K);
        }
    }

    void drag_of_a_cubic_array_agrees_with_the_series()
    {
        // tests/reference/02_cubic_arrays_stokes.csv; measured -0.3 % at R = 4.34.
        LBM_ASSERT_CLOSE(4.2915892, cubic_array_K(0.125, 14, 1.0, 0.125, 3000), 0.004, 4.2915892);
    }

    /// Walls stand where they should whatever their direction on the lattice: a face-centred array, c = 0.5, upright and turned by 45 degrees.
    void drag_of_an_array_does_not_depend_on_how_it_lies()
    {
        constexpr double exact = 47.9675, kOfAnArray = 0.009;  // measured: -0.66 %, -0.2 %
        const std::vector<Vec3> upright{{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
        LBM_ASSERT_CLOSE(exact, array_K(upright, 0.5, {24, 24, 24}, 0.7, 0.125, 1200), kOfAnArray, exact);
        const std::vector<Vec3> turned{{0, 0, 0}, {0.5, 0.5, 0.5}};  // 17 to 24 is 1 to sqrt(2), within 0.2 %
        LBM_ASSERT_CLOSE(exact, array_K(turned, 0.5, {17, 17, 24}, 0.7, 0.125, 1200), kOfAnArray, exact);
    }

    void rotating_sphere_feels_the_stokes_torque_at_any_tau()
    {
        // T = 8 pi mu R^3 W / (1 - c) to leading order in a periodic box (no net torque on the fluid).
        double first = 0;
        for (const double tau : {0.7, 1.0}) {
            FluidConfig c = test::lattice_config({24, 24, 24}, tau);
            c.inertia = false;
            Fluid fluid(c);
            Solid s;
            s.radius = 4.4;
            s.position = {12.2, 11.9, 12};
            s.angular_velocity = {0, 0, 1e-4};
            fluid.place_solids({s});
            for (int t = 0; t < 6000; ++t) fluid.step();
            const double torque = -fluid.loads()[0].torque[2];
            const double stokes = 8 * std::numbers::pi * c.viscosity * std::pow(s.radius, 3) * 1e-4;
            const double solid_fraction = volume(s.radius) / (24.0 * 24 * 24);
            if (first == 0) first = torque / stokes;
            LBM_ASSERT_CLOSE(1 / (1 - solid_fraction), torque / stokes, 0.02, 1.0);
            LBM_ASSERT_CLOSE(first, torque / stokes, 1e-6, 1.0);
        }
    }

    void a_sphere_that_joins_the_flow_gets_no_kick()
    {
        // Fluid in uniform motion; a sphere with its velocity appears.
        FluidConfig c = test::lattice_config({16, 16, 16}, 0.8);
        c.acceleration = {1e-4, 0, 0};
        Fluid fluid(c);
        for (int t = 0; t < 300; ++t) fluid.step();
        const double U = fluid.average_velocity()[0];
        std::vector<Solid> solids{free_sphere(4, 3.1, 2, {8.3, 8, 8})};
        solids[0].velocity = {U, 0, 0};
        fluid.place_solids(solids);
        fluid.step();
        const double drive = solids[0].mass / 2 * c.acceleration[0];
        // Fluid and sphere, of twice its density, part at half the drive's acceleration: the load is of the drive's order.
        CPPUNIT_ASSERT(std::abs(fluid.loads()[0].force[0]) < 3 * drive);
    }

    /// Mean drag over six cells of the way, after three diameters of it; in a periodic box, at a Reynolds number of 8.
    static double drag(double stream, double tow)
    {
        FluidConfig c = test::lattice_config({18, 14, 14}, 0.6);
        c.initial_velocity = {stream, 0, 0};
        Fluid fluid(c);
        Solid s;
        s.radius = 3.3;
        s.position = {9.3, 7.1, 6.8};
        s.velocity = {tow, 0, 0};
        constexpr int kBefore = 500, kWindow = 150;
        double sum = 0;
        for (int t = 0; t < kBefore + kWindow; ++t) {
            fluid.place_solids({s});
            fluid.step();
            if (t >= kBefore) sum += fluid.loads()[0].force[0] / kWindow;
            s.position += s.velocity;
        }
        return sum;
    }

    void drag_of_a_towed_sphere_is_that_of_a_fixed_one_in_a_stream()
    {
        const double fixed = drag(0.04, 0), towed = drag(0, -0.04), both = drag(0.02, -0.02);
        CPPUNIT_ASSERT(fixed > 0);
        LBM_ASSERT_CLOSE(fixed, towed, kGalilean, fixed);
        LBM_ASSERT_CLOSE(fixed, both, kGalilean, fixed);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Coupling);

}  // namespace
