#include "close.hpp"
#include "face_conditions.hpp"
#include "says.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <functional>

namespace {

using namespace lbm;
using namespace lbm::test;

constexpr double kRoundOff = 1e-13;

/// What the scheme solves exactly, after the transient has decayed.
constexpr double kExact = 1e-10;

/// Sound and the compressibility of the lattice's fluid, of the order of the Mach number squared.
constexpr double kBernoulli = 5e-3;

/// What each kind of face does to the flow.
class FacesOfTheBox : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(FacesOfTheBox);
    CPPUNIT_TEST(free_slip_carries_no_shear);
    CPPUNIT_TEST(half_a_channel_with_free_slip_is_the_channel);
    CPPUNIT_TEST(pressure_face_is_the_plane_between_two_mirrored_halves);
    CPPUNIT_TEST(plug_flow_passes_velocity_and_pressure_faces_unchanged);
    CPPUNIT_TEST(a_stream_that_is_there_at_the_start_makes_no_sound);
    CPPUNIT_TEST(bernoulli_holds_between_pressure_faces);
    CPPUNIT_TEST(a_wake_leaves_through_a_pressure_face);
    CPPUNIT_TEST(solids_cross_pressure_faces_without_harm);
    CPPUNIT_TEST(change_of_tau_keeps_a_pressure_driven_flow);
    CPPUNIT_TEST(any_number_of_threads_gives_the_same_bits);
    CPPUNIT_TEST(what_makes_no_sense_is_refused);
    CPPUNIT_TEST_SUITE_END();

    void free_slip_carries_no_shear()
    {
        FluidConfig c = test::lattice_config({4, 5, 6}, 0.7);
        c.acceleration = {2e-5, 1e-5, 0};
        pair(c, 2, of(FaceType::free_slip), of(FaceType::free_slip));
        Fluid fluid(c);
        const double mass = fluid.total_mass();
        run(fluid, 501);
        const auto u = fluid.velocity_field();
        for (std::size_t cell = 0; cell < u.size() / 3; ++cell)
            for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(c.acceleration[d] * 501, u[3 * cell + d], kRoundOff, 0.01);
        for (const Face face : {kZMin, kZMax})
            for (int d = 0; d < 2; ++d) LBM_ASSERT_CLOSE(0.0, fluid.boundary_force(face)[d], kRoundOff, 0.01 * 20);
        LBM_ASSERT_CLOSE(mass, fluid.total_mass(), kRoundOff, mass);
    }

    void half_a_channel_with_free_slip_is_the_channel()
    {
        const int n = 7;
        for (int axis = 0; axis < 3; ++axis) {
            std::array<int, 3> cells{3, 4, 2};
            cells[axis] = 2 * n;
            FluidConfig c = test::lattice_config(cells, 0.6);
            c.acceleration = {1e-4, 2e-4, -1e-4};
            c.acceleration[axis] = 0;
            test::walls(c, axis);
            Fluid full(c);
            c.cells[axis] = n;
            c.faces[2 * axis + 1].type = FaceType::free_slip;
            Fluid half(c);
            run(full, 300);
            run(half, 300);
            for (int i = 0; i < n; ++i) {
                Vec3 at{0.5, 0.5, 0.5};
                at[axis] = i + 0.5;
                const Vec3 a = full.velocity_at(at), b = half.velocity_at(at);
                for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(a[d], b[d], kRoundOff, 0.01);
            }
        }
    }

    void pressure_face_is_the_plane_between_two_mirrored_halves()
    {
        for (const Lattice lattice : {Lattice::d3q19, Lattice::d3q27}) mirrored_halves(lattice);
    }

