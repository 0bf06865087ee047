#include "speed_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace yadelbm {
namespace {

constexpr double kPi = 3.14159265358979323846;

double norm(const lbm::Vec3& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

double sphere_volume(double radius) { return 4.0 / 3.0 * kPi * radius * radius * radius; }

double volume(const lbm::Solid& solid)
{
    const auto& h = solid.half_extents;
    return solid.shape == lbm::Shape::box ? 8 * h[0] * h[1] * h[2] : sphere_volume(solid.radius);
}

double distance(const lbm::Vec3& a, const lbm::Vec3& b) { return norm({a[0] - b[0], a[1] - b[1], a[2] - b[2]}); }

/// Volume of a part that the spheres among the earlier parts of its body leave, within some per cent of the part; boxes count whole.
double volume_left(const lbm::Solid& part, const std::vector<const lbm::Solid*>& earlier)
{
    std::vector<const lbm::Solid*> near;
    for (const lbm::Solid* other : earlier)
        if (part.shape == lbm::Shape::sphere && other->shape == lbm::Shape::sphere &&
            distance(part.position, other->position) < part.radius + other->radius)
            near.push_back(other);
    if (near.empty()) return volume(part);
    constexpr int kPoints = 10;  // along each axis of the cube around the sphere
    int inside = 0, left = 0;
    for (int point = 0; point < kPoints * kPoints * kPoints; ++point) {
        const int index[3] = {point % kPoints, point / kPoints % kPoints, point / (kPoints * kPoints)};
        lbm::Vec3 at = part.position;
        for (int d = 0; d < 3; ++d) at[d] += part.radius * (2 * (index[d] + 0.5) / kPoints - 1);
        if (distance(at, part.position) > part.radius) continue;
        ++inside;
        left += std::none_of(near.begin(), near.end(),
                             [&](const lbm::Solid* other) { return distance(at, other->position) < other->radius; });
    }
    return volume(part) * left / inside;
}

/// What answers to its load as one: a lone solid or, a rigid body.
struct FreeBody {
    double mass = 0, volume = 0;
    /// Half of its size: its radius, or that of a sphere of its volume.
    double half_size() const { return std::cbrt(3 * volume / (4 * kPi)); }
};

std::vector<FreeBody> free_bodies(const std::vector<lbm::Solid>& solids)
{
    std::vector<FreeBody> bodies;
    std::map<std::int64_t, std::vector<const lbm::Solid*>> parts;  // by the number of the rigid body
    for (const lbm::Solid& solid : solids) {
        if (!std::isfinite(solid.mass)) continue;
        if (solid.body < 0) bodies.push_back({solid.mass, volume(solid)});
        else parts[solid.body].push_back(&solid);
    }
    for (const auto& [number, of_body] : parts) {
        FreeBody body{of_body.front()->mass, 0};
        std::vector<const lbm::Solid*> earlier;
        for (const lbm::Solid* part : of_body) {
            body.volume += volume_left(*part, earlier);
            earlier.push_back(part);
        }
        bodies.push_back(body);
    }
    return bodies;
}

/// Share of a lone sphere's speed that is left at solid fraction c: cubic array, dilute.
/// @see Hasimoto (1959), J. Fluid Mech. 5, 317
double hindrance(double c)
{
    c = std::min(c, 0.2);
    return 1 - 1.7601 * std::cbrt(c) + c - 1.5593 * c * c;
}

/// Under the uniform drive and between pressure faces: the least of what walls (Poiseuille), fixed grains taken as an array (Stokes, Hasimoto) and
/// taken as a bed (Carman-Kozeny) allow; each alone is too high where another one holds the fluid back.
double driven_speed(const Settings& s, const std::vector<lbm::Solid>& solids)
{
    lbm::Vec3 gradient = s.acceleration;
    double drop = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (s.boundary[2 * axis] == "pressure" && s.boundary[2 * axis + 1] == "pressure") {
            const double along = s.boundary_pressure[2 * axis] - s.boundary_pressure[2 * axis + 1];
            gradient[axis] += along / (s.density * (s.upper[axis] - s.lower[axis]));
            drop = std::max(drop, std::abs(along));
        }
    const double drive = norm(gradient);
    if (drive == 0) return 0;
    const double nu = s.viscosity / s.density;
    double volume = 1, speed = std::numeric_limits<double>::infinity();
    // without friction, from rest
    if (drop > 0 && norm(s.acceleration) == 0) speed = std::sqrt(2 * drop / s.density);
    for (int axis = 0; axis < 3; ++axis) {
        const double length = s.upper[axis] - s.lower[axis];
        volume *= length;
        const double along = std::abs(gradient[axis]) / drive;
        const int walls = (s.boundary[2 * axis] == "noSlip") + (s.boundary[2 * axis + 1] == "noSlip");
        const double width = walls == 2 ? length : 2 * length;  // one wall: the other half is a mirror image
        if (walls > 0 && along < 0.99) speed = std::min(speed, drive * width * width / (8 * nu));
    }
    double diameters = 0, occupied = 0;
    for (const lbm::Solid& solid : solids)
        if (!std::isfinite(solid.mass)) {
            diameters += 2 * solid.radius;
            occupied += sphere_volume(solid.radius);
        }
    const double solid_fraction = std::min(occupied / volume, 0.75);
    if (diameters > 0 && solid_fraction > 0) {
        speed = std::min(speed, drive * volume / (3 * kPi * nu * diameters) * hindrance(solid_fraction));
        double squares = 0;
        for (const lbm::Solid& solid : solids)
            if (!std::isfinite(solid.mass)) squares += 4 * kPi * solid.radius * solid.radius;
        const double sauter = 6 * occupied / squares, pores = 1 - solid_fraction;
        // permeability over porosity, and twice the mean for the fastest pores
        speed =
            std::min(speed, 2 * drive * sauter * sauter * pores * pores / (180 * solid_fraction * solid_fraction * nu));
    }
    return std::isfinite(speed) ? speed : 0;
}

}  // namespace

double settling_speed(double diameter, double density_difference, double gravity, double density, double viscosity)
{
    const double weight = std::abs(density_difference) * gravity * kPi / 6 * diameter * diameter * diameter;
    if (!(weight > 0)) return 0;
    const auto drag = [&](double speed) {
        const double reynolds = density * speed * diameter / viscosity;
        const double stokes = 3 * kPi * viscosity * diameter * speed;
        if (reynolds < 1000) return stokes * (1 + 0.15 * std::pow(reynolds, 0.687));
        return std::max(0.44 * kPi / 8 * density * diameter * diameter * speed * speed,
                        3 * kPi * viscosity * diameter * speed);
    };
    double low = 0, high = weight / (3 * kPi * viscosity * diameter);  // Stokes: the drag is never less
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (drag(middle) < weight ? low : high) = middle;
    }
    return high;
}

