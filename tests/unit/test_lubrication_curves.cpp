#include "close.hpp"
#include "lattice/vec3.hpp"
#include "lattice_units.hpp"
#include "reference_table.hpp"

#include "lbm/fluid.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <algorithm>
#include <functional>
#include <numbers>

namespace {

using namespace lbm;

constexpr double kRadius = 4, kSpeed = 1e-5;

/// What was measured, with margin 1.3 to 1.5: approach 1.6 % (wall) and 2.5 % (oblique pair), along a wall 1.4 %, turning 1.2 %.
constexpr double kApproachOfWall = 0.02, kApproachOfSphere = 0.03, kAlongWall = 0.021, kTurningAtWall = 0.018;

struct Point {
    double gap, computed, exact;
};

/// Loads against the exact ones from a gap of one radius down to 0.01, in Stokes flow.
class LubricationCurves : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(LubricationCurves);
    CPPUNIT_TEST(approach_of_a_wall);
    CPPUNIT_TEST(approach_of_two_spheres);
    CPPUNIT_TEST(motion_along_a_wall);
    CPPUNIT_TEST(rotation_at_a_wall);
    CPPUNIT_TEST_SUITE_END();

    static std::vector<Point> curve(const char* table, const char* column, FluidConfig c,
                                    const std::function<std::vector<Solid>(double)>& at_gap,
                                    const std::function<double(const SolidLoad&)>& value)
    {
        c.inertia = false;
        Fluid fluid(c);
        std::vector<Point> points;
        auto rows = test::reference_table(table);
        std::reverse(rows.begin(), rows.end());  // from wide to narrow, each from the flow of the one before
        for (const auto& row : rows) {
            const double gap = std::stod(row.at("h_over_a"));
            if (gap < 0.0099 || gap > 1.01) continue;
            fluid.place_solids(at_gap(gap * kRadius));
            for (int t = 0; t < (points.empty() ? 2500 : 600); ++t) fluid.step();
            const double load = value(fluid.loads()[0]) + value(fluid.film_loads(at_gap(gap * kRadius), 1)[0]);
            points.push_back({gap * kRadius, load, std::stod(row.at(column))});
        }
        return points;
    }

    /// The box adds nearly the same at all gaps: a constant, taken from the widest ones.
    static void agrees(const std::vector<Point>& points, double tolerance)
    {
        double box = 0;
        int wide = 0;
        for (const Point& p : points) {
            if (p.gap < 2.3) continue;
            box += p.exact - p.computed;
            ++wide;
        }
        CPPUNIT_ASSERT(wide > 0);
        box /= wide;
        for (const Point& p : points) LBM_ASSERT_CLOSE(p.exact, p.computed + box, tolerance, p.exact);
        CPPUNIT_ASSERT(points.size() > 10 && points.back().gap < 0.0101 * kRadius);
        LBM_ASSERT_CLOSE(0, box, 0.15,
                         1.0);  // measured 0.1 along a wall, where the periodic images move with the sphere
    }

    static FluidConfig between_walls()
    {
        FluidConfig c = test::lattice_config({40, 40, 40}, 1.5);
        test::walls(c, 2);
        return c;
    }
    static std::vector<Solid> at_wall(double gap, const Vec3& velocity, const Vec3& angular_velocity)
    {
        Solid s;
        s.radius = kRadius;
        s.position = {20.2, 20.14, kRadius + gap};
        s.velocity = velocity;
        s.angular_velocity = angular_velocity;
        return {s};
    }
    static double stokes() { return 6 * std::numbers::pi / 3 * kRadius * kSpeed; }

    void approach_of_a_wall()
    {
        const auto down = [](double gap) { return at_wall(gap, {0, 0, -kSpeed}, {}); };
        const auto force = [](const SolidLoad& load) { return load.force[2] / stokes(); };
        agrees(curve("06_lubrication_normal.csv", "wall_normal", between_walls(), down, force), kApproachOfWall);
    }

    void approach_of_two_spheres()
    {
        const Vec3 n{0.8, 0.36, 0.48};  // oblique
        const auto together = [&](double gap) {
            std::vector<Solid> pair(2);
            for (int i = 0; i < 2; ++i) {
                const double sign = i == 0 ? -1 : 1;
                pair[i].id = i;
                pair[i].radius = kRadius;
                pair[i].position = Vec3{22.2, 22.14, 22.06} + (sign * (kRadius + gap / 2)) * n;
                pair[i].velocity = (-sign * kSpeed) * n;
            }
            return pair;
        };
        const auto force = [&](const SolidLoad& load) { return -dot(load.force, n) / stokes(); };
        agrees(curve("06_lubrication_normal.csv", "two_spheres_approach", test::lattice_config({44, 44, 44}, 1.5),
                     together, force),
               kApproachOfSphere);
    }

    void motion_along_a_wall()
    {
        const auto along = [](double gap) { return at_wall(gap, {kSpeed, 0, 0}, {}); };
        const auto force = [](const SolidLoad& load) { return -load.force[0] / stokes(); };
        agrees(curve("06_lubrication_tangential.csv", "Ft", between_walls(), along, force), kAlongWall);
    }

    void rotation_at_a_wall()
    {
        const auto turning = [](double gap) { return at_wall(gap, {}, {0, kSpeed / kRadius, 0}); };
        const auto torque = [](const SolidLoad& load) { return -load.torque[1] * 6 / (8 * kRadius) / stokes(); };
        agrees(curve("06_lubrication_tangential.csv", "Tr", between_walls(), turning, torque), kTurningAtWall);
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(LubricationCurves);

}  // namespace
