#include "planning.hpp"

#include "lbm_engine.hpp"
#include "speed_estimate.hpp"
#include "text.hpp"

#include "lbm/errors.hpp"

#include <core/Scene.hpp>

#include <algorithm>
#include <cmath>

namespace yadelbm {
namespace {

constexpr double kSameLength = 1e-6;  // relative, as for the whole number of cells

void check_spheres(const Settings& s, const std::vector<lbm::Solid>& solids)
{
    for (const lbm::Solid& solid : solids) {
        if (solid.shape != lbm::Shape::sphere) continue;  // the engine says what is wrong with a box
        const std::string name = "sphere " + std::to_string(solid.id) + ": radius = " + text(solid.radius);
        if (!(std::isfinite(solid.radius) && solid.radius > 0))
            throw lbm::ConfigError(name + ": must be finite and > 0 [m]");
        if (solid.radius < lbm::kMinRadiusInCells * s.dx * (1 - kSameLength))
            throw lbm::ConfigError(name + " is " + text(solid.radius / s.dx) + " cells, must be at least " +
                                   text(lbm::kMinRadiusInCells) +
                                   "; dx <= " + text(solid.radius / lbm::kMinRadiusInCells) + " would do");
        for (int axis = 0; axis < 3; ++axis) {
            const double length = s.upper[axis] - s.lower[axis];
            const bool periodic = s.boundary[2 * axis] == "periodic";
            if (2 * solid.radius > (periodic ? 1 : 2) * length * (1 + kSameLength))
                throw lbm::ConfigError(name + ": the sphere is larger than " + (periodic ? "" : "twice ") +
                                       "the fluid's box, " + text(length) + " along " + "xyz"[axis] +
                                       "; make the box longer or the sphere smaller");
        }
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(solid.position[axis] + solid.velocity[axis] + solid.angular_velocity[axis]))
                throw lbm::ConfigError("sphere " + std::to_string(solid.id) +
                                       ": position, velocity and angular velocity must be finite");
        if (!(solid.mass > 0) || !(solid.inertia > 0))
            throw lbm::ConfigError("sphere " + std::to_string(solid.id) + ": mass = " + text(solid.mass) +
                                   ", inertia = " + text(solid.inertia) +
                                   ": must be > 0 for a body that is free to move; give its "
                                   "material a density, or block it");
    }
}

}  // namespace

void check_place(const yade::Scene& scene, const Settings& s)
{
    // O.engines assigned while a step is under way (or after one that failed) takes effect with the next step
    const auto& engines = scene._nextEngines.empty() ? scene.engines : scene._nextEngines;
    int fluids = 0;
    bool integrated = false;
    for (const auto& engine : engines) {
        if (!engine) continue;
        const std::string name = engine->getClassName();
        integrated = integrated || name == "NewtonIntegrator";
        if (name == "ForceResetter" && fluids > 0)
            throw lbm::ConfigError(
                "LbmEngine stands before ForceResetter in O.engines, which takes its loads away: put it after");
        if (name == "InteractionLoop" && fluids > 0 && s.lubrication)
            throw lbm::ConfigError(
                "LbmEngine stands before InteractionLoop in O.engines: lubrication has to know the contact forces of "
                "the step; put it after, or set lubrication=False");
        if (!dynamic_cast<const LbmEngine*>(engine.get())) continue;
        if (++fluids > 1)
            throw lbm::ConfigError(
                "two LbmEngines in O.engines: a scene has one fluid, listed once; remove one of them");
        if (integrated)
            throw lbm::ConfigError(
                "LbmEngine stands after NewtonIntegrator in O.engines, where its loads are lost when the "
                "next step resets the forces: put it before");
    }
}

void check_selection(const Settings& s, const std::vector<lbm::Solid>& solids)
{
    for (int id : s.ids)
        if (std::none_of(solids.begin(), solids.end(), [id](const lbm::Solid& solid) { return solid.id == id; }))
            throw lbm::ConfigError(
                "LbmEngine.ids: body " + std::to_string(id) +
                " does not exist, is neither a Sphere nor a Box (of a clump, name the members) or is "
                "excluded by mask");
    if (solids.empty())
        throw lbm::ConfigError("LbmEngine: no body with a Sphere or Box shape is selected (mask = " +
                               std::to_string(s.mask) + "): append spheres to O.bodies first, or change mask");
}

void check_cell(const yade::Scene& scene, const Settings& s, const std::vector<lbm::Solid>& solids)
{
    if (!scene.isPeriodic) return;
    double largest_diameter = 0;
    for (const lbm::Solid& solid : solids)
        if (solid.shape == lbm::Shape::sphere) largest_diameter = std::max(largest_diameter, 2 * solid.radius);
    const yade::Matrix3r& cell = scene.cell->hSize;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double length = s.upper[i] - s.lower[i];
            const std::string name = "O.cell.hSize[" + std::to_string(i) + "][" + std::to_string(j) + "] = ";
            if (i == j && s.boundary[2 * i] != "periodic") {
                if (cell(i, i) > length + largest_diameter) continue;
                throw lbm::ConfigError(name + text(cell(i, i)) + ": must be above " + text(length + largest_diameter) +
                                       ", the fluid's box and a diameter, where faces of the box are '" +
                                       s.boundary[2 * i] + "': grains at opposite faces would touch across the cell");
            }
            const double wanted = i == j ? length : 0;
            if (std::abs(cell(i, j) - wanted) > kSameLength * length)
                throw lbm::ConfigError(name + text(cell(i, j)) + ": must be " + text(wanted) +
                                       " to match the fluid's box; a deforming cell is not supported today");
        }
}

void check_scene(const yade::Scene& scene, const Settings& s, const std::vector<lbm::Solid>& solids)
{
    check(s, true);
    if (!(std::isfinite(scene.dt) && scene.dt > 0))
        throw lbm::ConfigError("O.dt = " + text(scene.dt) + ": must be finite and > 0 [s]");
    check_place(scene, s);
    check_cell(scene, s, solids);
    check_selection(s, solids);
    check_spheres(s, solids);
}

lbm::PlanRequest plan_request(const yade::Scene& scene, const Settings& s, const std::vector<lbm::Solid>& solids)
{
    lbm::PlanRequest request;
    if (!std::isnan(s.dx)) request.cells = cells(s);
    request.dx = s.dx;
    request.density = s.density;
    request.viscosity = s.viscosity;
    request.grain_dt = scene.dt;
    request.tau = s.tau;
    request.max_mach = s.max_mach;
    request.accuracy = s.accuracy;
    request.lattice = s.lattice == "D3Q27" ? lbm::Lattice::d3q27 : lbm::Lattice::d3q19;
    request.storage = s.storage == "single" ? lbm::Storage::single_precision : lbm::Storage::double_precision;
    request.speed = expected_speed(s, solids);
    request.response_time = response_time(s, solids, request.speed);
    request.static_pressure = static_pressure(s, solids);
    double radii = 0;
    int spheres = 0;
    for (const lbm::Solid& solid : solids) {
        if (solid.shape != lbm::Shape::sphere) continue;
        request.smallest_radius = std::min(request.smallest_radius, solid.radius);
        radii += solid.radius;
        ++spheres;
    }
    if (spheres > 0) request.mean_diameter = 2 * radii / spheres;
    return request;
}

}  // namespace yadelbm
