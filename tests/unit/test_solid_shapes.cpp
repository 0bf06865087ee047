#include "close.hpp"
#include "lattice_units.hpp"
#include "physics/box_fraction.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <numbers>

namespace {

using namespace lbm;

constexpr double kPi = std::numbers::pi;
constexpr double kExact = 1e-8;         ///< what the scheme solves exactly, after the transient has decayed
constexpr double kRoundOff = 1e-12;     ///< sums over hundreds of cells
constexpr double kLinesPerCell = 1e-3;  ///< of a volume, from cells integrated along 8 x 8 lines (measured 2e-4)

constexpr std::array<int, 3> kCells{24, 22, 20};
constexpr std::array<bool, 3> kPeriodic{true, true, true}, kClosed{false, false, false};

double volume(const SolidFraction& fraction)
{
    double sum = 0;
    for (int k = 0; k < fraction.count()[2]; ++k)
        for (int j = 0; j < fraction.count()[1]; ++j)
            for (int i = 0; i < fraction.count()[0]; ++i) {
                const double epsilon = fraction.row(j, k)[i];
                CPPUNIT_ASSERT(epsilon >= 0 && epsilon <= 1);
                sum += epsilon;
            }
    return sum;
}

SolidGeometry sphere(const Vec3& centre, double radius)
{
    SolidGeometry g;
    g.centre = centre;
    g.radius = radius;
    return g;
}

SolidGeometry box(const Vec3& centre, const Vec3& half_extents)
{
    SolidGeometry g;
    g.shape = Shape::box;
    g.centre = centre;
    g.half_extents = half_extents;
    return g;
}

/// Common volume of two spheres of equal radius.
double lens(double R, double distance)
{
    return kPi / 12 * (4 * R + distance) * (2 * R - distance) * (2 * R - distance);
}

class SolidShapes : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(SolidShapes);
    CPPUNIT_TEST(box_along_the_axes_has_its_volume);
    CPPUNIT_TEST(turned_boxes_have_their_volume);
    CPPUNIT_TEST(cells_of_a_turned_box_are_the_sums_of_their_parts);
    CPPUNIT_TEST(box_larger_than_a_periodic_axis_fills_it_once);
    CPPUNIT_TEST(box_may_be_longer_than_integers_reach);
    CPPUNIT_TEST(pipe_leaves_its_bore_open);
    CPPUNIT_TEST(overlapping_spheres_of_a_body_have_the_volume_of_their_union);
    CPPUNIT_TEST(sphere_within_another_of_its_body_is_not_there);
    CPPUNIT_TEST(coincident_spheres_of_a_body_behave_as_one);
    CPPUNIT_TEST(buoyancy_of_a_body_counts_the_union);
    CPPUNIT_TEST(bodies_that_come_apart_count_all_their_volume_again);
    CPPUNIT_TEST(a_part_that_leaves_its_body_takes_its_volume_along);
    CPPUNIT_TEST(a_sphere_beyond_a_wall_beside_its_images_has_no_load);
    CPPUNIT_TEST(walls_of_a_box_follow_what_its_body_covers);
    CPPUNIT_TEST(channel_between_boxes_on_the_lattice_is_exact);
    CPPUNIT_TEST(moving_box_drags_a_couette_flow);
    CPPUNIT_TEST(flow_through_a_pipe_does_not_depend_on_tau);
    CPPUNIT_TEST(shapes_that_cannot_be_are_refused);
    CPPUNIT_TEST_SUITE_END();

    void box_along_the_axes_has_its_volume()
    {
        SolidFraction fraction(kCells, kPeriodic);
        const Vec3 half{2.3, 3.1, 1.7};
        fraction.evaluate(box({5.2, 7.7, 9.1}, half));
        LBM_ASSERT_CLOSE(8 * half[0] * half[1] * half[2], volume(fraction), kRoundOff, 100.0);
        // Only the part inside a closed box is listed.
        SolidFraction closed(kCells, kClosed);
        closed.evaluate(box({1.2, 7.7, 9.1}, half));
        LBM_ASSERT_CLOSE((1.2 + 2.3) * 4 * half[1] * half[2], volume(closed), kRoundOff, 100.0);
    }

