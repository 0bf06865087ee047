#include "planning.hpp"

#include "lbm_engine.hpp"
#include "text.hpp"

#include "lbm/errors.hpp"
#include "lbm/overlap.hpp"

#include <core/Scene.hpp>

#include <boost/python.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

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

/// False only for a solid that surely lies outside of the box.
bool may_reach_into(const Settings& s, const lbm::Solid& solid)
{
    const auto& h = solid.half_extents;
    const double reach =
        solid.shape == lbm::Shape::box ? std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]) : solid.radius;
    for (int d = 0; d < 3; ++d)
        if (s.boundary[2 * d] != "periodic" &&
            (solid.position[d] + reach < s.lower[d] || solid.position[d] - reach > s.upper[d]))
            return false;
    return true;
}

double sphere_volume(double radius) { return 4 * std::acos(-1.0) / 3 * std::pow(radius, 3); }

/// Of a free body that is alone; lighter ones follow the fluid unstably (docs/physics.md, "Loads").
constexpr double kLightest = 0.1;

/// The same of free bodies less than about a cell apart.
double lightest_of_many(double tau) { return std::max(0.2, 0.5 * (tau - 0.5)); }

/// Of a free body; of a member of a clump, that of the clump over its own volume, which is more.
double density_ratio(double fluid_density, const lbm::Solid& solid)
{
    const auto& h = solid.half_extents;
    const double volume = solid.shape == lbm::Shape::box ? 8 * h[0] * h[1] * h[2] : sphere_volume(solid.radius);
    return solid.mass / (volume * fluid_density);
}

void warn_about_light_bodies(const lbm::FluidConfig& config, const std::vector<lbm::Solid>& solids,
                             std::vector<std::string>& warnings)
{
    const auto ratio_of = [&](const lbm::Solid& solid) { return density_ratio(config.density, solid); };
    const auto lightest = std::min_element(solids.begin(), solids.end(), [&](const lbm::Solid& a, const lbm::Solid& b) {
        return ratio_of(a) < ratio_of(b);
    });
    if (lightest == solids.end()) return;
    const double ratio = ratio_of(*lightest), limit = lightest_of_many(config.tau);
    const std::string body =
        "Body " + std::to_string(lightest->id) + " has " + text(ratio) + " times the density of the fluid";
    const auto is_another = [&](const lbm::Solid& other) {
        return std::isfinite(other.mass) && other.id != lightest->id &&
               (other.body < 0 || other.body != lightest->body);
    };
    if (ratio < kLightest)
        warnings.push_back(body + " (" + text(ratio * config.density) + " kg/m3): free bodies are not stable below " +
                           text(kLightest) + " times; is the density of its material in kg/m3?");
    else if (ratio < limit && std::any_of(solids.begin(), solids.end(), is_another))
        warnings.push_back(body + ": where free bodies are less than about a cell apart they may be unstable below " +
                           text(limit) + " times with tau = " + text(config.tau) +
                           (ratio > lightest_of_many(0)
                                ? "; use tau <= " + text(0.5 + 2 * ratio)
                                : ", and below " + text(lightest_of_many(0)) + " with any tau"));
}

/// Relative difference from which on the mass of a clump is worth a warning.
constexpr double kWrongMass = 0.005;

/// YADE adds up the masses of the members unless it is asked for better, and buoyancy acts on their union.
void warn_about_masses_of_clumps(const yade::Scene& scene, const std::vector<lbm::Solid>& solids,
                                 std::vector<std::string>& warnings)
{
    std::map<std::int64_t, std::vector<lbm::Solid>> clumps;
    for (const lbm::Solid& solid : solids)
        if (solid.body >= 0 && std::isfinite(solid.mass)) clumps[solid.body].push_back(solid);
    int found = 0;
    std::string worst;
    double worst_off = 0;
    for (const auto& [id, members] : clumps) {
        if (!std::all_of(members.begin(), members.end(),
                         [](const lbm::Solid& s) { return s.shape == lbm::Shape::sphere; }))
            continue;
        double sum = 0, lightest = std::numeric_limits<double>::infinity(), heaviest = 0;
        for (const lbm::Solid& member : members) {
            sum += sphere_volume(member.radius);
            const bp::object body(scene.bodies->body[static_cast<std::size_t>(member.id)]);
            const double density = bp::extract<double>(bp::getattr(body.attr("material"), "density", bp::object(0.0)));
            lightest = std::min(lightest, density);
            heaviest = std::max(heaviest, density);
        }
        const double volume = lbm::union_volume(members), density = members.front().mass / volume;
        if (sum < (1 + kWrongMass) * volume || !(lightest > 0)) continue;
        const double off = std::max(density / heaviest, lightest / density) - 1;
        if (off <= kWrongMass) continue;
        ++found;
        if (off <= worst_off) continue;
        worst_off = off;
        worst = "Clump " + std::to_string(id) + " weighs " + text(members.front().mass) + " kg, and the " +
                text(volume) + " m3 that its overlapping members fill would weigh " + text(lightest * volume) +
                (heaviest > lightest ? " to " + text(heaviest * volume) : "");
    }
    if (found == 0) return;
    warnings.push_back(worst + " kg by the density of its material" +
                       (found > 1 ? " (the worst of " + std::to_string(found) + " such clumps)" : "") +
                       ": it sinks with the wrong weight; O.bodies.updateClumpProperties(discretization=50) "
                       "finds mass and inertia of the union.");
}

