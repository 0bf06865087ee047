#include "planning.hpp"

#include "lbm_engine.hpp"
#include "text.hpp"

#include <core/Scene.hpp>

#include <boost/python.hpp>

#include <algorithm>

namespace yadelbm {
namespace {

namespace bp = boost::python;

/// Asked through Python: the integrator's own layout need not be known.
void warn_about_integrator(const bp::object& integrator, const Settings& s, std::vector<std::string>& warnings)
{
    const double damping = bp::extract<double>(integrator.attr("damping"));
    if (damping != 0)
        warnings.emplace_back("NewtonIntegrator.damping = " + text(damping) +
                              " also damps what the fluid does to the grains: set it to 0.");
    const yade::Vector3r g = bp::extract<yade::Vector3r>(integrator.attr("gravity"));
    const lbm::Vec3 gravity{g[0], g[1], g[2]};
    if (gravity != s.gravity)
        warnings.emplace_back("NewtonIntegrator.gravity = " + text(gravity) + " and LbmEngine.gravity = " +
                              text(s.gravity) + " differ: weight and buoyancy of a grain do not belong together.");
}

}  // namespace

std::vector<std::string> scene_warnings(const yade::Scene& scene, const Settings& s)
{
    std::vector<std::string> warnings;
    for (const auto& other : scene.engines) {
        if (!other) continue;
        if (other->getClassName() == "NewtonIntegrator") warn_about_integrator(bp::object(other), s, warnings);
    }
    const bool periodic_fluid = std::find(s.boundary.begin(), s.boundary.end(), "periodic") != s.boundary.end();
    if (periodic_fluid && !scene.isPeriodic)
        warnings.emplace_back(
            "The fluid is periodic and the scene is not: grains feel the fluid across a periodic face and "
            "do not touch across it.");
    return warnings;
}

}  // namespace yadelbm