    void turned_boxes_have_their_volume()
    {
        for (const Vec3& half : {Vec3{2.19, 3.19, 4.19}, Vec3{1, 1, 1}, Vec3{4.2, 2.6, 3.3}})
            for (const Mat3& axes : turns()) {
                SolidGeometry g = box({10.3, 11.1, 9.6}, half);
                g.axes = axes;
                SolidFraction fraction(kCells, kPeriodic);
                fraction.evaluate(g);
                LBM_ASSERT_CLOSE(8 * half[0] * half[1] * half[2], volume(fraction), kRoundOff, 100.0);
            }
    }

    /// With corners, edges and faces in all kinds of places.
    void cells_of_a_turned_box_are_the_sums_of_their_parts()
    {
        for (const Mat3& axes : turns()) {
            SolidGeometry g = box({10.3, 11.1, 9.6}, {3.2, 1.9, 2.6});
            g.axes = axes;
            SolidGeometry finer = g;
            finer.centre = 2.0 * g.centre;
            finer.half_extents = 2.0 * g.half_extents;
            for (int z = 5; z < 15; ++z)
                for (int y = 5; y < 17; ++y)
                    for (int x = 5; x < 16; ++x) {
                        double sum = 0;
                        for (int part = 0; part < 8; ++part)
                            sum +=
                                box_fraction(finer, {2.0 * x + part % 2, 2.0 * y + part / 2 % 2, 2.0 * z + part / 4});
                        LBM_ASSERT_CLOSE(sum / 8, box_fraction(g, {double(x), double(y), double(z)}), kRoundOff, 1.0);
                    }
        }
    }

