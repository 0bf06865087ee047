#include "lbm/fluid.hpp"

#include "facade/implementation.hpp"

namespace lbm {

Fluid::Fluid(const FluidConfig& config) : implementation_(std::make_unique<Implementation>(config)) {}
Fluid::~Fluid() = default;
Fluid::Fluid(Fluid&&) noexcept = default;
Fluid& Fluid::operator=(Fluid&&) noexcept = default;

const FluidConfig& Fluid::config() const noexcept { return implementation_->config; }
void Fluid::place_solids(const std::vector<Solid>& solids)
{
    implementation_->change("the map of solids", [&] { implementation_->place(solids); });
}
void Fluid::step(int count)
{
    implementation_->change("a step", [&] { implementation_->step(count); });
}
void Fluid::change_tau(double tau)
{
    implementation_->change("another tau", [&] { implementation_->change_tau(tau); });
}
void Fluid::change_faces(const std::array<FaceCondition, 6>& faces)
{
    implementation_->change("other faces", [&] { implementation_->change_faces(faces); });
}
const std::vector<SolidLoad>& Fluid::loads() const noexcept { return implementation_->loads; }
const std::vector<SolidLoad>& Fluid::film_loads(const std::vector<Solid>& solids, double dt)
{
    implementation_->change("the films between solids", [&] { implementation_->film_loads(solids, dt); });
    return implementation_->loads_of_films;
}
double Fluid::dt() const noexcept { return implementation_->dt; }
double Fluid::time() const noexcept { return implementation_->time(); }
std::int64_t Fluid::steps() const noexcept { return implementation_->steps; }
double Fluid::max_mach() const noexcept { return std::sqrt(implementation_->max_speed2) / kSpeedOfSound; }
StepTimes Fluid::times() const noexcept { return implementation_->times; }

std::size_t Fluid::memory_bytes() const { return implementation_->memory_bytes(); }

}  // namespace lbm