double response_time(const Settings& s, const std::vector<lbm::Solid>& solids, double speed)
{
    double shortest = std::numeric_limits<double>::infinity();
    const double nu = s.viscosity / s.density;
    for (const FreeBody& body : free_bodies(solids)) {
        const double ratio = body.mass / (s.density * body.volume), R = body.half_size();
        const double stokes = (ratio + 0.5) * (2.0 / 9) * R * R / nu;
        const double reynolds = std::min(speed * 2 * R / nu, 1000.0);
        shortest = std::min(shortest, stokes / (1 + 0.15 * std::pow(reynolds, 0.687)));
    }
    return shortest;
}

double static_pressure(const Settings& s, const std::vector<lbm::Solid>& solids)
{
    double pressure = 0, diameters = 0;
    if (s.inertia)  // Stokes flow is linear in the pressure, whatever it does to the density
        for (const double on_face : s.boundary_pressure) pressure = std::max(pressure, std::abs(on_face));
    int spheres = 0;
    for (const lbm::Solid& solid : solids) {
        diameters += 2 * solid.radius;
        spheres += solid.shape == lbm::Shape::sphere;
    }
    const double mean_diameter = spheres == 0 ? 0 : diameters / spheres;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = s.upper[axis] - s.lower[axis];
        const bool periodic = s.boundary[2 * axis] == "periodic";
        pressure += s.density * std::abs(s.acceleration[axis]) * (periodic ? mean_diameter : length);
        if (periodic) continue;
        double area = 1, weight = 0;
        for (int other = 0; other < 3; ++other)
            if (other != axis) area *= s.upper[other] - s.lower[other];
        for (const FreeBody& body : free_bodies(solids))
            weight += (body.mass - s.density * body.volume) * s.gravity[axis];
        pressure += std::abs(weight) / area;
    }
    return pressure;
}

double expected_speed(const Settings& s, const std::vector<lbm::Solid>& solids)
{
    double speed = driven_speed(s, solids);
    for (const lbm::Vec3& wall : s.boundary_velocity) speed = std::max(speed, norm(wall));
    const double gravity = norm(s.gravity);
    for (const lbm::Solid& solid : solids)
        speed = std::max(speed, norm(solid.velocity) +
                                    norm(solid.angular_velocity) * (solid.radius + norm(solid.half_extents)));
    for (const FreeBody& body : free_bodies(solids)) {
        const double difference = body.mass / body.volume - s.density;
        speed = std::max(speed, settling_speed(2 * body.half_size(), difference, gravity, s.density, s.viscosity));
    }
    return speed;
}

}  // namespace yadelbm