/// More than a cell from all faces of the fluid's box, as far as it is about these axes.
bool is_well_inside(const Settings& s, const yade::Vector3r& position, const std::vector<int>& axes)
{
    return std::all_of(axes.begin(), axes.end(),
                       [&](int d) { return position[d] > s.lower[d] + s.dx && position[d] < s.upper[d] - s.dx; });
}

/// Bodies that fluid flows through, though it may not be meant; those that were chosen by ids are.
void warn_about_other_shapes(const yade::Scene& scene, const Settings& s, std::vector<std::string>& warnings)
{
    if (!s.ids.empty()) return;
    std::map<std::string, std::pair<int, int>> found;  // of each shape: the first body, how many
    for (const auto& body : scene.bodies->body) {
        if (!body || !body->shape || !body->state || body->isClump()) continue;
        if (s.mask != 0 && s.mask != -1 && (body->groupMask & s.mask) == 0) continue;
        const std::string shape = body->shape->getClassName();
        if (shape == "Sphere" || shape == "Box") continue;
        std::vector<int> axes{0, 1, 2};
        if (shape == "Wall") axes = {bp::extract<int>(bp::object(body).attr("shape").attr("axis"))};
        if (!is_well_inside(s, body->state->se3.position, axes)) continue;
        ++found.try_emplace(shape, body->id, 0).first->second.second;
    }
    for (const auto& [shape, bodies] : found)
        warnings.push_back("Bodies of shape " + shape + " stand in the fluid (" + std::to_string(bodies.second) +
                           ", the first is " + std::to_string(bodies.first) +
                           "), which does not see them: only spheres and boxes are solids in it.");
}

/// Mass that answers to a force on the body; infinite for one that is blocked.
double inverse_mass(const bp::object& body)
{
    const bp::object state = body.attr("state");
    const std::string blocked = bp::extract<std::string>(state.attr("blockedDOFs"));
    const double mass = bp::extract<double>(state.attr("mass"));
    const bool free =
        blocked.find_first_of("xyz") == std::string::npos && bool(bp::extract<bool>(body.attr("dynamic")));
    return free && mass > 0 ? 1 / mass : 0;
}

double frequency_of_contacts(const bp::object& omega)
{
    double largest2 = 0;
    const bp::object bodies = omega.attr("bodies");
    const bp::list contacts(omega.attr("interactions"));
    for (bp::ssize_t i = 0; i < bp::len(contacts); ++i) {
        const bp::object contact = contacts[i];
        if (!bp::extract<bool>(contact.attr("isReal"))) continue;
        const bp::object stiffness = bp::getattr(contact.attr("phys"), "kn", bp::object());
        if (stiffness.is_none()) continue;
        const double inverse = inverse_mass(bodies[contact.attr("id1")]) + inverse_mass(bodies[contact.attr("id2")]);
        largest2 = std::max(largest2, bp::extract<double>(stiffness) * inverse);
    }
    return std::sqrt(largest2);
}

void warn_about_overlaps(const lbm::FluidConfig& config, const std::vector<lbm::Solid>& solids,
                         std::vector<std::string>& warnings)
{
    const lbm::Overlaps found = lbm::overlaps(config, solids);
    if (found.pairs == 0) return;
    const std::string one = std::to_string(found.one), other = std::to_string(found.other);
    warnings.push_back("Spheres " + one + " and " + other + " share " + text(std::round(1e3 * found.shared) / 10) +
                       " % of the smaller one's volume" +
                       (found.pairs > 1 ? " (the most of " + std::to_string(found.pairs) + " pairs)" : "") +
                       " and are not one clump: it counts twice, in buoyancy and in the resistance to the flow; clump "
                       "them, O.bodies.clump([" +
                       one + ", " + other + "]), or leave one of them out with mask or ids.");
}

}  // namespace

