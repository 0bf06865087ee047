// What an LbmEngine says about steps and cells before anything runs.

#include "lbm_engine.hpp"

#include "grains.hpp"
#include "planning.hpp"

#include "lbm/errors.hpp"

#include <core/Omega.hpp>
#include <core/Scene.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace yadelbm {

/// Cell updates per second of the fluid so far; 0 while there are too few steps to say.
double LbmEngine::throughput() const
{
    constexpr int kEnoughSteps = 20;
    if (!fluid_ || fluid_->steps() < kEnoughSteps) return 0;
    const lbm::StepTimes times = fluid_->times();
    const auto n = fluid_cells();
    return double(n[0]) * n[1] * n[2] * static_cast<double>(fluid_->steps()) /
           (times.map + times.exchange + times.collide_stream + times.loads);
}

double LbmEngine::suggest_dx(double solid_fraction, double memory, double seconds) const
{
    const std::lock_guard lock(mutex_);
    const yade::Scene& now = *Singleton<yade::Omega>::instance().getScene();
    Settings s = settings_;
    s.dx = Settings::kUnset;
    std::vector<lbm::Solid> solids;
    read_solids(now, {s.mask, s.ids}, solids);
    check_selection(s, solids);
    lbm::Vec3 lengths{};
    double box = 1, occupied = 0;
    for (int d = 0; d < 3; ++d) box *= lengths[d] = s.upper[d] - s.lower[d];
    for (const lbm::Solid& solid : solids) occupied += 4.0 / 3 * std::acos(-1.0) * std::pow(solid.radius, 3);
    lbm::PlanRequest request = plan_request(now, s, solids);
    request.throughput = throughput();
    if (std::isnan(solid_fraction)) solid_fraction = solids.size() > 1 ? std::min(occupied / box, 0.7) : 0;
    return lbm::suggest_dx(request, lengths, solid_fraction, {memory, seconds});
}

double LbmEngine::suggest_dt(double largest, double seconds) const
{
    const std::lock_guard lock(mutex_);
    const yade::Scene& now = *Singleton<yade::Omega>::instance().getScene();
    check(settings_, true);
    std::vector<lbm::Solid> solids;
    read_solids(now, {settings_.mask, settings_.ids}, solids);
    check_selection(settings_, solids);
    if (std::isnan(largest)) largest = 0.3 * critical_time_step();
    if (!std::isfinite(largest))
        throw lbm::ConfigError(
            "largest: no stable time step of the contacts is known (utils.PWaveTimeStep() finds no elastic "
            "material): give the largest O.dt that they allow, suggestDt(largest=...)");
    lbm::PlanRequest request = plan_request(now, settings_, solids);
    request.throughput = throughput();
    return lbm::suggest_dt(request, largest, {lbm::PlanRequest::kInfinity, seconds});
}

FluidPlan LbmEngine::plan() const
{
    const std::lock_guard lock(mutex_);
    const yade::Scene& now = *Singleton<yade::Omega>::instance().getScene();
    std::vector<lbm::Solid> solids;
    read_solids(now, {settings_.mask, settings_.ids}, solids);
    check_scene(now, settings_, solids);
    check_lubrication(settings_, lubrication_law(now));
    lbm::PlanRequest request = plan_request(now, settings_, solids);
    if (fluid_) {
        request.tau = fluid_->config().tau;
        request.why_tau = "that of the running fluid";
    }
    request.throughput = throughput();
    request.contact_frequency = contact_frequency(now, solids);
    FluidPlan plan{lbm::plan_time_step(request), fluid_cells()};
    const lbm::FluidConfig config = fluid_config(settings_, plan.tau, 0);
    if (!fluid_) lbm::Fluid::check(config);  // one that is there need not fit once more
    std::vector<std::string> warnings = scene_warnings(now, settings_, solids);
    for (std::string& warning : fluid_warnings(config, solids)) warnings.push_back(std::move(warning));
    for (const std::string& warning : warnings) {
        plan.warnings.push_back(warning);
        if (!plan.report.empty() && plan.report.back() != '\n') plan.report += '\n';
        plan.report += "  warning: " + warning + '\n';
    }
    return plan;
}

}  // namespace yadelbm
