#include "rigid_body.hpp"

#include "lbm/errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace lbm {
namespace {

using Quaternion = std::array<double, 4>;  // (w, x, y, z)

Vec3 plus(const Vec3& a, const Vec3& b, double factor = 1)
{
    return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Quaternion product(const Quaternion& a, const Quaternion& b)
{
    const Vec3 u{a[1], a[2], a[3]}, v{b[1], b[2], b[3]};
    const Vec3 w = plus(plus(cross(u, v), v, a[0]), u, b[0]);
    return {a[0] * b[0] - dot(u, v), w[0], w[1], w[2]};
}

Quaternion conjugate(const Quaternion& q) { return {q[0], -q[1], -q[2], -q[3]}; }

Vec3 rotated(const Quaternion& q, const Vec3& v)
{
    const Quaternion r = product(product(q, {0, v[0], v[1], v[2]}), conjugate(q));
    return {r[1], r[2], r[3]};
}

/// The turn by a vector along its axis, of its length [rad].
Quaternion turn_by(const Vec3& angle)
{
    const double size = std::sqrt(dot(angle, angle));
    const double s = size > 0 ? std::sin(0.5 * size) / size : 0.5;
    return {std::cos(0.5 * size), s * angle[0], s * angle[1], s * angle[2]};
}

Quaternion normalized(Quaternion q)
{
    double size = 0;
    for (const double c : q) size += c * c;
    for (double& c : q) c /= std::sqrt(size);
    return q;
}

bool contains(const Solid& solid, const Vec3& point)
{
    const Vec3 r = plus(point, solid.position, -1);
    if (solid.shape == Shape::sphere) return dot(r, r) < solid.radius * solid.radius;
    const Vec3 own = rotated(conjugate(solid.orientation), r);
    for (int d = 0; d < 3; ++d)
        if (std::abs(own[d]) >= solid.half_extents[d]) return false;
    return true;
}

/// Of the smallest sphere around a solid.
double reach(const Solid& s)
{
    return s.shape == Shape::sphere ? s.radius : std::sqrt(dot(s.half_extents, s.half_extents));
}

/// Integrals of a density over a volume: of 1, of r, and of r r.
struct Moments {
    double mass = 0;
    Vec3 first{};
    Mat3 second{};

    void add(double m, const Vec3& r)
    {
        mass += m;
        first = plus(first, r, m);
        for (int a = 0; a < 3; ++a) second[a] = plus(second[a], r, m * r[a]);
    }
    /// What was added to points belongs to volumes around them: of half extents h along turned axes, with variances `part` h^2.
    void spread(const Quaternion& q, const Vec3& h, double part)
    {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 e{};
            e[axis] = 1;
            e = rotated(q, e);
            for (int a = 0; a < 3; ++a) second[a] = plus(second[a], e, mass * part * h[axis] * h[axis] * e[a]);
        }
    }
};

Vec3 half_extents(const Solid& s)
{
    return s.shape == Shape::sphere ? Vec3{s.radius, s.radius, s.radius} : s.half_extents;
}

/// Of a whole sphere or box.
Moments of_whole(const Solid& s, double density)
{
    const bool ball = s.shape == Shape::sphere;
    const Vec3 h = half_extents(s);
    Moments m;
    m.add((ball ? 4 * std::numbers::pi / 3 : 8) * h[0] * h[1] * h[2] * density, s.position);
    m.spread(s.orientation, h, ball ? 1.0 / 5 : 1.0 / 3);
    return m;
}

/// Of what the parts before it leave of a part.
Moments of_part(const std::vector<RigidBodyPart>& parts, std::size_t index, const std::vector<Solid>& solids)
{
    constexpr int kPoints = 64;
    const Solid& solid = solids[parts[index].solid];
    std::vector<const Solid*> near;
    for (std::size_t before = 0; before < index; ++before) {
        const Solid& other = solids[parts[before].solid];
        const Vec3 apart = plus(solid.position, other.position, -1);
        const double distance = reach(solid) + reach(other);
        if (dot(apart, apart) < distance * distance) near.push_back(&other);
    }
    const Vec3 h = half_extents(solid);
    std::vector<Vec3> inside, left;
    for (int k = 0; k < kPoints && !near.empty(); ++k)
        for (int j = 0; j < kPoints; ++j)
            for (int i = 0; i < kPoints; ++i) {
                const Vec3 own{h[0] * ((2 * i + 1.0) / kPoints - 1), h[1] * ((2 * j + 1.0) / kPoints - 1),
                               h[2] * ((2 * k + 1.0) / kPoints - 1)};
                const Vec3 point = plus(solid.position, rotated(solid.orientation, own));
                if (!contains(solid, point)) continue;
                inside.push_back(point);
                if (std::none_of(near.begin(), near.end(), [&](const Solid* s) { return contains(*s, point); }))
                    left.push_back(point);
            }
    const Moments whole = of_whole(solid, parts[index].density);
    if (left.size() == inside.size()) return whole;
    Moments m;
    for (const Vec3& point : left) m.add(whole.mass / static_cast<double>(inside.size()), point);
    m.spread(solid.orientation, h, 1.0 / (3 * kPoints * kPoints));
    return m;
}

double determinant(const Mat3& m) { return dot(m[0], cross(m[1], m[2])); }

Mat3 inverse(const Mat3& m)  // of a symmetric one
{
    const double det = determinant(m);
    Mat3 result;
    for (int a = 0; a < 3; ++a) result[a] = plus({}, cross(m[(a + 1) % 3], m[(a + 2) % 3]), 1 / det);
    return result;
}

/// Smallest eigenvalue of a symmetric matrix, by the cosine formula for its cubic equation.
double smallest_eigenvalue(const Mat3& m)
{
    const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3;
    Mat3 rest = m;
    double square = 0;
    for (int a = 0; a < 3; ++a) {
        rest[a][a] -= mean;
        square += dot(rest[a], rest[a]);
    }
    const double p = std::sqrt(square / 6);
    if (p <= 1e-14 * mean) return mean;
    const double angle = std::acos(std::clamp(determinant(rest) / (2 * p * p * p), -1.0, 1.0)) / 3;
    return mean + 2 * p * std::cos(angle + 2 * std::numbers::pi / 3);
}

}  // namespace

