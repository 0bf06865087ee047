#include "attributes.hpp"

#include "conversions.hpp"

#include <algorithm>

namespace yadelbm {
namespace {

template <auto member>
boost::python::object get(const Settings& settings)
{
    return to_python(settings.*member);
}

}  // namespace

// get and set of one member under its Python name; a lambda per attribute carries the name into error messages
#define YADELBM_ATTRIBUTE(name, member, live, doc)                                                                     \
    Attribute                                                                                                          \
    {                                                                                                                  \
        name, doc, live, &get<&Settings::member>, [](Settings& settings, const boost::python::object& value) {         \
            from_python("LbmEngine." name, value, settings.member);                                                    \
        }                                                                                                              \
    }

const std::vector<Attribute>& attributes()
{
    static const std::vector<Attribute> table{
        YADELBM_ATTRIBUTE("lower", lower, false, "Lower corner of the fluid's box [m]."),
        YADELBM_ATTRIBUTE("upper", upper, false,
                          "Upper corner of the fluid's box [m]; the box is a whole number of cells along every axis."),
        YADELBM_ATTRIBUTE("dx", dx, false, "Cell size [m], > 0; a sphere's radius is at least two cells, better four."),
        YADELBM_ATTRIBUTE("density", density, false, "Density of the fluid [kg/m3], > 0."),
        YADELBM_ATTRIBUTE("viscosity", viscosity, false, "Dynamic viscosity [Pa s], > 0."),
        YADELBM_ATTRIBUTE("gravity", gravity, false,
                          "Gravity of the fluid [m/s2], default 0: gives the spheres their buoyancy, -density volume "
                          "gravity. The hydrostatic pressure is left out of the fields. Use the integrator's value."),
        YADELBM_ATTRIBUTE("acceleration", acceleration, false,
                          "Uniform drive [m/s2], default 0: a mean pressure gradient of -density acceleration."),
        YADELBM_ATTRIBUTE("initialVelocity", initial_velocity, false,
                          "Velocity of all fluid at the start [m/s], default 0. In a stream between a velocity and a "
                          "pressure face, that of the stream: no wave of sound runs through the box then."),
        YADELBM_ATTRIBUTE(
            "boundary", boundary, false,
            "What the faces xmin, xmax, ymin, ymax, zmin, zmax of the box are: six of 'periodic' (both "
            "faces of a pair), 'noSlip', 'freeSlip' (no friction, a plane of symmetry), 'velocity' "
            "(fluid enters or leaves with boundaryVelocity) and 'pressure' (it enters or leaves along the "
            "normal at boundaryPressure); default 'noSlip'. Box bodies of the scene are solids in the fluid; "
            "its walls and facets are not seen by it."),
        YADELBM_ATTRIBUTE(
            "boundaryVelocity", boundary_velocity, true,
            "Velocities of the six faces [m/s], default 0: of a velocity face, in any direction; a noSlip face with "
            "one is a wall that moves in its own plane. May be changed at any time, all six at once: what is read is a "
            "copy."),
        YADELBM_ATTRIBUTE(
            "boundaryPressure", boundary_pressure, true,
            "Pressures of the six faces [Pa], default 0, where they are pressure faces: in excess of "
            "hydrostatic and drive, as getPorePressure gives them. Of fluid that enters, the pressure where "
            "it was at rest. May be changed at any time, all six at once: what is read is a copy."),
        YADELBM_ATTRIBUTE("tau", tau, false,
                          "Relaxation time [fluid steps], sets the fluid's time step (tau - 1/2) dx^2 density / (3 "
                          "viscosity). NaN, the default: chosen so that this is a whole number of steps of O.dt where "
                          "the limits allow, and chosen again "
                          "where O.dt changes by more than a quarter."),
        YADELBM_ATTRIBUTE(
            "magicParameter", magic_parameter, false,
            "Lambda of the two relaxation times [-], 0.01 to 0.5. NaN, the default: the scheme's own, 1/8."),
        YADELBM_ATTRIBUTE("inertia", inertia, false,
                          "False: Stokes flow, the quadratic terms are dropped. Default True."),
        YADELBM_ATTRIBUTE(
            "scheme", scheme, false,
            "Coupling of fluid and solids: 'exact' (default), independent of tau in Stokes flow; for comparison "
            "'nobleTorczynski', 'nobleTorczynskiLinear', 'superposition', 'bounceBack'."),
        YADELBM_ATTRIBUTE("collision", collision, false,
                          "Collision operator: 'trt' (default) or, for comparison, 'bgk'."),
        YADELBM_ATTRIBUTE(
            "lattice", lattice, false,
            "Velocity set: 'D3Q19' (default), or 'D3Q27', which is more isotropic and takes half as much again in "
            "time and memory."),
        YADELBM_ATTRIBUTE("storage", storage, false, "How populations are kept: 'double' (default) or 'single'."),
        YADELBM_ATTRIBUTE(
            "mask", mask, true,
            "Bodies are in the fluid if their mask shares a bit with this; 0 (default) or -1: all. May be "
            "changed at any time."),
        YADELBM_ATTRIBUTE("ids", ids, true,
                          "Ids of the bodies in the fluid; empty (default): all. May be changed at any time."),
        YADELBM_ATTRIBUTE(
            "lubrication", lubrication, false,
            "Adds what the lattice does not resolve of gaps below one cell between spheres, and below 2.9 cells "
            "between "
            "spheres and noSlip faces: forces and torques of approach, sliding and rolling. Default True; "
            "False where a contact law has its own lubrication."),
        YADELBM_ATTRIBUTE("lubricationRoughness", lubrication_roughness, false,
                          "Gap below which lubrication gets no stronger, in radii of the smaller sphere [-], 1e-6 to "
                          "0.1, default 1e-3: the height of what is rough on real grains."),
        YADELBM_ATTRIBUTE("maxMach", max_mach, false,
                          "Largest Mach number on the lattice [-], default 0.2; a run that goes beyond it stops."),
        YADELBM_ATTRIBUTE("accuracy", accuracy, false,
                          "Estimated error [-] up to which the cheapest time step is chosen where tau is NaN, and that "
                          "suggestDx and suggestDt aim at; default 0.02. plan() shows what it is made of."),
        YADELBM_ATTRIBUTE(
            "stopFile", stop_file, true,
            "Where the state is written when the fluid stops a run by itself (a flow that diverges or is too "
            "fast), VTK image data, default 'lbm-stopped.vti' in the working directory; '': nowhere."),
        YADELBM_ATTRIBUTE("ranks", ranks, false, "0, the fluid in this process, is supported today."),
    };
    return table;
}

#undef YADELBM_ATTRIBUTE

const Attribute* find_attribute(const std::string& name)
{
    const auto& table = attributes();
    const auto found =
        std::find_if(table.begin(), table.end(), [&](const Attribute& attribute) { return name == attribute.name; });
    return found == table.end() ? nullptr : &*found;
}

}  // namespace yadelbm
