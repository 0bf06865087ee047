#include "close.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <limits>
#include <string>

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Close : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Close);
    CPPUNIT_TEST(accepts_what_is_within_the_tolerance_of_the_scale);
    CPPUNIT_TEST(rejects_what_is_beyond);
    CPPUNIT_TEST(rejects_what_is_not_finite);
    CPPUNIT_TEST(message_shows_all_numbers);
    CPPUNIT_TEST_SUITE_END();

    void accepts_what_is_within_the_tolerance_of_the_scale()
    {
        LBM_ASSERT_CLOSE(1.0, 1.0, 0.0, 1.0);
        LBM_ASSERT_CLOSE(0.0, 0.5, 0.125, 4.0);
        LBM_ASSERT_CLOSE(0.0, -0.5, 0.125, -4.0);
    }

    void rejects_what_is_beyond()
    {
        CPPUNIT_ASSERT_ASSERTION_FAIL(LBM_ASSERT_CLOSE(0.0, 0.5001, 0.125, 4.0));
        CPPUNIT_ASSERT_ASSERTION_FAIL(LBM_ASSERT_CLOSE(1.0, 1.1, 0.1, 0.0));
    }

    void rejects_what_is_not_finite()
    {
        CPPUNIT_ASSERT_ASSERTION_FAIL(LBM_ASSERT_CLOSE(kNaN, 1.0, 1.0, 1.0));
        CPPUNIT_ASSERT_ASSERTION_FAIL(LBM_ASSERT_CLOSE(1.0, kNaN, 1.0, 1.0));
        CPPUNIT_ASSERT_ASSERTION_FAIL(LBM_ASSERT_CLOSE(1.0, 1.0, kNaN, 1.0));
        CPPUNIT_ASSERT_ASSERTION_FAIL(LBM_ASSERT_CLOSE(1.0, 1.0, 1.0, kNaN));
        CPPUNIT_ASSERT_ASSERTION_FAIL(LBM_ASSERT_CLOSE(1.0, 2.0, 1.0, kInfinity));
        CPPUNIT_ASSERT_ASSERTION_FAIL(LBM_ASSERT_CLOSE(kInfinity, kInfinity, 1.0, 1.0));
    }

    void message_shows_all_numbers()
    {
        try {
            const double drag = 1.5;
            LBM_ASSERT_CLOSE(1.0, drag, 0.01, 2.0);
        } catch (const CppUnit::Exception& failure) {
            const std::string wanted = "drag = 1.5, expected 1: off by 0.25 of the scale 2, tolerance 0.01";
            CPPUNIT_ASSERT(failure.message().details().find(wanted) != std::string::npos);
            return;
        }
        CPPUNIT_FAIL("accepted 1.5 for 1");
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Close);

}  // namespace
