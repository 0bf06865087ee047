#include "lbm_engine.hpp"

#include <core/Omega.hpp>
#include <core/Scene.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace yadelbm {

const lbm::Fluid& LbmEngine::fluid(const char* asked) const
{
    if (!fluid_)
        throw std::runtime_error(std::string("LbmEngine.") + asked +
                                 ": there is no fluid yet; it comes into being in the first step, run O.step() first");
    return *fluid_;
}

namespace {

/// Null for a solid that is not there.
const lbm::SolidLoad* find_load(const std::vector<lbm::Solid>& solids, const std::vector<lbm::SolidLoad>& loads, int id)
{
    const auto found = std::lower_bound(solids.begin(), solids.end(), id,
                                        [](const lbm::Solid& solid, int wanted) { return solid.id < wanted; });
    const auto index = static_cast<std::size_t>(found - solids.begin());
    return found == solids.end() || found->id != id || index >= loads.size() ? nullptr : &loads[index];
}

std::string why_not_in_fluid(int id)
{
    const auto& bodies = Singleton<yade::Omega>::instance().getScene()->bodies->body;
    const auto index = static_cast<std::size_t>(id);
    if (id >= 0 && index < bodies.size() && bodies[index] && bodies[index]->isClump())
        return " is a clump, whose load is that of its members (O.bodies[" + std::to_string(id) +
               "].shape.members): ask for theirs";
    return " was not in the fluid at its last step";
}

}  // namespace

lbm::SolidLoad LbmEngine::load_on(int id) const
{
    const std::lock_guard lock(mutex_);
    const lbm::SolidLoad* lattice = find_load(solids_, fluid("fluidForce, fluidTorque, stresslet").loads(), id);
    if (!lattice) throw std::invalid_argument("body " + std::to_string(id) + why_not_in_fluid(id));
    const Impulse now = held_.current(id);
    lbm::SolidLoad load = *lattice;
    load.force = now.linear;
    load.torque = now.angular;
    if (const lbm::SolidLoad* films = find_load(surfaces_, film_loads_, id))
        for (int a = 0; a < 3; ++a) {
            load.force[a] += films->force[a];
            load.torque[a] += films->torque[a];
            for (int b = 0; b < 3; ++b) load.stresslet[a][b] += films->stresslet[a][b];
        }
    return load;
}

lbm::Vec3 LbmEngine::velocity_at(const lbm::Vec3& position) const
{
    const std::lock_guard lock(mutex_);
    return fluid("getVelocity").velocity_at(position);
}

double LbmEngine::pressure_at(const lbm::Vec3& position) const
{
    const std::lock_guard lock(mutex_);
    return fluid("getPorePressure").pressure_at(position);
}

lbm::Vec3 LbmEngine::average_velocity() const
{
    const std::lock_guard lock(mutex_);
    return fluid("averageVelocity").average_velocity();
}

double LbmEngine::permeability() const
{
    const std::lock_guard lock(mutex_);
    return fluid("permeability").permeability();
}

namespace {

lbm::Face face_of(const char* asked, int face)
{
    if (face < 0 || face > 5)
        throw std::invalid_argument(std::string("LbmEngine.") + asked + "(" + std::to_string(face) +
                                    "): must be 0 to 5, for xmin, xmax, ymin, ymax, zmin, zmax");
    return static_cast<lbm::Face>(face);
}

}  // namespace

double LbmEngine::boundary_flux(int face) const
{
    const std::lock_guard lock(mutex_);
    return fluid("getBoundaryFlux").boundary_flux(face_of("getBoundaryFlux", face));
}

lbm::Vec3 LbmEngine::boundary_force(int face) const
{
    const std::lock_guard lock(mutex_);
    return fluid("getBoundaryForce").boundary_force(face_of("getBoundaryForce", face));
}

double LbmEngine::total_mass() const
{
    const std::lock_guard lock(mutex_);
    return fluid("totalMass").total_mass();
}

lbm::Vec3 LbmEngine::total_momentum() const
{
    const std::lock_guard lock(mutex_);
    lbm::Vec3 momentum = fluid("totalMomentum").total_momentum();
    // between steps the grains already had the last one under the current forces
    const yade::Scene& now = *Singleton<yade::Omega>::instance().getScene();
    const double elapsed = now.iter != last_iter_ ? length_of_last_grain_step(now) : 0;
    const lbm::Vec3 on_its_way = held_.undelivered(elapsed);
    for (int d = 0; d < 3; ++d) momentum[d] += on_its_way[d];
    return momentum;
}

lbm::StressParts LbmEngine::stress() const
{
    const std::lock_guard lock(mutex_);
    return fluid("stress").stress();
}

double LbmEngine::kinetic_energy() const
{
    const std::lock_guard lock(mutex_);
    return fluid("kineticEnergy").kinetic_energy();
}

std::vector<double> LbmEngine::velocity_field() const
{
    const std::lock_guard lock(mutex_);
    return fluid("velocity").velocity_field();
}

std::vector<double> LbmEngine::pressure_field() const
{
    const std::lock_guard lock(mutex_);
    return fluid("pressure").pressure_field();
}

std::vector<double> LbmEngine::solid_fraction_field() const
{
    const std::lock_guard lock(mutex_);
    return fluid("solidFraction").solid_fraction_field();
}

void LbmEngine::save_vtk(const std::string& path) const
{
    const std::lock_guard lock(mutex_);
    fluid("saveVtk").save_vtk(path);
}

double LbmEngine::fluid_dt() const
{
    const std::lock_guard lock(mutex_);
    return fluid_ ? fluid_->dt() : std::numeric_limits<double>::quiet_NaN();
}

double LbmEngine::steps_per_fluid_step() const
{
    const double ratio = fluid_dt() / Singleton<yade::Omega>::instance().getScene()->dt;
    const double whole = std::round(ratio);
    return std::abs(ratio - whole) < 1e-9 * whole ? whole : ratio;  // planned whole, up to round-off
}

std::int64_t LbmEngine::fluid_steps() const
{
    const std::lock_guard lock(mutex_);
    return fluid_ ? fluid_->steps() : 0;
}

double LbmEngine::fluid_time() const
{
    const std::lock_guard lock(mutex_);
    return fluid_ ? fluid_->time() : 0.0;
}

}  // namespace yadelbm