    /// Two spheres that move as images of each other, normal velocities the same and tangential ones opposite; and one of them before a pressure face.
    void mirrored_halves(Lattice lattice)
    {
        FluidConfig c = stokes({12, 5, 6}, 0.8);
        c.lattice = lattice;
        c.lubrication = false;  // the half has no film across its face
        test::walls(c, 0);
        test::walls(c, 2);
        Fluid whole(c);
        c.cells[0] = 6;
        c.faces[kXMax] = at_pressure(0);
        Fluid half(c);
        Solid left, right;
        left.radius = right.radius = 2;
        left.position = {3.2, 2.3, 3.4};
        right.position = {12 - 3.2, 2.3, 3.4};
        left.velocity = {0.004, 0, 0.01};
        right.velocity = {0.004, 0, -0.01};
        right.id = 1;
        whole.place_solids({left, right});
        half.place_solids({left});
        run(whole, 200);
        run(half, 200);
        for (double x = 0.5; x < 6; ++x)
            for (double z = 0.5; z < 6; ++z) {
                const Vec3 at{x, 1.5, z};
                LBM_ASSERT_CLOSE(whole.pressure_at(at), half.pressure_at(at), kRoundOff, 0.01);
                for (int d = 0; d < 3; ++d)
                    LBM_ASSERT_CLOSE(whole.velocity_at(at)[d], half.velocity_at(at)[d], kRoundOff, 0.01);
            }
        LBM_ASSERT_CLOSE(whole.loads()[0].force[2], half.loads()[0].force[2], kRoundOff, 0.1);
    }

    void plug_flow_passes_velocity_and_pressure_faces_unchanged()
    {
        for (const double u : {0.04, -0.04})
            for (const double p : {0.0, 0.01}) {
                FluidConfig c = test::lattice_config({9, 3, 4}, 0.9);
                pair(c, 2, of(FaceType::free_slip), of(FaceType::free_slip));
                pair(c, 0, with_velocity({u, 0, 0}), at_pressure(p));
                Fluid fluid(c);
                run(fluid, 6000);
                // the velocity face prescribes rho_0 u; what enters through the pressure face was at rest before
                const double inside = u > 0 ? p : p - 0.5 * u * u / (1 + 3 * p);
                const double rho = 1 + 3 * inside;
                const double tolerance =
                    u > 0 ? kExact
                          : 10 * std::pow(u, 4);  // of the fourth order: the density of the given pressure is used
                const auto velocity = fluid.velocity_field(), pressure = fluid.pressure_field();
                for (std::size_t cell = 0; cell < pressure.size(); ++cell) {
                    LBM_ASSERT_CLOSE(inside, pressure[cell], tolerance, 1.0);
                    LBM_ASSERT_CLOSE(u / rho, velocity[3 * cell], tolerance, 1.0);
                }
            }
    }

    void a_stream_that_is_there_at_the_start_makes_no_sound()
    {
        FluidConfig c = test::lattice_config({9, 3, 4}, 0.6);
        pair(c, 2, of(FaceType::free_slip), of(FaceType::free_slip));
        pair(c, 0, with_velocity({0.06, 0, 0}), at_pressure(0));
        c.initial_velocity = {0.06, 0, 0};
        for (const Storage storage : {Storage::double_precision, Storage::single_precision}) {
            c.storage = storage;
            Fluid fluid(c);
            run(fluid, 51);
            const double round_off = storage == Storage::double_precision ? kRoundOff : 1e-6;
            for (const double p : fluid.pressure_field()) LBM_ASSERT_CLOSE(0.0, p, round_off, 0.06);
            const auto velocity = fluid.velocity_field();
            for (std::size_t i = 0; i < velocity.size(); ++i)
                LBM_ASSERT_CLOSE(i % 3 ? 0 : 0.06, velocity[i], round_off, 0.06);
        }
    }

    void bernoulli_holds_between_pressure_faces()
    {
        // A plug without friction, sped up by a pressure difference, from rest outside: rho L du/dt = drop - rho u^2 / 2.
        const double drop = 2e-4, length = 6;
        FluidConfig c = test::lattice_config({6, 3, 3}, 0.8);
        pair(c, 0, at_pressure(drop), at_pressure(0));
        Fluid fluid(c);
        const double U = std::sqrt(2 * drop);
        for (int t = 0; t < 1600; t += 400) {
            run(fluid, 400);
            LBM_ASSERT_CLOSE(U * std::tanh(fluid.time() * U / (2 * length)), fluid.average_velocity()[0], kBernoulli,
                             U);
        }
    }

