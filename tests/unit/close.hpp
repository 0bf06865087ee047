#pragma once

#include <cppunit/Asserter.h>
#include <cppunit/SourceLine.h>

#include <cmath>
#include <limits>
#include <sstream>

/**
 * Fails unless |actual - expected| <= tolerance |scale|, and always when NaN is involved or the right-hand side is not finite.
 *
 * @param tolerance  relative to `scale`: a named constant with a reason
 * @param scale      size of the quantities that make up the value, in its unit; not 0 unless equality is meant
 */
#define LBM_ASSERT_CLOSE(expected, actual, tolerance, scale)                                                           \
    lbm::test::assert_close(expected, actual, tolerance, scale, #actual, CPPUNIT_SOURCELINE())

namespace lbm::test {

inline void assert_close(double expected, double actual, double tolerance, double scale, const char* expression,
                         const CppUnit::SourceLine& line)
{
    const double error = std::abs(actual - expected);
    const double allowed = tolerance * std::abs(scale);
    if (error <= allowed && std::isfinite(allowed)) return;

    std::ostringstream message;
    message.precision(std::numeric_limits<double>::max_digits10);
    message << expression << " = " << actual << ", expected " << expected << ": ";
    message.precision(3);
    message << "off by " << error / std::abs(scale) << " of the scale " << scale << ", tolerance " << tolerance;
    CppUnit::Asserter::fail(message.str(), line);
}

}  // namespace lbm::test
