#include "close.hpp"
#include "lattice_units.hpp"

#include "lbm/overlap.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <numbers>

namespace {

using namespace lbm;

constexpr double kRoundOff = 1e-14;

/// Spheres that share more than a contact does are found, with the volume that counts twice.
class SpheresThatOverlap : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(SpheresThatOverlap);
    CPPUNIT_TEST(shared_volume_is_that_of_the_lens);
    CPPUNIT_TEST(the_worst_of_all_pairs_is_named);
    CPPUNIT_TEST(contacts_and_bodies_are_no_overlap);
    CPPUNIT_TEST(periodic_faces_are_looked_through_and_walls_are_not);
    CPPUNIT_TEST(the_volume_of_a_union_counts_what_is_shared_once);
    CPPUNIT_TEST_SUITE_END();

    const FluidConfig box_ = test::lattice_config({30, 20, 20}, 1);

    void shared_volume_is_that_of_the_lens()
    {
        const Solid one = test::sphere(7, {10, 10, 10}, 4);
        // Equal spheres a radius apart share 5/16; one that is half as large and stands on the surface of the other shares 13/32.
        LBM_ASSERT_CLOSE(5.0 / 16, overlaps(box_, {one, test::sphere(3, {10, 14, 10}, 4)}).shared, kRoundOff, 1.0);
        LBM_ASSERT_CLOSE(13.0 / 32, overlaps(box_, {one, test::sphere(3, {10, 10, 14}, 2)}).shared, kRoundOff, 1.0);
        LBM_ASSERT_CLOSE(1.0, overlaps(box_, {one, test::sphere(3, {11, 10, 10}, 2)}).shared, kRoundOff, 1.0);
        LBM_ASSERT_CLOSE(1.0, overlaps(box_, {one, test::sphere(3, {10, 10, 10}, 4)}).shared, kRoundOff, 1.0);
    }

    void the_worst_of_all_pairs_is_named()
    {
        const Overlaps found = overlaps(box_, {test::sphere(4, {5, 10, 10}, 3), test::sphere(8, {9, 10, 10}, 3),
                                               test::sphere(2, {12, 10, 10}, 3), test::sphere(5, {22, 10, 10}, 3)});
        CPPUNIT_ASSERT_EQUAL(2, found.pairs);
        CPPUNIT_ASSERT_EQUAL(std::int64_t{8}, found.one);
        CPPUNIT_ASSERT_EQUAL(std::int64_t{2}, found.other);
    }

    void contacts_and_bodies_are_no_overlap()
    {
        CPPUNIT_ASSERT_EQUAL(0, overlaps(box_, {}).pairs);
        CPPUNIT_ASSERT_EQUAL(
            0, overlaps(box_, {test::sphere(0, {10, 10, 10}, 4), test::sphere(1, {17.5, 10, 10}, 4)}).pairs);
        CPPUNIT_ASSERT_EQUAL(
            0, overlaps(box_, {test::sphere(0, {10, 10, 10}, 4, 1), test::sphere(1, {12, 10, 10}, 4, 1)}).pairs);
        CPPUNIT_ASSERT_EQUAL(
            1, overlaps(box_, {test::sphere(0, {10, 10, 10}, 4, 1), test::sphere(1, {12, 10, 10}, 4, 2)}).pairs);
    }

    void periodic_faces_are_looked_through_and_walls_are_not()
    {
        const std::vector<Solid> at_both_ends{test::sphere(0, {1, 10, 10}, 4), test::sphere(1, {27, 10, 10}, 4)};
        CPPUNIT_ASSERT_EQUAL(1, overlaps(box_, at_both_ends).pairs);
        FluidConfig closed = box_;
        test::walls(closed, 0);
        CPPUNIT_ASSERT_EQUAL(0, overlaps(closed, at_both_ends).pairs);
        CPPUNIT_ASSERT_EQUAL(
            0, overlaps(closed, {test::sphere(0, {-9, 10, 10}, 4), test::sphere(1, {-8, 10, 10}, 4)}).pairs);
    }

    void the_volume_of_a_union_counts_what_is_shared_once()
    {
        constexpr double kLines = 1e-3;
        const double ball = 4 * std::numbers::pi / 3;
        const Solid one = test::sphere(0, {2, 3, 4}, 1);
        LBM_ASSERT_CLOSE(0.0, union_volume({}), kLines, 1.0);
        LBM_ASSERT_CLOSE(ball, union_volume({one}), kLines, ball);
        LBM_ASSERT_CLOSE(ball, union_volume({one, test::sphere(1, {2.1, 3.2, 4.3}, 0.5)}), kLines, ball);
        LBM_ASSERT_CLOSE(2 * ball, union_volume({one, test::sphere(1, {3.4, 4.4, 5.4}, 1)}), kLines, 2 * ball);
        // Equal spheres a radius apart share 5/16 of one, in whatever direction.
        for (const Vec3& other : {Vec3{3, 3, 4}, Vec3{2, 3, 5}, Vec3{2.36, 3.48, 4.8}})
            LBM_ASSERT_CLOSE(27.0 / 16 * ball, union_volume({one, test::sphere(1, other, 1)}), kLines, ball);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(SpheresThatOverlap);

}  // namespace
