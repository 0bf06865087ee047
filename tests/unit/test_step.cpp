#include "close.hpp"
#include "lattice/d3q27.hpp"
#include "lattice/vec3.hpp"
#include "lattice_units.hpp"
#include "reference_fluid.hpp"

#include "lbm/errors.hpp"
#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <cmath>
#include <limits>
#include <string>

namespace {

using namespace lbm;
using lbm::test::lattice_config;
using lbm::test::ReferenceFluid;

/// After some tens of steps of order-one arithmetic.
constexpr double kRoundOff = 1e-13;

/// Where spheres leave narrow pores, whose law the engine evaluates in 32 bits and the twin in 64: it changes loads by some per cent.
constexpr double kRoundOffOfPores = 5e-8;

/// Rounding of the populations' deviations to 32 bits, against speeds of 0.05.
constexpr double kSingleRoundOff = 2e-6;

constexpr int kSteps = 12;

std::vector<Solid> moved(std::vector<Solid> solids, double t)
{
    for (Solid& s : solids)
        for (int d = 0; d < 3; ++d) s.position[d] += t * s.velocity[d];
    return solids;
}

/// Velocity field of the twin after its last collision, from the momentum alone: the engine's outgoing momentum must agree.
template <class L>
Vec3 momentum(ReferenceFluid<L>& reference)
{
    Vec3 sum{};
    for (int i = 0; i < L::Q; ++i)
        for (const double f : reference.population(i))
            for (int d = 0; d < 3; ++d) sum[d] += L::c[i][d] * f;
    return sum;
}

class Step : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Step);
    CPPUNIT_TEST(agrees_with_the_plain_twin_in_a_periodic_box);
    CPPUNIT_TEST(agrees_between_walls_at_odd_sizes);
    CPPUNIT_TEST(agrees_in_one_cell_thick_boxes);
    CPPUNIT_TEST(agrees_wherever_two_kinds_of_face_meet);
    CPPUNIT_TEST(agrees_with_solids_across_periodic_faces_and_sharing_cells);
    CPPUNIT_TEST(agrees_where_spheres_leave_narrow_pores);
    CPPUNIT_TEST(agrees_in_stokes_flow_with_any_magic_parameter);
    CPPUNIT_TEST(single_storage_agrees_to_its_own_round_off);
    CPPUNIT_TEST(any_number_of_threads_gives_the_same_bits);
    CPPUNIT_TEST(solids_that_moved_step_by_step_stand_as_if_placed_anew);
    CPPUNIT_TEST(steps_at_once_are_the_steps_one_by_one);
    CPPUNIT_TEST(a_fluid_that_diverged_leaves_nothing_to_the_next_one);
    CPPUNIT_TEST_SUITE_END();

    void compare(FluidConfig c, const std::vector<Solid>& start, double tolerance = kRoundOff)
    {
        compare_on<D3Q19>(c, start, tolerance);
        c.lattice = lbm::Lattice::d3q27;
        compare_on<D3Q27>(c, start, tolerance);
    }

    template <class L>
    void compare_on(FluidConfig c, const std::vector<Solid>& start, double tolerance)
    {
        c.lubrication = false;  // the reference has the lattice's loads only
        Fluid fluid(c);
        ReferenceFluid<L> reference(c);
        fluid.place_solids(start);
        auto before = reference.at_the_start(start);
        for (int t = 0; t < kSteps; ++t) {
            const auto solids = moved(start, t), last = moved(start, std::max(0, t - 1));
            fluid.place_solids(solids);
            fluid.step();
            reference.step(solids);
            for (std::size_t s = 0; s < start.size(); ++s) {
                // The bookkeeping of the physics page. L_in is about the centre, which has moved since.
                const auto& now = reference.loads()[s];
                before[s].angular_inside -= cross(solids[s].position - last[s].position, before[s].inside);
                for (int d = 0; d < 3; ++d) {
                    const double force = now.inside[d] - before[s].inside[d] - now.force[d];
                    const double torque = now.angular_inside[d] - before[s].angular_inside[d] - now.torque[d];
                    LBM_ASSERT_CLOSE(force, fluid.loads()[s].force[d], tolerance, 10.0);
                    LBM_ASSERT_CLOSE(torque, fluid.loads()[s].torque[d], tolerance, 10.0);
                }
            }
            before = reference.loads();
        }
        // Fields: a population that went astray anywhere shows in velocity or pressure somewhere.
        const auto velocity = fluid.velocity_field(), pressure = fluid.pressure_field();
        const auto epsilon = fluid.solid_fraction_field();
        const auto [nx, ny, nz] = c.cells;
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y)
                for (int x = 0; x < nx; ++x) {
                    const std::size_t at = reference.cell(x, y, z);
                    double drho = 0;
                    Vec3 j{};
                    for (int i = 0; i < L::Q; ++i) {
                        drho += reference.population(i)[at];
                        for (int d = 0; d < 3; ++d) j[d] += L::c[i][d] * reference.population(i)[at];
                    }
                    LBM_ASSERT_CLOSE(drho / 3, pressure[at], tolerance, 1.0);
                    if (epsilon[at] > 0) continue;
                    for (int d = 0; d < 3; ++d) {
                        const double u = (j[d] + 0.5 * c.acceleration[d]) / (c.inertia ? 1 + drho : 1);
                        LBM_ASSERT_CLOSE(u, velocity[3 * at + d], tolerance, 1.0);
                    }
                }
        CPPUNIT_ASSERT(norm(momentum(reference)) > 0);
    }

    static FluidConfig driven(const std::array<int, 3>& cells, double tau)
    {
        FluidConfig c = lattice_config(cells, tau);
        c.acceleration = {1e-4, -2e-4, 5e-5};
        return c;
    }

    static std::vector<Solid> one_sphere()
    {
        Solid s;
        s.radius = 2.6;
        s.position = {5.3, 4.1, 5.2};
        s.velocity = {0.05, -0.02, 0.01};
        s.angular_velocity = {0.004, 0.01, -0.006};
        return {s};
    }

    void agrees_with_the_plain_twin_in_a_periodic_box()
    {
        compare(driven({11, 10, 12}, 0.6), {});
        compare(driven({11, 10, 12}, 0.6), one_sphere());
        compare(driven({16, 9, 8}, 1.7), one_sphere(), kRoundOffOfPores);
    }

    void agrees_between_walls_at_odd_sizes()
    {
        FluidConfig c = driven({13, 9, 10}, 0.8);
        for (int axis = 0; axis < 3; ++axis) {
            lbm::test::walls(c, axis);
            compare(c, one_sphere());
        }
        c.faces[kYMax].velocity = {0.05, 0, 0.02};
        c.faces[kXMin].velocity = {0, 0.03, 0};
        compare(c, one_sphere());
        // A sphere that stands out of two walls.
        auto out = one_sphere();
        out[0].position = {1.5, 8.2, 5};
        compare(c, out);
    }

    void agrees_in_one_cell_thick_boxes()
    {
        for (const std::array<int, 3>& cells :
             {std::array{1, 7, 9}, std::array{9, 1, 7}, std::array{17, 9, 1}, std::array{1, 1, 5}}) {
            FluidConfig c = driven(cells, 0.7);
            compare(c, {});
            for (int axis = 0; axis < 3; ++axis) lbm::test::walls(c, axis);
            compare(c, {});
        }
    }

    /// Every kind of face, each next to every other.
    static std::vector<FluidConfig> boxes_of_all_faces(const std::array<int, 3>& cells)
    {
        std::vector<FluidConfig> all;
        for (int kinds = 0; kinds < 5 * 5 * 5; ++kinds) {
            FluidConfig c = driven(cells, 0.7);
            c.max_mach = 1;
            for (int d = 0, rest = kinds; d < 3; ++d, rest /= 5) {
                FaceCondition &low = c.faces[2 * d], &high = c.faces[2 * d + 1];
                FaceCondition none, wall{FaceType::no_slip, {0.03, 0.01, 0.02}, 0}, slip{FaceType::free_slip, {}, 0},
                    inlet{FaceType::velocity, {0.02, -0.01, 0.015}, 0}, outlet{FaceType::pressure, {}, 0.001 * (d + 1)};
                wall.velocity[d] = 0;
                const FaceCondition pairs[5][2] = {
                    {none, none}, {wall, slip}, {inlet, outlet}, {outlet, wall}, {slip, inlet}};
                low = pairs[rest % 5][0];
                high = pairs[rest % 5][1];
            }
            all.push_back(c);
        }
        return all;
    }

    void agrees_wherever_two_kinds_of_face_meet()
    {
        for (FluidConfig c : boxes_of_all_faces({4, 5, 3})) {
            if (is_refused(c)) continue;  // fluid only comes in
            compare(c, {});
            c.cells = {1, 4, 2};
            c.inertia = false;
            compare(c, {});
        }
        for (FluidConfig c : boxes_of_all_faces({9, 8, 9}))
            if (!is_refused(c) && c.faces[kXMax].type == FaceType::pressure) compare(c, one_sphere(), kRoundOffOfPores);
    }

    static bool is_refused(const FluidConfig& c)
    {
        try {
            Fluid fluid(c);
            return false;
        } catch (const ConfigError&) {
            return true;
        }
    }

    void agrees_with_solids_across_periodic_faces_and_sharing_cells()
    {
        auto solids = one_sphere();
        solids[0].position = {0.2, 9.9, 11.7};
        Solid second = solids[0];
        second.id = 1;
        second.radius = 2.2;
        second.position = {4.4, 9.5, 11.9};  // touches the first
        second.velocity = {-0.03, 0.01, 0.02};
        Solid third = second;
        third.id = 2;
        third.position = {2.5, 12.6, 12.2};  // overlaps both
        solids.push_back(second);
        solids.push_back(third);
        compare(driven({11, 10, 12}, 0.6), solids, kRoundOffOfPores);
        // As wide as the box: its rims share cells with themselves.
        auto wide = one_sphere();
        wide[0].radius = 4.5;
        compare(driven({9, 9, 9}, 0.9), wide, kRoundOffOfPores);
    }

    void agrees_where_spheres_leave_narrow_pores()
    {
        // Between two of them, to images behind periodic faces, and to mirror images behind freeSlip faces.
        auto solids = one_sphere();
        solids[0].velocity = solids[0].angular_velocity = {};
        solids[0].radius = 3;
        solids[0].position = {3.4, 5.1, 3.6};
        Solid second = solids[0];
        second.id = 1;
        second.radius = 2.4;
        second.position = {8.2, 5.4, 6.6};
        solids.push_back(second);
        for (const bool moving : {false, true}) {
            if (moving) solids[1].velocity = {0.02, -0.01, 0.03};
            FluidConfig c = driven({11, 10, 12}, 0.6);
            compare(c, solids, kRoundOffOfPores);
            c.faces[kZMin].type = c.faces[kZMax].type = FaceType::free_slip;
            compare(c, solids, kRoundOffOfPores);
        }
    }

    void agrees_in_stokes_flow_with_any_magic_parameter()
    {
        for (const double lambda : {0.125, 0.1875, 0.25}) {
            FluidConfig c = driven({11, 10, 12}, 0.55);
            c.inertia = false;
            c.magic_parameter = lambda;
            compare(c, one_sphere());
        }
    }

    void single_storage_agrees_to_its_own_round_off()
    {
        // The longer row has runs of fluid cells of all lengths.
        for (const int nx : {11, 43})
            for (const bool inertia : {true, false}) {
                FluidConfig c = driven({nx, 10, 12}, 0.6);
                c.storage = Storage::single_precision;
                c.inertia = inertia;
                compare(c, one_sphere(), kSingleRoundOff);
            }
    }

    /// Enough free spheres and large enough faces for every loop that may run in parallel to do so.
    static std::vector<Solid> many_spheres()
    {
        std::vector<Solid> all;
        for (int k = 0; k < 5; ++k)
            for (int j = 0; j < 7; ++j)
                for (int i = 0; i < 8; ++i) {
                    Solid s = one_sphere()[0];
                    s.id = static_cast<std::int64_t>(all.size());
                    s.position = {12.0 * i + 0.1 * j, 12.0 * j + 0.2 * k, 12.0 * k + 0.15 * i};
                    s.velocity[0] *= 0.2 * (i - 3.5);
                    s.mass = 150;
                    s.inertia = 400;
                    all.push_back(s);
                }
        return all;
    }

    void any_number_of_threads_gives_the_same_bits()
    {
        const auto solids = many_spheres();
        std::vector<double> first;
        std::vector<Vec3> first_forces;
        for (const int threads : {1, 2, 3, 7}) {
            FluidConfig c = driven({96, 84, 60}, 0.6);
            c.threads = threads;
            Fluid fluid(c);
            for (int t = 0; t < 3; ++t) {
                fluid.place_solids(moved(solids, t));
                fluid.step();
            }
            std::vector<Vec3> forces;
            for (const SolidLoad& load : fluid.loads()) forces.push_back(load.force + load.torque);
            if (first.empty()) {
                first = fluid.velocity_field();
                first_forces = forces;
            }
            CPPUNIT_ASSERT(first == fluid.velocity_field());
            CPPUNIT_ASSERT(first_forces == forces);
        }
    }

    void solids_that_moved_step_by_step_stand_as_if_placed_anew()
    {
        const FluidConfig c = driven({19, 14, 15}, 0.6);
        Fluid moving(c), placed(c);
        for (int t = 0; t < 60; ++t) moving.place_solids(moved(one_sphere(), t));
        placed.place_solids(moved(one_sphere(), 59));
        CPPUNIT_ASSERT(moving.solid_fraction_field() == placed.solid_fraction_field());
    }

    /// Fields and loads have the same bits, whether or not the solids let the fluid leave out loads on its way.
    void steps_at_once_are_the_steps_one_by_one()
    {
        Solid beside = one_sphere()[0];
        beside.id = 1;
        beside.position = {13, 8, 9};
        Solid slab;
        slab.id = 2;
        slab.shape = Shape::box;
        slab.position = {9.5, 7, 13};
        slab.half_extents = {9.5, 7, 2};
        for (const Scheme scheme : {Scheme::exact, Scheme::bounce_back})
            for (const double mass : {std::numeric_limits<double>::infinity(), 90.0})
                for (const double speed : {0.0, 0.01}) {
                    FluidConfig c = driven({19, 14, 15}, 0.8);
                    c.scheme = scheme;
                    Fluid at_once(c), one_by_one(c);
                    Solid one = one_sphere()[0];
                    one.mass = one.inertia = 90;  // at first free: then the fluid still owes it some of its load
                    for (Fluid* const fluid : {&at_once, &one_by_one}) {
                        fluid->place_solids({one, beside, slab});
                        fluid->step(0);
                        CPPUNIT_ASSERT_EQUAL(std::int64_t{0}, fluid->steps());
                        fluid->step();
                    }
                    one.mass = one.inertia = mass;
                    one.velocity = {speed, 0, 0};
                    for (const int count : {7, 2, 1, 9}) {
                        at_once.place_solids({one, beside, slab});
                        one_by_one.place_solids({one, beside, slab});
                        at_once.step(count);
                        for (int t = 0; t < count; ++t) one_by_one.step();
                        CPPUNIT_ASSERT_EQUAL(one_by_one.steps(), at_once.steps());
                        CPPUNIT_ASSERT(one_by_one.velocity_field() == at_once.velocity_field());
                        CPPUNIT_ASSERT(one_by_one.total_momentum() == at_once.total_momentum());
                        for (int s = 0; s < 3; ++s) {
                            const SolidLoad &a = one_by_one.loads()[s], &b = at_once.loads()[s];
                            CPPUNIT_ASSERT(norm(a.force) > 0);
                            CPPUNIT_ASSERT(a.force == b.force && a.torque == b.torque && a.stresslet == b.stresslet);
                        }
                    }
                }
        CPPUNIT_ASSERT_THROW(Fluid(driven({8, 8, 8}, 0.8)).step(-1), ConfigError);
    }

    void a_fluid_that_diverged_leaves_nothing_to_the_next_one()
    {
        // Rows of 12 and 10 cells take the same memory; what stands in the last two cells of the longer one must not count in the other.
        const auto with_ball = [](int nx, double u, double x) {
            FluidConfig c = lattice_config({nx, 8, 8}, 0.8);
            c.initial_velocity = {u, 0, 0};
            Solid ball;
            ball.position = {x, 4, 4};
            ball.radius = 3;
            Fluid fluid(c);
            fluid.place_solids({ball});
            return fluid;
        };
        Fluid next = with_ball(10, 1e-3, 7), diverges = with_ball(12, 1e200, 9);
        CPPUNIT_ASSERT_THROW(diverges.step(), RunError);
        next.step();
        CPPUNIT_ASSERT(std::isfinite(next.loads()[0].force[0]) && std::isfinite(next.loads()[0].torque[2]));
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Step);

}  // namespace
