#include "close.hpp"
#include "lattice/vec3.hpp"
#include "lattice_units.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace {

using namespace lbm;

constexpr double kPi = std::numbers::pi;

/// Films and fluid together.
class FilmLoads : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(FilmLoads);
    CPPUNIT_TEST(approaching_spheres_feel_the_exact_force);
    CPPUNIT_TEST(approach_of_a_wall_meets_the_exact_force);
    CPPUNIT_TEST(grains_at_rest_in_contact_feel_buoyancy_alone);
    CPPUNIT_TEST(light_spheres_pushed_together_do_not_bounce);
    CPPUNIT_TEST(a_pushed_sphere_closes_its_gap_at_the_exact_speed);
    CPPUNIT_TEST(a_dense_suspension_comes_to_rest_and_keeps_its_momentum);
    CPPUNIT_TEST(roughness_out_of_range_is_refused);
    CPPUNIT_TEST_SUITE_END();

    static double steady_approach(FluidConfig c, std::vector<Solid> solids, int axis)
    {
        c.inertia = false;
        Fluid fluid(c);
        fluid.place_solids(solids);
        for (int t = 0; t < 500; ++t) fluid.step();
        return std::abs(fluid.loads()[0].force[axis] + fluid.film_loads(solids, 1)[0].force[axis]) /
               (6 * kPi * c.viscosity * solids[0].radius * norm(solids[0].velocity));
    }

    // The outer flow of the small boxes is 2 to 4 % of the force at these gaps; the slow tier has the curves.
    void approaching_spheres_feel_the_exact_force()
    {
        std::vector<Solid> pair(2);
        for (int i = 0; i < 2; ++i) {
            pair[i].id = i;
            pair[i].radius = 4;
            pair[i].position = {15.9 + (i == 0 ? -1 : 1) * 4.02, 11.8, 12.3};  // gap 0.01 R
            pair[i].velocity = {i == 0 ? 1e-5 : -1e-5, 0, 0};
        }
        LBM_ASSERT_CLOSE(53.4222936539, steady_approach(test::lattice_config({32, 24, 24}, 1.5), pair, 0), 0.03, 53.42);
    }

    void approach_of_a_wall_meets_the_exact_force()
    {
        FluidConfig c = test::lattice_config({24, 24, 24}, 1.5);
        test::walls(c, 2);
        Solid s;
        s.radius = 4;
        s.velocity = {0, 0, -1e-5};
        s.position = {12.2, 11.7, 4.04};
        LBM_ASSERT_CLOSE(101.896172325, steady_approach(c, {s}, 2), 0.03, 101.9);
        s.position[2] = 4.4;
        LBM_ASSERT_CLOSE(11.4591572034, steady_approach(c, {s}, 2), 0.04, 11.46);
    }

    static Solid free_sphere(std::int64_t id, double R, double density, const Vec3& position)
    {
        Solid s;
        s.id = id;
        s.radius = R;
        s.position = position;
        s.mass = density * 4 * kPi / 3 * R * R * R;
        s.inertia = 0.4 * s.mass * R * R;
        return s;
    }

    static void accelerate(std::vector<Solid>& solids, const std::vector<SolidLoad>& loads, double dt)
    {
        for (std::size_t i = 0; i < solids.size(); ++i) {
            solids[i].velocity += (dt / solids[i].mass) * loads[i].force;
            solids[i].angular_velocity += (dt / solids[i].inertia) * loads[i].torque;
        }
    }

    /// One step of the fluid, several of the solids, with forces that may depend on where they are.
    static void coupled_step(Fluid& fluid, std::vector<Solid>& solids,
                             const std::function<std::vector<Vec3>(const std::vector<Solid>&)>& push, int sub_steps = 1)
    {
        fluid.place_solids(solids);
        fluid.step();
        const double dt = fluid.dt() / sub_steps;
        for (int n = 0; n < sub_steps; ++n) {
            const std::vector<Vec3> pushes = push(solids);
            accelerate(solids, fluid.loads(), dt);
            for (std::size_t i = 0; i < solids.size(); ++i) solids[i].velocity += (dt / solids[i].mass) * pushes[i];
            accelerate(solids, fluid.film_loads(solids, dt), dt);
            for (Solid& s : solids) s.position += dt * s.velocity;
        }
    }

    static std::vector<Vec3> no_push(const std::vector<Solid>& solids) { return std::vector<Vec3>(solids.size()); }

    void grains_at_rest_in_contact_feel_buoyancy_alone()
    {
        FluidConfig c = test::lattice_config({26, 18, 18}, 0.8);
        c.gravity = {0, 0, -1e-4};
        test::walls(c, 2);
        Fluid fluid(c);
        const double buoyancy = 1e-4 * 4 * kPi / 3 * 64;
        for (int t = 0; t < 30; ++t) {
            const std::vector<Solid> pair{free_sphere(0, 4, 2.5, {8, 9, 4}), free_sphere(1, 4, 2.5, {16, 9, 4})};
            fluid.place_solids(pair);
            fluid.step();
            for (const SolidLoad& load : fluid.loads()) {
                LBM_ASSERT_CLOSE(0.0, load.force[0], 1e-12, buoyancy);
                LBM_ASSERT_CLOSE(buoyancy, load.force[2], 1e-12, buoyancy);
            }
            for (const SolidLoad& load : fluid.film_loads(pair, 1)) CPPUNIT_ASSERT_EQUAL(0.0, norm(load.force));
        }
    }

    /// In an undamped contact: all that stops them is the fluid. The film lets the contact close within (its resistance) / stiffness, 600 steps at tau = 2.
    void light_spheres_pushed_together_do_not_bounce()
    {
        for (const double tau : {0.6, 1.0, 2.0}) {
            Fluid fluid(test::lattice_config({26, 18, 18}, tau));
            std::vector<Solid> pair{free_sphere(0, 4, 0.6, {8.4, 9, 9.2}), free_sphere(1, 4, 0.6, {17.6, 9.3, 9})};
            const double push = 6 * kPi * (tau - 0.5) / 3 * 4 * 0.01;
            const double stiffness = 0.1 * pair[0].mass;  // of a contact law
            double gap = 1.2, fastest = 0;
            for (int t = 0; t < 4000; ++t) {
                coupled_step(fluid, pair, [&](const std::vector<Solid>& at) -> std::vector<Vec3> {
                    const double open = norm(at[1].position - at[0].position) - 8;
                    const double force = push + std::min(0.0, open) * stiffness;
                    return {{force, 0, 0}, {-force, 0, 0}};
                });
                const double before = gap;
                gap = norm(pair[1].position - pair[0].position) - 8;
                if (t > 100 && gap > 0) CPPUNIT_ASSERT(gap <= before);
                if (t > 3500) fastest = std::max(fastest, std::abs(gap - before));
            }
            CPPUNIT_ASSERT(fastest < 1e-5);
            LBM_ASSERT_CLOSE(-push / stiffness, gap, 0.01, push / stiffness);
        }
    }

    /// Implicit in the velocities, and yet the quasi-static balance of push and film is the exact one.
    void a_pushed_sphere_closes_its_gap_at_the_exact_speed()
    {
        FluidConfig c = test::lattice_config({24, 24, 24}, 1.0);
        c.inertia = false;
        test::walls(c, 2);
        const double nu = c.viscosity, stokes = 6 * kPi * nu * 4, push = stokes * 0.02;
        for (const int sub_steps : {1, 5}) {
            Fluid fluid(c);
            std::vector<Solid> s{free_sphere(0, 4, 1.2, {12.2, 11.7, 4.5})};
            double speed = 0, gap = 1;
            const auto down = [&](const std::vector<Solid>&) -> std::vector<Vec3> { return {{0, 0, -push}}; };
            while (gap > 0.04) {
                coupled_step(fluid, s, down, sub_steps);
                gap = s[0].position[2] - 4;
                speed = -s[0].velocity[2];
            }
            LBM_ASSERT_CLOSE(0.02 * 0.00981391132941, speed, 0.06, 0.02 * 0.00981391132941);
        }
    }

    void a_dense_suspension_comes_to_rest_and_keeps_its_momentum()
    {
        constexpr int n = 32;
        Fluid fluid(test::lattice_config({n, n, n}, 1.0));
        std::mt19937 random(11);
        std::uniform_real_distribution<double> speed(-0.02, 0.02);
        std::vector<Solid> grains;
        for (int i = 0; i < 4 * 4 * 4; ++i) {  // a lattice of touching neighbours, 45 % solid
            const int at[] = {i % 4, i / 4 % 4, i / 16};
            Solid s = free_sphere(i, 3.8, 1.0, {4.0 + 8 * at[0], 4.0 + 8 * at[1], 4.0 + 8 * at[2]});
            s.velocity = {speed(random), speed(random), speed(random)};
            s.angular_velocity = {0.3 * speed(random), 0.3 * speed(random), 0.3 * speed(random)};
            grains.push_back(s);
        }
        fluid.place_solids(grains);
        const auto momentum = [&] {
            Vec3 sum = fluid.total_momentum();
            for (const Solid& s : grains) sum += s.mass * s.velocity;
            return sum;
        };
        const auto fastest = [&] {
            double v = 0;
            Vec3 mean{};
            for (const Solid& s : grains) mean += (1.0 / grains.size()) * s.velocity;
            for (const Solid& s : grains)
                v = std::max(v, norm(s.velocity - mean) + s.radius * norm(s.angular_velocity));
            return v;
        };
        const Vec3 start = momentum();
        const double before = fastest();
        for (int t = 0; t < 300; ++t) coupled_step(fluid, grains, no_push);
        CPPUNIT_ASSERT(fastest() < 0.01 * before);
        for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(start[d], momentum()[d], 1e-10, grains[0].mass * 0.02 * 64);
    }

    void roughness_out_of_range_is_refused()
    {
        for (const double bad : {0.0, -1.0, 0.5, std::nan("")}) {
            FluidConfig c = test::lattice_config({8, 8, 8}, 1);
            c.lubrication_roughness = bad;
            CPPUNIT_ASSERT_THROW(Fluid{c}, ConfigError);
        }
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(FilmLoads);

}  // namespace
