#include "facade/validate.hpp"

#include "lattice/message.hpp"
#include "lattice/units.hpp"
#include "lattice/vec3.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <unordered_set>

namespace lbm {
namespace {

void require_finite(const char* name, const Vec3& v, const char* unit)
{
    if (!is_finite(v))
        throw ConfigError(message(name, " = (", v[0], ", ", v[1], ", ", v[2], "): must be finite [", unit, "]"));
}

constexpr char kAxis[] = "xyz";

/// Decimal input is off by 1e-15; the mass of the fluid may not drift with more.
constexpr double kBalanced = 1e-9;

/// Of the density, by a pressure face: beyond, a liquid of constant density is not what is computed. The planner's limit too.
constexpr double kLargestDensityDeviation = 0.2;

/// Largest u_n dx / nu at a velocity face in a flow with inertia. Beyond, perturbations along the face grow: the linear stability of the lattice between such
/// faces is lost between 3 and 4 where fluid leaves (whose tangential velocity has to change over nu / u_n), between 10 and 12 where it enters.
constexpr double kLargestOutflow = 3, kLargestInflow = 10;

void validate_passage(const FluidConfig& c, int index)
{
    const FaceCondition& face = c.faces[index];
    if (face.type != FaceType::velocity || !c.inertia) return;
    const double outwards = (index % 2 ? 1 : -1) * face.velocity[index / 2];
    const double cell_reynolds = std::abs(outwards) * c.dx * c.density / c.viscosity;
    const double limit = outwards > 0 ? kLargestOutflow : kLargestInflow;
    if (cell_reynolds > limit * (1 + 1e-9))
        throw ConfigError(message("velocity of face ", kFaceNames[index], " = ", face.velocity[index / 2],
                                  " m/s along its normal: u dx / nu = ", cell_reynolds, " is unstable, at most ", limit,
                                  " is possible where fluid ", outwards > 0 ? "leaves" : "enters", "; use dx <= ",
                                  c.dx * limit / cell_reynolds, outwards > 0 ? " m, or a pressure face" : " m"));
}

void validate_face(const FluidConfig& c, int index)
{
    const FaceCondition& face = c.faces[index];
    const char* const name = kFaceNames[index];
    const int axis = index / 2;
    require_finite(message("velocity of face ", name).c_str(), face.velocity, "m/s");
    if (face.type != FaceType::no_slip && face.type != FaceType::velocity && norm(face.velocity) > 0)
        throw ConfigError(
            message("velocity of face ", name, ": only a velocity face or a moving no-slip wall has one"));
    if (face.type == FaceType::no_slip && face.velocity[axis] != 0)
        throw ConfigError(message("wall velocity along ", kAxis[axis], " = ", face.velocity[axis], " m/s at face ",
                                  name, ", normal to it: a wall can only move in its own plane; use a velocity face"));
    if (!std::isfinite(face.pressure))
        throw ConfigError(message("pressure of face ", name, " = ", face.pressure, ": must be finite [Pa]"));
    if (face.type != FaceType::pressure && face.pressure != 0)
        throw ConfigError(
            message("pressure of face ", name, " = ", face.pressure, " Pa: only a pressure face has one"));
    validate_passage(c, index);
    const double dt = fluid_time_step(c.tau, c.dx, c.viscosity / c.density);
    const double bulk_modulus = c.density * c.dx * c.dx / (3 * dt * dt);
    const double deviation = std::abs(face.pressure) / bulk_modulus;
    if (c.inertia && deviation > kLargestDensityDeviation)
        throw ConfigError(message(
            "pressure of face ", name, " = ", face.pressure, " Pa: changes the density by ", 100 * deviation,
            " % on this lattice, at most ", 100 * kLargestDensityDeviation,
            " % are allowed; use tau <= ", 0.5 + (c.tau - 0.5) * std::sqrt(kLargestDensityDeviation / deviation),
            ", a smaller dx, or take a part that is common to all pressure faces off"));
}

/// Grains are placed to within this part of a cell, wherever the box stands.
constexpr double kPlace = 1e-4;

/// Numbers must hold what is computed.
void validate_scales(const FluidConfig& c)
{
    for (int d = 0; d < 3; ++d) {
        const double apart = std::abs(c.lower[d]) * std::numeric_limits<double>::epsilon();
        if (apart > kPlace * c.dx)
            throw ConfigError(message("lower along ", kAxis[d], " = ", c.lower[d], " m: numbers of that size are ",
                                      apart, " m apart, too far for dx = ", c.dx,
                                      " m; move the origin nearer to the box"));
    }
    const double dt = fluid_time_step(c.tau, c.dx, c.viscosity / c.density);
    const Units units(c.dx, dt, c.density);
    for (const double unit :
         {units.time, units.velocity, units.acceleration, units.inertia, units.pressure, units.torque})
        if (!std::isnormal(unit))
            throw ConfigError(message("dx = ", c.dx, " m, density = ", c.density, " kg/m3, viscosity = ", c.viscosity,
                                      " Pa s: the fluid step would be ", dt,
                                      " s, beyond what numbers hold; are these SI units?"));
}

/// What comes in through velocity faces must leave somewhere.
void validate_inflow(const FluidConfig& c)
{
    double outflow = 0, size = 0;
    for (int index = 0; index < 6; ++index) {
        const FaceCondition& face = c.faces[index];
        if (face.type == FaceType::pressure) return;
        const int axis = index / 2;
        const double area = double(c.cells[(axis + 1) % 3]) * c.cells[(axis + 2) % 3] * c.dx * c.dx;
        outflow += (index % 2 ? 1 : -1) * face.velocity[axis] * area;
        size += std::abs(face.velocity[axis]) * area;
    }
    if (std::abs(outflow) > kBalanced * size)
        throw ConfigError(message("velocity faces let ", std::abs(outflow), " m3/s more ",
                                  outflow > 0 ? "out than in" : "in than out",
                                  ": make the velocities balance, or one of the faces a pressure face"));
}

}  // namespace

void validate(const FluidConfig& c)
{
    require_positive("dx", c.dx, "m");
    require_positive("density", c.density, "kg/m3");
    require_positive("viscosity", c.viscosity, "Pa s");
    for (int d = 0; d < 3; ++d) {
        if (c.cells[d] < 1)
            throw ConfigError(message("cells along ", kAxis[d], " = ", c.cells[d], ": must be at least 1"));
    }
    require_countable(c.cells);
    if (!(c.tau >= kMinTau && c.tau <= kMaxTau))
        throw ConfigError(message("tau = ", c.tau, ": must lie between ", kMinTau, " and ", kMaxTau,
                                  "; dt = (tau - 1/2) dx^2 / (3 nu)"));
    if (c.magic_parameter < kMinLambda || c.magic_parameter > kMaxLambda)
        throw ConfigError(message("magic_parameter = ", c.magic_parameter, ": must lie between ", kMinLambda, " and ",
                                  kMaxLambda, ", beyond which drag is off by more than 2 %; leave it out for 1/8"));
    if (c.collision == Collision::bgk && !std::isnan(c.magic_parameter))
        throw ConfigError(message("magic_parameter = ", c.magic_parameter,
                                  ": with one relaxation time (bgk) it is (tau - 1/2)^2; leave it out or use trt"));
    require_positive("max_mach", c.max_mach, "-");
    if (!(c.lubrication_roughness >= kMinRoughness && c.lubrication_roughness <= kMaxRoughness))
        throw ConfigError(message("lubrication_roughness = ", c.lubrication_roughness, ": must lie between ",
                                  kMinRoughness, " and ", kMaxRoughness, " [radii of the smaller sphere]"));
    require_finite("lower", c.lower, "m");
    require_finite("gravity", c.gravity, "m/s2");
    require_finite("acceleration", c.acceleration, "m/s2");
    require_finite("initial_velocity", c.initial_velocity, "m/s");
    validate_scales(c);
    if (c.threads < 0) throw ConfigError(message("threads = ", c.threads, ": must be >= 0; 0 leaves it to OpenMP"));
    for (int d = 0; d < 3; ++d) {
        const FaceCondition &low = c.faces[2 * d], &high = c.faces[2 * d + 1];
        if ((low.type == FaceType::periodic) != (high.type == FaceType::periodic))
            throw ConfigError(message("boundary along ", kAxis[d],
                                      ": one face is periodic and the other is not; both or none must be"));
        for (int side = 0; side < 2; ++side) validate_face(c, 2 * d + side);
    }
    validate_inflow(c);
}

namespace {

using Fail = std::function<void(const std::string&)>;

void validate_sphere(const FluidConfig& c, const Solid& s, const Fail& fail)
{
    for (int d = 0; d < 3; ++d) {
        // a sphere on a plane of symmetry shows half of itself
        const bool periodic = c.faces[2 * d].type == FaceType::periodic;
        if (2 * s.radius > (periodic ? 1 : 2) * c.cells[d] * c.dx * (1 + 1e-9))
            fail(message("diameter = ", 2 * s.radius, " m: larger than ", periodic ? "" : "twice ", "the box along ",
                         kAxis[d], ", ", c.cells[d] * c.dx, " m; make the box longer or the sphere smaller"));
    }
}

void validate_pipe(const FluidConfig& c, const Solid& s, const Fail& fail)
{
    if (s.axis < 0 || s.axis > 2) fail(message("axis = ", s.axis, ": must be 0, 1 or 2 for x, y, z"));
    if (s.body >= 0) fail("a pipe cannot be part of a rigid body");
    if (s.angular_velocity != Vec3{})
        fail("a pipe cannot turn: it fills the box to its faces; angular velocity must be 0");
    for (int d = 0; d < 3; ++d) {
        if (d == s.axis) continue;
        const double below = s.position[d] - s.radius - c.lower[d];
        const double above = c.lower[d] + c.cells[d] * c.dx - s.position[d] - s.radius;
        if (!(std::min(below, above) >= -1e-9 * c.dx))
            fail(message("the bore of radius ", s.radius, " m around ", s.position[d], " m along ", kAxis[d],
                         " does not fit into the box"));
    }
}

/// Whether any part of a box can lie in the fluid; one that stands outside, as walls of the grains often do, may be as thin as it likes.
bool reaches_into_fluid(const FluidConfig& c, const Solid& s)
{
    const Mat3 axes = rotated_axes(s.orientation);
    for (int d = 0; d < 3; ++d) {
        if (c.faces[2 * d].type == FaceType::periodic) continue;
        const double half = half_reach(axes, s.half_extents, d), upper = c.lower[d] + c.cells[d] * c.dx;
        if (s.position[d] + half <= c.lower[d] + 1e-6 * c.dx || s.position[d] - half >= upper - 1e-6 * c.dx)
            return false;
    }
    return true;
}

void validate_box(const FluidConfig& c, const Solid& s, const Fail& fail)
{
    const Mat3 axes = rotated_axes(s.orientation);
    double norm2 = 0;
    for (const double q : s.orientation) norm2 += q * q;
    if (!(std::abs(norm2 - 1) < 1e-6)) fail("orientation: must be a unit quaternion (w, x, y, z)");
    for (const double h : s.half_extents)
        if (!(std::isfinite(h * h) && h >= 0)) fail(message("half extent = ", h, ": must be finite and >= 0 [m]"));
    if (!reaches_into_fluid(c, s)) return;
    for (const double h : s.half_extents)
        if (h < kMinHalfExtentInCells * c.dx * (1 - 1e-9))
            fail(message(
                "thickness = ", 2 * h, " m is ", 2 * h / c.dx,
                " cells: a box in the fluid must be at least two cells thick; make it thicker, or leave it out"));
    if (is_along_axes(axes)) return;
    for (int d = 0; d < 3; ++d) {
        const double extent = 2 * half_reach(axes, s.half_extents, d), length = c.cells[d] * c.dx;
        if (c.faces[2 * d].type == FaceType::periodic && extent > length - 1e-6 * c.dx)
            fail(message("a turned box that reaches over ", extent, " m along ", kAxis[d],
                         ", where the box of fluid repeats after ", length,
                         " m: must be shorter, or it would meet itself; only boxes along the axes may be longer"));
    }
}

}  // namespace

void validate(const FluidConfig& c, const std::vector<Solid>& solids)
{
    for (const Solid& s : solids) {
        const Fail fail = [&](const std::string& what) { throw ConfigError(message("solid ", s.id, ": ", what)); };
        if (!is_finite(s.position)) fail("position is not finite");
        if (!is_finite(s.velocity)) fail("velocity is not finite");
        if (!is_finite(s.angular_velocity)) fail("angular velocity is not finite");
        if (!(s.mass > 0)) fail(message("mass = ", s.mass, ": must be > 0 [kg]; infinity for a prescribed motion"));
        if (!(s.inertia > 0))
            fail(message("moment of inertia = ", s.inertia, ": must be > 0 [kg m2]; infinity for a prescribed motion"));
        if (s.shape == Shape::box) {
            validate_box(c, s, fail);
            continue;
        }
        if (!(std::isfinite(s.radius) && s.radius > 0))
            fail(message("radius = ", s.radius, ": must be finite and > 0 [m]"));
        if (s.radius < kMinRadiusInCells * c.dx * (1 - 1e-9))
            fail(message("radius = ", s.radius, " m is ", s.radius / c.dx, " cells: must be at least ",
                         kMinRadiusInCells, " cells; use dx <= ", s.radius / kMinRadiusInCells, " m"));
        if (s.shape == Shape::sphere) validate_sphere(c, s, fail);
        else validate_pipe(c, s, fail);
    }
}

void require_unique_ids(const std::vector<Solid>& solids)
{
    std::unordered_set<std::int64_t> ids;
    ids.reserve(solids.size());
    for (const Solid& s : solids)
        if (!ids.insert(s.id).second)
            throw ConfigError(message("solid ", s.id, ": this id is given twice; ids must be unique"));
}

}  // namespace lbm