    /// Nearly along the lattice, along its diagonals, and at will.
    static std::vector<Mat3> turns()
    {
        std::vector<Mat3> all;
        for (const double angle : {1e-7, 1e-6, 1e-3, 0.02, kPi / 4, 0.9, kPi / 2 + 1e-4})
            for (const Vec3& about : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 1, 1}, Vec3{1, 2, 3}}) {
                const double s = std::sin(angle / 2) / norm(about);
                all.push_back(rotated_axes({std::cos(angle / 2), s * about[0], s * about[1], s * about[2]}));
            }
        return all;
    }

    void box_larger_than_a_periodic_axis_fills_it_once()
    {
        SolidFraction fraction(kCells, kPeriodic);
        fraction.evaluate(box({3, 4, 2.5}, {50, 11, 1.5}));
        LBM_ASSERT_CLOSE(24.0 * 22 * 3, volume(fraction), kRoundOff, 1000.0);
    }

    void box_may_be_longer_than_integers_reach()
    {
        SolidFraction fraction(kCells, kClosed);
        SolidGeometry g = box({3, 4, 9}, {1e10, 1e12, 3});
        fraction.evaluate(g);
        LBM_ASSERT_CLOSE(24.0 * 22 * 6, volume(fraction), kRoundOff, 1000.0);
        const double a = 0.4;
        g.axes = {{{std::cos(a), std::sin(a), 0}, {-std::sin(a), std::cos(a), 0}, {0, 0, 1}}};
        fraction.evaluate(g);
        LBM_ASSERT_CLOSE(24.0 * 22 * 6, volume(fraction), kRoundOff, 1000.0);
    }

    void pipe_leaves_its_bore_open()
    {
        for (int axis = 0; axis < 3; ++axis) {
            SolidGeometry g = sphere({9.7, 10.2, 10.4}, 7.3);
            g.shape = Shape::pipe;
            g.axis = axis;
            SolidFraction fraction(kCells, kPeriodic);
            fraction.evaluate(g);
            const double all = double(kCells[0]) * kCells[1] * kCells[2];
            LBM_ASSERT_CLOSE(all - kPi * 7.3 * 7.3 * kCells[axis], volume(fraction), kRoundOff, all);
        }
    }

    void overlapping_spheres_of_a_body_have_the_volume_of_their_union()
    {
        const double R = 4.3, V = 4 * kPi / 3 * R * R * R;
        SolidFraction fraction(kCells, kPeriodic);
        for (const double distance : {1.3, 4.4, 7.9, 9.0}) {
            const Vec3 centre{10.1, 9.6, 10.4};
            Vec3 other = centre;
            other[0] += 0.6 * distance;
            other[2] += 0.8 * distance - kCells[2];  // seen through a periodic face
            fraction.evaluate(sphere(centre, R), {sphere(other, R)});
            const double common = distance < 2 * R ? lens(R, distance) : 0;
            LBM_ASSERT_CLOSE(V - common, volume(fraction), kLinesPerCell, V);
        }
    }

    void sphere_within_another_of_its_body_is_not_there()
    {
        SolidFraction fraction(kCells, kPeriodic);
        for (const Vec3& centre : {Vec3{10, 10, 10}, Vec3{11.2, 10.3, 9.4}}) {
            fraction.evaluate(sphere(centre, 3.1), {sphere({10, 10, 10}, 4.9)});
            CPPUNIT_ASSERT_EQUAL(0.0, volume(fraction));
        }
        fraction.evaluate(sphere({10, 10, 10}, 3.1), {sphere({10, 10, 10}, 3.1)});
        CPPUNIT_ASSERT_EQUAL(0.0, volume(fraction));
    }

    void coincident_spheres_of_a_body_behave_as_one()
    {
        FluidConfig c = test::lattice_config({14, 14, 14}, 0.8);
        c.acceleration = {1e-5, 2e-5, 0};
        Fluid one(c), two(c);
        one.place_solids({test::sphere(0, {7.2, 6.9, 7.1}, 4)});
        two.place_solids({test::sphere(0, {7.2, 6.9, 7.1}, 4, 5), test::sphere(1, {7.2, 6.9, 7.1}, 4, 5)});
        for (int t = 0; t < 20; ++t) {
            one.step();
            two.step();
        }
        for (int d = 0; d < 3; ++d) {
            CPPUNIT_ASSERT_EQUAL(one.loads()[0].force[d], two.loads()[0].force[d]);
            CPPUNIT_ASSERT_EQUAL(0.0, two.loads()[1].force[d]);
        }
        CPPUNIT_ASSERT(one.velocity_field() == two.velocity_field());
    }

    void buoyancy_of_a_body_counts_the_union()
    {
        FluidConfig c = test::lattice_config({22, 14, 14}, 0.8);
        c.gravity = {0, 0, -1e-4};
        const double R = 4, distance = 5, V = 4 * kPi / 3 * R * R * R;
        Fluid fluid(c);
        fluid.place_solids({test::sphere(0, {8, 7, 7}, R, 3), test::sphere(1, {8 + distance, 7, 7}, R, 3)});
        fluid.step();
        const double buoyancy = fluid.loads()[0].force[2] + fluid.loads()[1].force[2];
        LBM_ASSERT_CLOSE(1e-4 * (2 * V - lens(R, distance)), buoyancy, kLinesPerCell, buoyancy);
    }

    void bodies_that_come_apart_count_all_their_volume_again()
    {
        FluidConfig c = test::lattice_config({22, 14, 14}, 0.8);
        c.gravity = {0, 0, -1e-4};
        const double V = 4 * kPi / 3 * 64;
        Fluid fluid(c);
        fluid.place_solids({test::sphere(0, {8, 7, 7}, 4, 3), test::sphere(1, {13, 7, 7}, 4, 3)});
        fluid.step();
        fluid.place_solids({test::sphere(1, {13, 7, 7}, 4, 3)});
        fluid.step();
        LBM_ASSERT_CLOSE(1e-4 * V, fluid.loads()[0].force[2], kRoundOff, 1.0);
        fluid.place_solids({test::sphere(0, {8, 7, 7}, 4), test::sphere(1, {13, 7, 7}, 4)});
        fluid.step();
        LBM_ASSERT_CLOSE(2e-4 * V, fluid.loads()[0].force[2] + fluid.loads()[1].force[2], kRoundOff, 1.0);
    }

    /// Its images behind the periodic faces are near enough for narrow pores, but none of its cells is there.
    void a_sphere_beyond_a_wall_beside_its_images_has_no_load()
    {
        FluidConfig c = test::lattice_config({6, 6, 12}, 0.8);
        c.faces[kZMin].type = c.faces[kZMax].type = FaceType::no_slip;
        c.acceleration = {1e-4, 0, 0};
        Fluid fluid(c);
        for (const double z : {-4.0, 18.0, 13.5, 12.5}) {
            fluid.place_solids({test::sphere(0, {3, 3, z}, 2.5)});
            fluid.step();
            if (z < 0 || z - 2.5 > 12) LBM_ASSERT_CLOSE(0.0, norm(fluid.loads()[0].force), kRoundOff, 1e-4);
            else CPPUNIT_ASSERT(norm(fluid.loads()[0].force) > 0);
        }
    }

    void a_part_that_leaves_its_body_takes_its_volume_along()
    {
        FluidConfig c = test::lattice_config({22, 14, 14}, 0.8);
        c.gravity = {0, 0, -1e-4};
        const double V = 4 * kPi / 3 * 64;
        Fluid fluid(c);
        std::vector<Solid> parts{test::sphere(0, {8, 7, 7}, 4, 3), test::sphere(1, {11, 7, 7}, 4, 3),
                                 test::sphere(2, {17, 7, 7}, 4, 3)};
        fluid.place_solids(parts);
        parts[0].body = -1;  // nobody moves
        fluid.place_solids(parts);
        fluid.step();
        LBM_ASSERT_CLOSE(1e-4 * V, fluid.loads()[0].force[2], kRoundOff, 1.0);
        LBM_ASSERT_CLOSE(1e-4 * V, fluid.loads()[1].force[2], kRoundOff, 1.0);
    }

    void walls_of_a_box_follow_what_its_body_covers()
    {
        // A ball before the box in its body, moved into it or out of it, leaves the same as one that was always there.
        FluidConfig c = test::lattice_config({22, 16, 16}, 0.8);
        c.acceleration = {1e-5, 2e-5, 0};
        const auto parts = [](double x) {
            Solid cube;
            cube.id = 1;
            cube.body = 3;
            cube.shape = Shape::box;
            cube.half_extents = {3, 3, 3};
            cube.position = {8, 8, 8};
            return std::vector<Solid>{test::sphere(0, {x, 8, 8}, 4, 3), cube};
        };
        const double beside = 15.5, inside = 12.5;
        for (const bool enters : {true, false}) {
            Fluid moved(c), always(c);
            moved.place_solids(parts(enters ? beside : inside));
            moved.place_solids(parts(enters ? inside : beside));
            always.place_solids(parts(enters ? inside : beside));
            for (int t = 0; t < 5; ++t) {
                moved.step();
                always.step();
            }
            CPPUNIT_ASSERT(moved.velocity_field() == always.velocity_field());
        }
    }

    static Solid slab(std::int64_t id, double z, double thickness)
    {
        Solid s;
        s.id = id;
        s.shape = Shape::box;
        s.half_extents = {10, 10, thickness / 2};
        s.position = {1.5, 1, z + thickness / 2};
        return s;
    }

    void channel_between_boxes_on_the_lattice_is_exact()
    {
        // Lambda = 3/16 puts a bounce-back wall exactly half-way for a parabola.
        for (const Lattice lattice : {Lattice::d3q19, Lattice::d3q27}) {
            const int n = 9, thick = 3;
            FluidConfig c = test::lattice_config({3, 2, n + thick}, 1.3);
            c.lattice = lattice;
            c.magic_parameter = 0.1875;
            c.acceleration = {1e-5, 0, 0};
            Fluid fluid(c);
            fluid.place_solids({slab(0, 0, thick)});
            for (int t = 0; t < 6000; ++t) fluid.step();
            const double u_max = 1e-5 * n * n / (8 * c.viscosity);
            for (int z = 0; z < n; ++z) {
                const double s = (z + 0.5) / n;
                LBM_ASSERT_CLOSE(4 * u_max * s * (1 - s), fluid.velocity_at({1.5, 1.5, thick + z + 0.5})[0], kExact,
                                 u_max);
            }
            // The wall bears the whole drive: that of the fluid, and of its own place.
            LBM_ASSERT_CLOSE(1e-5 * 3 * 2 * (n + thick), fluid.loads()[0].force[0], kExact, 1e-3);
        }
    }

    void moving_box_drags_a_couette_flow()
    {
        const int n = 10;
        const double U = 0.03;
        FluidConfig c = test::lattice_config({3, 2, 2 * n + 4}, 0.9);
        test::walls(c, 2);
        Fluid fluid(c);
        for (int t = 0; t < 6000; ++t) {
            Solid s = slab(7, n, 4);
            s.velocity = {U, 0, 0};
            s.position[0] += U * t;
            fluid.place_solids({s});
            fluid.step();
        }
        for (int z = 0; z < n; ++z)
            LBM_ASSERT_CLOSE(U * (z + 0.5) / n, fluid.velocity_at({1, 1, z + 0.5})[0], kExact, U);
        LBM_ASSERT_CLOSE(-2 * c.viscosity * U / n * 6, fluid.loads()[0].force[0], kExact, 1e-3);
    }

    void flow_through_a_pipe_does_not_depend_on_tau()
    {
        const double R = 6.4;
        double first = 0;
        for (const double tau : {0.8, 3.0}) {
            FluidConfig c = test::lattice_config({2, 16, 16}, tau);
            c.inertia = false;
            c.acceleration = {1e-6, 0, 0};
            Solid pipe = test::sphere(0, {1, 8.2, 7.9}, R);
            pipe.shape = Shape::pipe;
            Fluid fluid(c);
            fluid.place_solids({pipe});
            for (int t = 0; t < (tau > 1 ? 2500 : 6000); ++t) fluid.step();
            const double flow = fluid.average_velocity()[0] * 16 * 16 * c.viscosity / 1e-6;
            LBM_ASSERT_CLOSE(kPi * std::pow(R, 4) / 8, flow, 0.02, flow);
            if (first == 0) first = flow;
            LBM_ASSERT_CLOSE(first, flow, kExact, flow);
        }
    }

    static void refused(const Solid& s, int walls_along = -1)
    {
        FluidConfig c = test::lattice_config({14, 14, 14}, 0.8);
        if (walls_along >= 0) test::walls(c, walls_along);
        Fluid fluid(c);
        CPPUNIT_ASSERT_THROW(fluid.place_solids({s}), ConfigError);
    }

    void shapes_that_cannot_be_are_refused()
    {
        Solid thin = slab(0, 3, 1.5);
        refused(thin);
        Solid skew = slab(0, 3, 4);
        skew.orientation = {1, 1, 0, 0};
        refused(skew);
        skew.position = {7, 7, 1e3};
        refused(skew, 2);  // wherever it stands
        Solid inside_out = slab(0, 3, 4);
        inside_out.half_extents = {-20, -20, -20};
        refused(inside_out, 2);
        inside_out.half_extents = {1e200, 1e200, 1e200};
        refused(inside_out);
        Solid rod = slab(0, 3, 4);  // would meet itself across the periodic faces, at another angle
        rod.half_extents = {10, 2, 2};
        rod.orientation = {std::cos(0.2), 0, 0, std::sin(0.2)};
        refused(rod);
        Solid pipe = test::sphere(0, {7, 7, 7}, 7.5);
        pipe.shape = Shape::pipe;
        refused(pipe);
        pipe.radius = 5;
        pipe.axis = 3;
        refused(pipe);
        pipe.axis = 1;
        pipe.body = 2;
        refused(pipe);
        pipe.body = -1;
        pipe.angular_velocity = {0, 1e-3, 0};
        refused(pipe);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(SolidShapes);

}  // namespace
