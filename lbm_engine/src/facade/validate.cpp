#include "facade/validate.hpp"

#include "lattice/message.hpp"
#include "lattice/vec3.hpp"

#include <unordered_set>

namespace lbm {
namespace {

void require_finite(const char* name, const Vec3& v, const char* unit)
{
    if (!is_finite(v))
        throw ConfigError(message(name, " = (", v[0], ", ", v[1], ", ", v[2], "): must be finite [", unit, "]"));
}

constexpr char kAxis[] = "xyz";

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
    if (!std::isnan(c.magic_parameter)) require_positive("magic_parameter", c.magic_parameter, "-");
    require_positive("max_mach", c.max_mach, "-");
    require_finite("lower", c.lower, "m");
    require_finite("gravity", c.gravity, "m/s2");
    require_finite("acceleration", c.acceleration, "m/s2");
    if (c.threads < 0) throw ConfigError(message("threads = ", c.threads, ": must be >= 0; 0 leaves it to OpenMP"));
    for (int d = 0; d < 3; ++d) {
        const FaceCondition &low = c.faces[2 * d], &high = c.faces[2 * d + 1];
        if ((low.type == FaceType::periodic) != (high.type == FaceType::periodic))
            throw ConfigError(message("boundary along ", kAxis[d],
                                      ": one face is periodic and the other is not; both or none must be"));
        for (const FaceCondition* face : {&low, &high}) {
            require_finite("wall velocity", face->velocity, "m/s");
            if (face->type == FaceType::periodic && norm(face->velocity) > 0)
                throw ConfigError(
                    message("wall velocity at a periodic face along ", kAxis[d], ": only a no-slip face can move"));
            if (face->velocity[d] != 0)
                throw ConfigError(message("wall velocity along ", kAxis[d], " = ", face->velocity[d],
                                          " m/s at a face normal to ", kAxis[d],
                                          ": a wall can only move in its own plane"));
        }
    }
}

void validate(const FluidConfig& c, const std::vector<Solid>& solids)
{
    for (const Solid& s : solids) {
        const auto fail = [&](const auto&... part) { throw ConfigError(message("solid ", s.id, ": ", part...)); };
        if (!(std::isfinite(s.radius) && s.radius > 0)) fail("radius = ", s.radius, ": must be finite and > 0 [m]");
        if (s.radius < kMinRadiusInCells * c.dx * (1 - 1e-9))
            fail("radius = ", s.radius, " m is ", s.radius / c.dx, " cells: must be at least ", kMinRadiusInCells,
                 " cells; use dx <= ", s.radius / kMinRadiusInCells, " m");
        for (int d = 0; d < 3; ++d)
            if (2 * s.radius > c.cells[d] * c.dx * (1 + 1e-9))
                fail("diameter = ", 2 * s.radius, " m: larger than the box along ", kAxis[d], ", ", c.cells[d] * c.dx,
                     " m");
        if (!is_finite(s.position)) fail("position is not finite");
        if (!is_finite(s.velocity)) fail("velocity is not finite");
        if (!is_finite(s.angular_velocity)) fail("angular velocity is not finite");
        if (!(s.mass > 0)) fail("mass = ", s.mass, ": must be > 0 [kg]; infinity for a prescribed motion");
        if (!(s.inertia > 0))
            fail("moment of inertia = ", s.inertia, ": must be > 0 [kg m2]; infinity for a prescribed motion");
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
