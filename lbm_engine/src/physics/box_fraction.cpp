#include "physics/box_fraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lbm {
namespace {

constexpr int kFaces = 12;          // of a cell cut by the six planes of a box, at most
constexpr double kNothing = 1e-14;  // lengths and volumes of a cell that are round-off

struct Polygon {
    std::array<Vec3, 2 * kFaces> corners;
    int n = 0;
    void add(const Vec3& corner) { corners[n++] = corner; }
};

/// Turns the points of a convex polygon, as they were found, into the order of its corners.
void sort_around(Polygon& polygon, const Vec3& normal)
{
    Vec3 middle{};
    for (int i = 0; i < polygon.n; ++i) middle += (1.0 / polygon.n) * polygon.corners[i];
    const Vec3 u = polygon.corners[0] - middle, v = cross(normal, u);
    const auto angle = [&](const Vec3& p) { return std::atan2(dot(p - middle, v), dot(p - middle, u)); };
    std::sort(polygon.corners.begin(), polygon.corners.begin() + polygon.n,
              [&](const Vec3& a, const Vec3& b) { return angle(a) < angle(b); });
}

/// What planes have left of a cell: a convex body, by its faces.
class CutCube {
public:
    explicit CutCube(const Vec3& lowest)
    {
        for (int d = 0; d < 3; ++d)
            for (int side = 0; side < 2; ++side) {
                Vec3 corner = lowest;
                corner[d] += side;
                const int p = (d + 1) % 3, q = (d + 2) % 3;
                Polygon& face = faces_[count_++];
                face.add(corner);
                corner[p] += 1;
                face.add(corner);
                corner[q] += 1;
                face.add(corner);
                corner[p] -= 1;
                face.add(corner);
            }
    }

    /// Takes off what lies beyond the plane normal.x = offset.
    void cut(const Vec3& normal, double offset)
    {
        Polygon section;
        bool is_face = false;  // the section, already
        const int before = std::exchange(count_, 0);
        for (int f = 0; f < before; ++f) {
            const Polygon face = faces_[f];
            Polygon left;
            bool on_plane = true;
            for (int i = 0; i < face.n; ++i) {
                const Vec3 &a = face.corners[i], &b = face.corners[(i + 1) % face.n];
                const double beyond_a = dot(normal, a) - offset, beyond_b = dot(normal, b) - offset;
                on_plane = on_plane && std::abs(beyond_a) < kNothing;
                if (beyond_a <= 0) left.add(a);
                if ((beyond_a < 0) == (beyond_b < 0) || beyond_a == 0 || beyond_b == 0) continue;
                const Vec3 between = a + (beyond_a / (beyond_a - beyond_b)) * (b - a);
                left.add(between);
                section.add(between);
            }
            is_face = is_face || (on_plane && left.n == face.n);
            if (left.n > 2) faces_[count_++] = left;
        }
        for (int f = 0; f < count_; ++f)  // corners that the plane goes through
            for (int i = 0; i < faces_[f].n && section.n < 2 * kFaces; ++i)
                if (dot(normal, faces_[f].corners[i]) == offset) section.add(faces_[f].corners[i]);
        if (is_face || section.n < 3) return;
        sort_around(section, normal);
        faces_[count_++] = section;
    }

    double volume() const
    {
        if (count_ < 4) return 0;
        Vec3 inside{};
        int corners = 0;
        for (int f = 0; f < count_; ++f)
            for (int i = 0; i < faces_[f].n; ++i, ++corners) inside += faces_[f].corners[i];
        inside = (1.0 / corners) * inside;
        double six_volumes = 0;
        for (int f = 0; f < count_; ++f) {
            const Polygon& face = faces_[f];
            const Vec3 a = face.corners[0] - inside;
            for (int i = 1; i + 1 < face.n; ++i)
                six_volumes += std::abs(dot(a, cross(face.corners[i] - inside, face.corners[i + 1] - inside)));
        }
        return six_volumes / 6;
    }

private:
    std::array<Polygon, kFaces> faces_;
    int count_ = 0;
};

}  // namespace

double box_fraction(const SolidGeometry& box, const Vec3& cell)
{
    const Vec3 from_centre = cell + Vec3{0.5, 0.5, 0.5} - box.centre;
    bool is_cut = false;
    for (int a = 0; a < 3; ++a) {
        const Vec3& e = box.axes[a];
        const double reach = 0.5 * (std::abs(e[0]) + std::abs(e[1]) + std::abs(e[2]));
        const double at = std::abs(dot(e, from_centre)), h = box.half_extents[a];
        if (at - reach >= h) return 0;
        is_cut = is_cut || at + reach > h;
    }
    if (!is_cut) return 1;
    CutCube left(from_centre - Vec3{0.5, 0.5, 0.5});
    for (int a = 0; a < 3; ++a) {
        const Vec3& e = box.axes[a];
        const double reach = 0.5 * (std::abs(e[0]) + std::abs(e[1]) + std::abs(e[2]));
        const double at = dot(e, from_centre), h = box.half_extents[a];
        if (at + reach > h) left.cut(e, h);
        if (at - reach < -h) left.cut(-1.0 * e, h);
    }
    const double volume = left.volume();
    return volume < kNothing ? 0 : volume > 1 - kNothing ? 1 : volume;
}

}  // namespace lbm