std::vector<std::string> fluid_warnings(const lbm::FluidConfig& config, const std::vector<lbm::Solid>& solids)
{
    std::vector<std::string> warnings;
    warn_about_light_bodies(config, solids, warnings);
    warn_about_overlaps(config, solids, warnings);
    return warnings;
}

double contact_frequency(const yade::Scene& scene, const std::vector<lbm::Solid>& solids)
{
    const bool contacts = std::any_of(scene.engines.begin(), scene.engines.end(), [](const auto& engine) {
        return engine && engine->getClassName() == "InteractionLoop";
    });
    if (!contacts) return 0;
    const bp::object omega = bp::import("yade.wrapper").attr("Omega")();
    const double found = frequency_of_contacts(omega);
    if (found > 0) return found;
    double largest2 = 0;
    for (const lbm::Solid& solid : solids) {
        const auto& body = scene.bodies->body[static_cast<std::size_t>(solid.id)];
        if (!std::isfinite(solid.mass) || !body) continue;
        const bp::object material = bp::object(body).attr("material");
        const bp::object young = bp::getattr(material, "young", bp::object());
        if (young.is_none()) continue;
        largest2 = std::max(largest2, 2 * bp::extract<double>(young) * solid.radius / solid.mass);
    }
    return std::sqrt(largest2);
}

double critical_time_step() { return bp::extract<double>(bp::import("yade.utils").attr("PWaveTimeStep")()); }

std::string lubrication_law(const yade::Scene& scene)
{
    const auto& engines = scene._nextEngines.empty() ? scene.engines : scene._nextEngines;
    for (const auto& engine : engines) {
        if (!engine || engine->dead || engine->getClassName() != "InteractionLoop") continue;
        const bp::object functors = bp::object(engine).attr("lawDispatcher").attr("functors");
        for (bp::ssize_t i = 0; i < bp::len(functors); ++i) {
            std::string name = bp::extract<std::string>(functors[i].attr("__class__").attr("__name__"));
            if (name.find("Lubrication") != std::string::npos) return name;
        }
    }
    return {};
}

void check_lubrication(const Settings& s, const std::string& law)
{
    if (!s.lubrication || law.empty()) return;
    std::string text = "LbmEngine.lubrication = True while ";
    text += law;
    text +=
        " in the InteractionLoop has lubrication of its own: the force of narrow gaps would count twice; use another "
        "contact law, or lubrication=False to leave narrow gaps to this one";
    throw lbm::ConfigError(text);
}

std::vector<std::string> scene_warnings(const yade::Scene& scene, const Settings& s,
                                        const std::vector<lbm::Solid>& solids)
{
    std::vector<std::string> warnings;
    if (std::none_of(solids.begin(), solids.end(), [&](const lbm::Solid& solid) { return may_reach_into(s, solid); }))
        warnings.push_back("No body is in the fluid's box, " + text(s.lower) + " to " + text(s.upper) +
                           " m: have they the same origin, and are all lengths in metres?");
    warn_about_masses_of_clumps(scene, solids, warnings);
    warn_about_other_shapes(scene, s, warnings);
    bool behind_fluid = false;
    for (const auto& other : scene.engines) {
        if (!other) continue;
        const std::string name = other->getClassName();
        if (name == "NewtonIntegrator") warn_about_integrator(bp::object(other), s, warnings);
        if (name.ends_with("TimeStepper") && behind_fluid)
            warnings.emplace_back(
                name +
                " stands behind LbmEngine: where it lengthens O.dt, loads and films push too hard for that step; "
                "put it before.");
        behind_fluid = behind_fluid || dynamic_cast<const LbmEngine*>(other.get());
    }
    const bool periodic_fluid = std::find(s.boundary.begin(), s.boundary.end(), "periodic") != s.boundary.end();
    if (periodic_fluid && !scene.isPeriodic)
        warnings.emplace_back(
            "The fluid is periodic and the scene is not: grains feel the fluid across a periodic face and "
            "do not touch across it.");
    const std::string law = lubrication_law(scene);
    if (!law.empty())
        warnings.emplace_back(law +
                              " adds the whole lubrication force of a gap, also the part that the lattice resolves: "
                              "in gaps above half a cell the sum is too high.");
    return warnings;
}

}  // namespace yadelbm
