#include "fields/wall_cells.hpp"

#include <cppunit/extensions/HelperMacros.h>

namespace {

using namespace lbm;

constexpr std::array<int, 3> kCells{20, 18, 16};
constexpr std::array<bool, 3> kPeriodic{true, true, true}, kClosed{false, false, false};

LatticeSolid box(const Vec3& centre, const Vec3& half_extents, const Vec3& velocity = {})
{
    LatticeSolid solid;
    solid.geometry.shape = Shape::box;
    solid.geometry.centre = centre;
    solid.geometry.half_extents = half_extents;
    solid.velocity = velocity;
    return solid;
}

/// How many of a box's cells are walls, of a box from cell `first` on.
int count(const WallCells& walls, const LatticeSolid& solid, const std::array<int, 3>& first,
          const std::array<int, 3>& n)
{
    int sum = 0;
    for (int z = 0; z < n[2]; ++z)
        for (int y = 0; y < n[1]; ++y)
            for (int x = 0; x < n[0]; ++x) sum += walls.contain(solid, {first[0] + x, first[1] + y, first[2] + z});
    return sum;
}

class WallCellsOfBoxes : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(WallCellsOfBoxes);
    CPPUNIT_TEST(the_outermost_layer_of_a_box_and_no_other_cell);
    CPPUNIT_TEST(a_box_that_fills_an_axis_has_no_surface_along_it);
    CPPUNIT_TEST(a_box_across_a_periodic_face_is_one_box);
    CPPUNIT_TEST(none_beside_a_face_of_the_lattice);
    CPPUNIT_TEST(none_beside_a_box_that_moves_otherwise);
    CPPUNIT_TEST_SUITE_END();

    void the_outermost_layer_of_a_box_and_no_other_cell()
    {
        const LatticeSolid b = box({8, 8, 8}, {3, 3, 2});
        const WallCells walls(kCells, kClosed, {&b});
        CPPUNIT_ASSERT_EQUAL(6 * 6 * 4 - 4 * 4 * 2, count(walls, b, {5, 5, 6}, {6, 6, 4}));
        for (const std::array<int, 3>& corner : {std::array{5, 5, 6}, std::array{10, 10, 9}})
            CPPUNIT_ASSERT(walls.contain(b, corner));
        CPPUNIT_ASSERT(!walls.contain(b, {8, 8, 8}));
    }

    void a_box_that_fills_an_axis_has_no_surface_along_it()
    {
        const LatticeSolid plate = box({3, 4, 8}, {50, 9, 2});
        const WallCells walls(kCells, kPeriodic, {&plate});
        CPPUNIT_ASSERT_EQUAL(2 * 20 * 18, count(walls, plate, {0, 0, 6}, {20, 18, 4}));
    }

    void a_box_across_a_periodic_face_is_one_box()
    {
        const LatticeSolid b = box({0, 8, 15}, {3, 3, 3});
        const WallCells walls(kCells, kPeriodic, {&b});
        CPPUNIT_ASSERT_EQUAL(6 * 6 * 6 - 4 * 4 * 4, count(walls, b, {-3, 5, 12}, {6, 6, 6}));
        CPPUNIT_ASSERT_EQUAL(6 * 6 * 6 - 4 * 4 * 4, count(walls, b, {17, 5, -4}, {6, 6, 6}));
    }

    void none_beside_a_face_of_the_lattice()
    {
        const LatticeSolid floor = box({10, 9, 0}, {50, 50, 3});
        const WallCells walls(kCells, kClosed, {&floor});
        // Of the layer under its upper surface, what lies not at the sides of the lattice.
        CPPUNIT_ASSERT_EQUAL(18 * 16, count(walls, floor, {0, 0, 0}, {20, 18, 3}));
        CPPUNIT_ASSERT(walls.contain(floor, {10, 9, 2}) && !walls.contain(floor, {0, 9, 2}));
    }

    void none_beside_a_box_that_moves_otherwise()
    {
        const LatticeSolid still = box({8, 8, 6}, {3, 3, 2});
        const auto walls_of_still = [&](const Vec3& velocity, double gap) {
            const LatticeSolid other = box({8, 8, 8 + gap + 2}, {3, 3, 2}, velocity);
            const WallCells walls(kCells, kClosed, {&still, &other});
            return count(walls, still, {5, 5, 4}, {6, 6, 4});
        };
        const int all = 6 * 6 * 4 - 4 * 4 * 2;
        CPPUNIT_ASSERT_EQUAL(all, walls_of_still({0.01, 0, 0}, 2));
        CPPUNIT_ASSERT_EQUAL(all - 6 * 6, walls_of_still({0.01, 0, 0}, 0));
        CPPUNIT_ASSERT_EQUAL(all, walls_of_still({}, 0));
        LatticeSolid turning = box({8, 8, 10}, {3, 3, 2});
        turning.angular_velocity = {0, 0, 0.01};
        const WallCells walls(kCells, kClosed, {&still, &turning});
        CPPUNIT_ASSERT_EQUAL(all - 6 * 6, count(walls, still, {5, 5, 4}, {6, 6, 4}));
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(WallCellsOfBoxes);

}  // namespace