RigidBody::RigidBody(std::vector<RigidBodyPart> parts, std::vector<Solid>& solids)
{
    Moments sum;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Moments m = of_part(parts, i, solids);
        sum.mass += m.mass;
        sum.first = plus(sum.first, m.first);
        for (int a = 0; a < 3; ++a) sum.second[a] = plus(sum.second[a], m.second[a]);
    }
    mass_ = sum.mass;
    centre_ = plus({}, sum.first, 1 / mass_);
    Mat3 inertia{};
    double trace = 0;
    for (int a = 0; a < 3; ++a) {
        sum.second[a] = plus(sum.second[a], centre_, -mass_ * centre_[a]);
        trace += sum.second[a][a];
    }
    for (int a = 0; a < 3; ++a) {
        inertia[a] = plus({}, sum.second[a], -1);
        inertia[a][a] += trace;
    }
    inverse_inertia_ = inverse(inertia);
    const double smallest = smallest_eigenvalue(inertia);

    const Solid& first = solids[parts[0].solid];
    const Vec3 spin = first.angular_velocity;
    velocity_ = plus(first.velocity, cross(spin, plus(centre_, first.position, -1)));
    for (int a = 0; a < 3; ++a) angular_momentum_[a] = dot(inertia[a], spin);
    for (const RigidBodyPart& part : parts) {
        Solid& solid = solids[part.solid];
        const Vec3 arm = plus(solid.position, centre_, -1);
        const Vec3 expected = plus(velocity_, cross(spin, arm)), off = plus(solid.velocity, expected, -1);
        const double scale = dot(expected, expected) + dot(solid.velocity, solid.velocity);
        if (solid.angular_velocity != spin || dot(off, off) > 1e-12 * scale)
            throw ConfigError("solids[" + std::to_string(part.solid) +
                              "].velocity: with the velocities of the first part its centre would move at (" +
                              std::to_string(expected[0]) + ", " + std::to_string(expected[1]) + ", " +
                              std::to_string(expected[2]) +
                              ") m/s and turn with it; parts of a free body have the velocities of one rigid body");
        solid.mass = mass_;
        solid.inertia = smallest;
        arms_.push_back({part.solid, arm, solid.orientation});
    }
    pass_on(solids);
}

Vec3 RigidBody::spin(const Quaternion& q) const
{
    const Vec3 own = rotated(conjugate(q), angular_momentum_);
    Vec3 w;
    for (int a = 0; a < 3; ++a) w[a] = dot(inverse_inertia_[a], own);
    return rotated(q, w);
}

void RigidBody::pass_on(std::vector<Solid>& solids) const
{
    const Vec3 w = spin(turn_);
    for (const Arm& arm : arms_) {
        Solid& solid = solids[arm.solid];
        const Vec3 lever = rotated(turn_, arm.start);
        solid.position = plus(centre_, lever);
        solid.velocity = plus(velocity_, cross(w, lever));
        solid.angular_velocity = w;
        solid.orientation = product(turn_, arm.orientation);
        if (solid.body >= 0) solid.lever = lever;
    }
}

void RigidBody::push(const std::vector<SolidLoad>& loads, const Vec3& gravity, double dt, std::vector<Solid>& solids)
{
    velocity_ = plus(velocity_, gravity, dt);
    for (const Arm& arm : arms_) {
        const SolidLoad& load = loads[arm.solid];
        velocity_ = plus(velocity_, load.force, dt / mass_);
        const Vec3 lever = plus(solids[arm.solid].position, centre_, -1);
        angular_momentum_ = plus(plus(angular_momentum_, load.torque, dt), cross(lever, load.force), dt);
    }
    pass_on(solids);
}

void RigidBody::move(double dt, std::vector<Solid>& solids)
{
    centre_ = plus(centre_, velocity_, dt);
    const Quaternion middle = product(turn_by(plus({}, spin(turn_), 0.5 * dt)), turn_);
    turn_ = normalized(product(turn_by(plus({}, spin(middle), dt)), turn_));
    pass_on(solids);
}

}  // namespace lbm