    void a_wake_leaves_through_a_pressure_face()
    {
        // Re = 54, the sphere a diameter before the face; the flux is that of the inlet once the sound of the start is gone.
        FluidConfig c = test::lattice_config({24, 18, 18}, 0.51);
        pair(c, 0, with_velocity({0.03, 0, 0}), at_pressure(0));
        pair(c, 2, of(FaceType::free_slip), of(FaceType::free_slip));
        Fluid fluid(c);
        Solid s;
        s.radius = 3;
        s.position = {12, 10.2, 9.1};
        fluid.place_solids({s});
        run(fluid, 2500);
        LBM_ASSERT_CLOSE(0.03 * 324, fluid.boundary_flux(kXMax), 0.05, 0.03 * 324);
        CPPUNIT_ASSERT(fluid.max_mach() < 0.12);
    }

    void solids_cross_pressure_faces_without_harm()
    {
        for (const double tau : {0.52, 0.8, 2.0}) {
            FluidConfig c = test::lattice_config({16, 12, 12}, tau);
            pair(c, 0, at_pressure(1e-4), at_pressure(0));
            Fluid fluid(c);
            Solid s = moving_sphere();
            s.velocity = {0.03, 0.003, 0};
            s.position = {-2, 6, 6};
            double mach = 0;
            for (int t = 0; t < 700; ++t) {
                fluid.place_solids({s});
                fluid.step();
                s.position += s.velocity;
                mach = std::max(mach, fluid.max_mach());
            }
            CPPUNIT_ASSERT(mach < 0.1);
            // Free ones of half and twice the fluid's density, at the face: they slow down. At tau = 2 a lighter one that turns there does not.
            c.faces[kXMin].pressure = 0;
            for (const double density : {tau < 2 ? 0.5 : 1.0, 2.0}) {
                Fluid still(c);
                Solid free = moving_sphere();
                free.position = {15.5, 6, 6};
                free.mass = density * 4 * std::numbers::pi / 3 * std::pow(free.radius, 3);
                free.inertia = 0.4 * free.mass * free.radius * free.radius;
                free.velocity = {0.01, 0.01, -0.01};
                for (int t = 0; t < 500; ++t) {
                    still.place_solids({free});
                    still.step();
                    free.velocity += (1 / free.mass) * still.loads()[0].force;
                    free.angular_velocity += (1 / free.inertia) * still.loads()[0].torque;
                    free.position += free.velocity;
                }
                CPPUNIT_ASSERT(norm(free.velocity) < 0.01);
            }
        }
    }

    void change_of_tau_keeps_a_pressure_driven_flow()
    {
        for (const bool inertia : {false, true})
            for (int odd = 0; odd < 2; ++odd) {
                FluidConfig c = test::lattice_config({10, 10, 10}, 0.8);
                c.inertia = inertia;
                pair(c, 0, at_pressure(1e-5), at_pressure(0));
                pair(c, 2, of(FaceType::free_slip), of(FaceType::no_slip));
                Fluid fluid(c);
                Solid s;
                s.radius = 3.1;
                s.position = {5.1, 5, 5};
                fluid.place_solids({s});
                run(fluid, 3000 + odd);
                const double force = fluid.loads()[0].force[0], flux = fluid.boundary_flux(kXMax);
                const Vec3 wall = fluid.boundary_force(kZMax);
                const double kept = inertia ? 2e-3 : 1e-9;
                for (const double tau : {2.0, 0.6}) {
                    fluid.change_tau(tau);
                    LBM_ASSERT_CLOSE(flux, fluid.boundary_flux(kXMax), kept, flux);
                    LBM_ASSERT_CLOSE(wall[0], fluid.boundary_force(kZMax)[0], kept, wall[0]);
                    run(fluid, 40);
                    LBM_ASSERT_CLOSE(force, fluid.loads()[0].force[0], kept, force);
                    LBM_ASSERT_CLOSE(flux, fluid.boundary_flux(kXMax), kept, flux);
                }
            }
    }

