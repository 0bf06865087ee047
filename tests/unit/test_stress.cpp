#include "close.hpp"
#include "lattice_units.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

namespace {

using namespace lbm;

/// An identity of the steady state, and how far the transient has decayed.
constexpr double kSteady = 1e-7;

class Stress : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Stress);
    CPPUNIT_TEST(fluid_alone_carries_what_the_walls_bear);
    CPPUNIT_TEST(fluid_and_sphere_carry_what_the_walls_bear);
    CPPUNIT_TEST(pressure_is_negative_tension);
    CPPUNIT_TEST_SUITE_END();

    static constexpr double kShear = 1e-3;

    static FluidConfig couette(const std::array<int, 3>& cells, Lattice lattice)
    {
        FluidConfig c = test::lattice_config(cells, 1.5);
        c.inertia = false;
        c.lattice = lattice;
        test::walls(c, 2);
        c.faces[kZMin].velocity = {-0.5 * kShear * cells[2], 0.1 * kShear * cells[2], 0};
        c.faces[kZMax].velocity = {0.5 * kShear * cells[2], 0, 0};
        return c;
    }

    static double wall_stress(const Fluid& fluid, int along)
    {
        const auto& cells = fluid.config().cells;
        return 0.5 * (fluid.boundary_force(kZMin)[along] - fluid.boundary_force(kZMax)[along]) / (cells[0] * cells[1]);
    }

    void fluid_alone_carries_what_the_walls_bear()
    {
        for (const Lattice lattice : {Lattice::d3q19, Lattice::d3q27}) {
            const FluidConfig c = couette({2, 3, 8}, lattice);
            Fluid fluid(c);
            for (int t = 0; t < 1500; ++t) fluid.step();
            const StressParts stress = fluid.stress();
            LBM_ASSERT_CLOSE(c.viscosity * kShear, stress.fluid[0][2], kSteady, c.viscosity * kShear);
            LBM_ASSERT_CLOSE(-0.1 * c.viscosity * kShear, stress.fluid[1][2], kSteady, c.viscosity * kShear);
            for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(0.0, stress.solids[d][2], kSteady, 1.0);
        }
    }

    void fluid_and_sphere_carry_what_the_walls_bear()
    {
        const FluidConfig c = couette({13, 12, 14}, Lattice::d3q19);
        Fluid fluid(c);
        Solid s;
        s.radius = 3.4;
        s.position = {6.2, 6.3, 7};
        s.velocity = {0, -0.05 * 0.1 * kShear * 14, 0};
        s.angular_velocity = {0, 0.4 * kShear, 0};
        fluid.place_solids({s});
        for (int t = 0; t < 2500; ++t) fluid.step();
        const StressParts stress = fluid.stress();
        const double scale = c.viscosity * kShear;
        for (int along = 0; along < 2; ++along) {
            // A solid that bears a force makes the stress differ from plane to plane: about its centre, at mid-height, that averages out.
            const double total = stress.fluid[along][2] + stress.solids[along][2];
            LBM_ASSERT_CLOSE(wall_stress(fluid, along), total, kSteady, scale);
        }
        CPPUNIT_ASSERT(stress.solids[0][2] > 0.1 * scale);
        // The sphere is held: its torque is what the stress lacks in symmetry.
        const double torque = fluid.loads()[0].torque[1] / (13 * 12 * 14);
        LBM_ASSERT_CLOSE(torque, stress.solids[0][2] - stress.solids[2][0], kSteady, scale);
    }

    void pressure_is_negative_tension()
    {
        FluidConfig c = test::lattice_config({6, 3, 3}, 0.8);
        c.faces[kXMin].type = c.faces[kXMax].type = FaceType::pressure;
        c.faces[kXMin].pressure = c.faces[kXMax].pressure = 0.002;
        Fluid fluid(c);
        for (int t = 0; t < 2000; ++t) fluid.step();
        const StressParts stress = fluid.stress();
        for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(-0.002, stress.fluid[d][d], 1e-3, 0.002);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Stress);

}  // namespace
