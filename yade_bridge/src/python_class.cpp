#include "attributes.hpp"
#include "conversions.hpp"
#include "lbm_engine.hpp"

#include <boost/python/raw_function.hpp>

#include <cmath>
#include <stdexcept>

namespace yadelbm {
namespace {

namespace bp = boost::python;

constexpr const char* kDoc =
    "Resolved viscous fluid in a box, coupled both ways with the spheres and boxes of the scene.\n\n"
    "Put it before NewtonIntegrator in O.engines. The fluid comes into being, at rest, in the first step that YADE "
    "runs; "
    "plan() says before that what it will be and raises ValueError if it cannot be. All quantities are in SI units. "
    "Once the fluid exists its attributes are fixed but for boundaryVelocity, boundaryPressure, mask, ids and "
    "stopFile. Bodies may be added, erased or clumped at any time. "
    "dead=True freezes the fluid and takes its load away; dead=False lets it go on from where it stood.\n\n"
    "O.save and O.load keep the attributes; the fluid itself is not saved in this version and starts from rest in the "
    "first step after loading. Import yadelbm before loading a scene that holds an LbmEngine.";

/// Construction from keywords, as for every engine of YADE.
bp::object construct(const bp::tuple& args, const bp::dict& keywords)
{
    if (bp::len(args) > 1)
        throw std::invalid_argument("LbmEngine takes keyword arguments only, such as LbmEngine(dx=1e-3)");
    auto engine = boost::shared_ptr<LbmEngine>(new LbmEngine);
    if (bp::len(keywords) > 0) {
        engine->pyUpdateAttrs(keywords);
        engine->callPostLoad();
    }
    const bp::object initialize = bp::make_constructor(+[](boost::shared_ptr<LbmEngine> made) { return made; });
    return initialize(bp::object(args[0]), engine);
}

void set_checked(LbmEngine& engine, const Attribute& attribute, const bp::object& value)
{
    engine.change_settings(attribute.name, attribute.live, [&](Settings& settings) {
        attribute.set(settings, value);
        check_values(settings);
    });
}

lbm::Vec3 position(const bp::object& value)
{
    lbm::Vec3 result{};
    from_python("position", value, result);
    return result;
}

std::vector<int> shape(const LbmEngine& engine)
{
    const auto cells = engine.fluid_cells();
    return {cells[2], cells[1], cells[0]};
}

bp::object velocity(const LbmEngine& engine)
{
    std::vector<int> with_components = shape(engine);
    with_components.push_back(3);
    return numpy_array(engine.velocity_field(), with_components);
}

bp::tuple cells_tuple(const LbmEngine& engine)
{
    const auto cells = engine.fluid_cells();
    return bp::make_tuple(cells[0], cells[1], cells[2]);
}

/// To a path as a string or from pathlib.
void save_vtk(const LbmEngine& engine, const bp::object& path)
{
    const bp::object text = bp::import("os").attr("fspath")(path);
    engine.save_vtk(bp::extract<std::string>(text));
}

bp::dict stress(const LbmEngine& engine)
{
    const lbm::StressParts parts = engine.stress();
    const Settings& s = engine.settings();
    const double volume = (s.upper[0] - s.lower[0]) * (s.upper[1] - s.lower[1]) * (s.upper[2] - s.lower[2]);
    bp::dict result;
    result["fluid"] = to_python(parts.fluid);
    result["particles"] = to_python(parts.solids);
    result["contacts"] = bp::import("yade.utils").attr("getStress")(volume);
    result["total"] = result["fluid"] + result["particles"] + result["contacts"];
    return result;
}

using PythonClass =
    bp::class_<LbmEngine, boost::shared_ptr<LbmEngine>, bp::bases<yade::GlobalEngine>, boost::noncopyable>;

void define_attributes(PythonClass& python_class)
{
    using boost::mpl::vector2;
    using boost::mpl::vector3;
    for (const Attribute& attribute : attributes()) {
        const auto getter = [&attribute](const LbmEngine& engine) { return attribute.get(engine.settings()); };
        const auto setter = [&attribute](LbmEngine& engine, const bp::object& value) {
            set_checked(engine, attribute, value);
        };
        python_class.add_property(
            attribute.name,
            bp::make_function(getter, bp::default_call_policies(), vector2<bp::object, const LbmEngine&>()),
            bp::make_function(setter, bp::default_call_policies(), vector3<void, LbmEngine&, const bp::object&>()),
            attribute.doc);
    }
    python_class
        .add_property("fluidDt", &LbmEngine::fluid_dt, "Time step of the fluid [s]; NaN before it exists. Read-only.")
        .add_property("stepsPerFluidStep", &LbmEngine::steps_per_fluid_step,
                      "Steps of O.dt in one fluid step, not always whole; NaN before the fluid exists. Read-only.")
        .add_property("fluidSteps", &LbmEngine::fluid_steps, "Fluid steps done. Read-only.")
        .add_property("fluidTime", &LbmEngine::fluid_time, "Time that the fluid has covered [s]. Read-only.")
        .add_property("cells", &cells_tuple, "Cells along x, y, z. Read-only.");
}

void define_queries(PythonClass& python_class)
{
    python_class
        .def("plan", &LbmEngine::plan,
             "Checks the scene and plans the fluid's time step, without starting anything: a FluidPlan, to print or to "
             "ask. Raises ValueError with what is wrong.")
        .def(
            "suggestDx", &LbmEngine::suggest_dx,
            (bp::arg("self"), bp::arg("solidFraction") = Settings::kUnset,
             bp::arg("memory") = lbm::PlanRequest::kInfinity, bp::arg("seconds") = lbm::PlanRequest::kInfinity),
            "The largest dx [m] with which the drag of the smallest sphere is within `accuracy` and the box is a whole "
            "number "
            "of cells, at least 8 per diameter; the engine's own dx may still be unset. solidFraction: of the densest "
            "region, default that of the box, for a bed give the bed's. memory [bytes], seconds of wall-clock time per "
            "simulated second: what it may take; ValueError with what would fit if that is too little.")
        .def("suggestDt", &LbmEngine::suggest_dt,
             (bp::arg("self"), bp::arg("largest") = Settings::kUnset, bp::arg("seconds") = lbm::PlanRequest::kInfinity),
             "An O.dt [s] of which the longest fluid step within `accuracy` is a whole multiple. largest: what the "
             "contacts "
             "allow [s], default 0.3 utils.PWaveTimeStep(). seconds of wall-clock time per simulated second: what the "
             "fluid "
             "may take; ValueError with what would fit if that is too little.")
        .def(
            "fluidForce", +[](const LbmEngine& e, int id) { return to_python(e.load_on(id).force); },
            (bp::arg("self"), bp::arg("id")),
            "Force on a body in the last step of the grains, the mean of the fluid steps in it, buoyancy and films "
            "included "
            "[N]; ValueError if it was not in the fluid.")
        .def(
            "fluidTorque", +[](const LbmEngine& e, int id) { return to_python(e.load_on(id).torque); },
            (bp::arg("self"), bp::arg("id")), "Torque on a body about its centre in the last step of the grains [N m].")
        .def(
            "stresslet", +[](const LbmEngine& e, int id) { return to_python(e.load_on(id).stresslet); },
            (bp::arg("self"), bp::arg("id")),
            "Symmetric, traceless first moment of the traction on a body in the last fluid step [N m].")
        .def(
            "getVelocity",
            +[](const LbmEngine& e, const bp::object& at) { return to_python(e.velocity_at(position(at))); },
            (bp::arg("self"), bp::arg("pos")), "Velocity at a position, trilinear [m/s]; ValueError outside the box.")
        .def(
            "getPorePressure", +[](const LbmEngine& e, const bp::object& at) { return e.pressure_at(position(at)); },
            (bp::arg("self"), bp::arg("pos")),
            "Pressure at a position in excess of hydrostatic and drive, trilinear [Pa]; ValueError outside the box.")
        .def(
            "averageVelocity", +[](const LbmEngine& e) { return to_python(e.average_velocity()); },
            "Superficial velocity: mean over all cells, solid ones included [m/s].")
        .def("permeability", &LbmEngine::permeability,
             "Permeability for the drive, mu U.G / |G|^2 [m2], with G = density acceleration + the pressure drop per "
             "length "
             "between pressure faces that face each other; NaN without a drive.")
        .def(
            "getBoundaryFlux", &LbmEngine::boundary_flux, (bp::arg("self"), bp::arg("i")),
            "Volume of fluid per time that left the box through face i (0 to 5: xmin, xmax, ymin, ymax, zmin, zmax) in "
            "the last fluid step, positive outwards; through a periodic face too [m3/s].")
        .def(
            "getBoundaryForce", +[](const LbmEngine& e, int face) { return to_python(e.boundary_force(face)); },
            (bp::arg("self"), bp::arg("i")),
            "Force of the fluid on face i in the last fluid step [N], from the momentum exchanged over its links: "
            "viscous "
            "stress, pressure in excess of hydrostatic and drive, and the momentum of what flows through. Zero for a "
            "periodic face.")
        .def("totalMass", &LbmEngine::total_mass, "Mass of the lattice's fluid [kg].")
        .def(
            "totalMomentum", +[](const LbmEngine& e) { return to_python(e.total_momentum()); },
            "Momentum of the fluid and what is on its way to the grains [kg m/s], between steps or from an engine "
            "before "
            "NewtonIntegrator: the sum with the grains' own m v changes by drive, weight, walls and other engines "
            "only. "
            "An engine behind NewtonIntegrator would count the loads of its step twice.")
        .def(
            "stress", &stress,
            "Mean stress in the fluid's box [Pa], tension positive, as a dict of matrices: 'fluid' (pressure, viscous "
            "stress and momentum of all cells), 'particles' (first moments of the fluid's forces on the solids), "
            "'contacts' (utils.getStress over the volume of the box), and their 'total'. In a steady flow the total is "
            "the stress on the faces.")
        .def("kineticEnergy", &LbmEngine::kinetic_energy, "Kinetic energy of the fluid outside the solids [J].")
        .def("saveVtk", &save_vtk, (bp::arg("self"), bp::arg("path")),
             "Writes velocity, pressure and solid fraction as VTK image data (.vti) that ParaView opens.")
        .add_property("velocity", &velocity, "Velocities, a NumPy array of shape (nz, ny, nx, 3) [m/s]; a copy.")
        .add_property(
            "pressure", +[](const LbmEngine& e) { return numpy_array(e.pressure_field(), shape(e)); },
            "Pressures in excess of hydrostatic and drive, a NumPy array of shape (nz, ny, nx) [Pa]; a copy.")
        .add_property(
            "solidFraction", +[](const LbmEngine& e) { return numpy_array(e.solid_fraction_field(), shape(e)); },
            "Solid fractions, a NumPy array of shape (nz, ny, nx) [-]; a copy.");
}

}  // namespace

void LbmEngine::change_settings(const char* name, bool live, const std::function<void(Settings&)>& change)
{
    const std::lock_guard lock(mutex_);
    if (fluid_ && !live)
        throw std::runtime_error(std::string("LbmEngine.") + name +
                                 " cannot be changed any more: the fluid exists since the first step. Make a new "
                                 "LbmEngine, or set it before the first step");
    Settings changed = settings_;
    change(changed);
    if (fluid_ && (changed.boundary_velocity != settings_.boundary_velocity ||
                   changed.boundary_pressure != settings_.boundary_pressure)) {
        check(changed, true);
        fluid_->change_faces(face_conditions(changed));
    }
    settings_ = changed;
    selection_changed_ = true;
}

void LbmEngine::pySetAttr(const std::string& key, const bp::object& value)
{
    if (const Attribute* attribute = find_attribute(key)) set_checked(*this, *attribute, value);
    else GlobalEngine::pySetAttr(key, value);
}

bp::dict LbmEngine::pyDict() const
{
    bp::dict result;
    for (const Attribute& attribute : attributes()) result[attribute.name] = attribute.get(settings_);
    result.update(GlobalEngine::pyDict());
    return result;
}

void LbmEngine::callPostLoad()
{
    check(settings_, false);
    GlobalEngine::callPostLoad();
}

void LbmEngine::pyRegisterClass(bp::object scope)
{
    checkPyClassRegistersItself("LbmEngine");
    const bp::scope here(scope);
    const bp::docstring_options docstrings(true, false, false);
    PythonClass python_class("LbmEngine", kDoc, bp::no_init);
    python_class.def("__init__", bp::raw_function(&construct, 1));
    define_attributes(python_class);
    define_queries(python_class);
}

}  // namespace yadelbm