    void any_number_of_threads_gives_the_same_bits()
    {
        std::vector<double> first;
        std::vector<double> fluxes;
        for (const int threads : {1, 2, 3}) {
            FluidConfig c = all_kinds_of_faces();
            c.cells = {70, 72, 68};
            c.threads = threads;
            Fluid fluid(c);
            run(fluid, 3);
            if (first.empty()) {
                first = fluid.velocity_field();
                fluxes = {fluid.boundary_flux(kXMax), fluid.boundary_force(kYMin)[0]};
            }
            CPPUNIT_ASSERT(first == fluid.velocity_field());
            CPPUNIT_ASSERT(fluxes[0] == fluid.boundary_flux(kXMax) && fluxes[1] == fluid.boundary_force(kYMin)[0]);
        }
    }

    void what_makes_no_sense_is_refused()
    {
        const auto refusal = [](const std::function<void(FluidConfig&)>& spoil) {
            FluidConfig c = test::lattice_config({4, 4, 4}, 0.8);
            for (int axis = 0; axis < 3; ++axis) test::walls(c, axis);
            spoil(c);
            return test::says<ConfigError>([&] { Fluid fluid(c); });
        };
        test::assert_says(refusal([](auto& c) {
                              c.faces[kXMin] = with_velocity({0.01, 0, 0});
                          }),
                          "velocity faces let 0.16 m3/s more in than out: make the velocities balance");
        test::assert_says(refusal([](auto& c) {
                              pair(c, 0, with_velocity({0.01, 0, 0}), with_velocity({0.02, 0, 0}));
                          }),
                          "more out than in");
        CPPUNIT_ASSERT(refusal([](auto& c) {
                           pair(c, 0, with_velocity({0.01, 0, 0}), with_velocity({0.01, 0, 0}));
                       }).empty());
        // nu = 0.1
        test::assert_says(
            refusal([](auto& c) {
                pair(c, 0, with_velocity({0.32, 0, 0}), with_velocity({0.32, 0, 0}));
            }),
            "velocity of face xmax = 0.32 m/s along its normal: u dx / nu = 3.2 is unstable, at most 3 is "
            "possible where fluid leaves; use dx <= 0.9375 m, or a pressure face");
        test::assert_says(
            refusal([](auto& c) {
                pair(c, 0, with_velocity({1.1, 0, 0}), at_pressure(0));
            }),
            "u dx / nu = 11 is unstable, at most 10 is possible where fluid enters; use dx <= 0.9090909 m");
        CPPUNIT_ASSERT(refusal([](auto& c) {
                           c.inertia = false;
                           pair(c, 0, with_velocity({1.1, 0, 0}), with_velocity({1.1, 0, 0}));
                       }).empty());
        test::assert_says(refusal([](auto& c) {
                              c.faces[kYMax] = {FaceType::free_slip, {0.1, 0, 0}, 0};
                          }),
                          "velocity of face ymax: only a velocity face or a moving no-slip wall has one");
        test::assert_says(refusal([](auto& c) {
                              c.faces[kYMax] = {FaceType::pressure, {0.1, 0, 0}, 0};
                          }),
                          "velocity of face ymax: only");
        test::assert_says(refusal([](auto& c) { c.faces[kZMin].pressure = 3; }),
                          "pressure of face zmin = 3 Pa: only a pressure face has one");
        test::assert_says(refusal([](auto& c) { c.faces[kZMin] = at_pressure(std::nan("")); }),
                          "pressure of face zmin = nan: must be finite");
        test::assert_says(refusal([](auto& c) { c.faces[kZMin] = at_pressure(0.1); }),
                          "changes the density by 30 % on this lattice, at most 20 % are allowed; use tau <= ");
        test::assert_says(refusal([](auto& c) {
                              c.faces[kZMin] = with_velocity({0, std::nan(""), 0});
                          }),
                          "velocity of face zmin");
        Fluid fluid(all_kinds_of_faces());
        auto faces = all_kinds_of_faces().faces;
        faces[kYMax].type = FaceType::no_slip;
        test::assert_says(test::says<ConfigError>([&] { fluid.change_faces(faces); }),
                          "its type cannot change any more");
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(FacesOfTheBox);

}  // namespace
