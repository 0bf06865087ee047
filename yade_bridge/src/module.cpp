#include "layout_check.hpp"
#include "layout_probe.hpp"
#include "lbm_engine.hpp"

#include "conversions.hpp"

#ifdef YADELBM_OWN_DECLARATIONS
#include <declared_version.hpp>
#endif

namespace {

namespace bp = boost::python;

#ifdef YADELBM_OWN_DECLARATIONS
const std::string kDeclared = yade::kDeclaredVersion;
#else
const std::string kDeclared = "that of the YADE source tree it was built with";
#endif

bp::list warnings(const yadelbm::FluidPlan& plan)
{
    bp::list list;
    for (const std::string& warning : plan.warnings) list.append(warning);
    return list;
}

/// Rows of the ranking, best first.
bp::list ranking(const yadelbm::FluidPlan& plan)
{
    bp::list list;
    for (const lbm::StepEstimate& e : plan.ranking) {
        bp::dict row;
        row["tau"] = e.tau;
        row["fluidDt"] = e.fluid_dt;
        row["stepsPerFluidStep"] = e.steps_per_fluid_step;
        row["mach"] = e.mach;
        row["estimatedError"] = e.estimated_error;
        row["cost"] = e.cost;
        list.append(row);
    }
    return list;
}

bp::tuple cells(const yadelbm::FluidPlan& plan) { return bp::make_tuple(plan.cells[0], plan.cells[1], plan.cells[2]); }

void define_plan()
{
    using Plan = yadelbm::FluidPlan;
    bp::class_<Plan>("FluidPlan", "A time step of the fluid that fits the grains' own, and what it means; print it.",
                     bp::no_init)
        .def_readonly("tau", &Plan::tau, "Relaxation time [fluid steps].")
        .def_readonly("fluidDt", &Plan::fluid_dt, "Time step of the fluid [s].")
        .def_readonly("stepsPerFluidStep", &Plan::steps_per_fluid_step, "Steps of O.dt in one fluid step.")
        .def_readonly("mach", &Plan::mach, "Mach number on the lattice at the expected speed [-].")
        .def_readonly("reynolds", &Plan::reynolds, "Reynolds number of a mean grain at the expected speed [-].")
        .def_readonly("cellsPerDiameter", &Plan::cells_per_diameter, "Cells per diameter of the smallest sphere.")
        .def_readonly("motionPerStep", &Plan::motion_per_step, "Motion of a surface per fluid step [cells].")
        .def_readonly("compressibilityError", &Plan::compressibility_error, "Relative density change, Ma^2 [-].")
        .def_readonly("staticCompression", &Plan::static_compression,
                      "Relative density change by the pressure at rest that the lattice carries [-].")
        .def_readonly("transientError", &Plan::transient_error,
                      "Estimated error of motion within the grains' response time [-].")
        .def_readonly("estimatedError", &Plan::estimated_error,
                      "Sum of compressibilityError, staticCompression and transientError [-].")
        .def_readonly("contactPhase", &Plan::contact_phase,
                      "Frequency of the stiffest contact times the fluid step [-]; 0 if not known.")
        .def_readonly("viscousTime", &Plan::viscous_time, "R^2 / nu of the smallest sphere [s].")
        .def_readonly("acousticTime", &Plan::acoustic_time, "Sound on the lattice crosses the box in this time [s].")
        .def_readonly("cost", &Plan::cost, "Estimated seconds of wall-clock time per simulated second.")
        .add_property("ranking", &ranking, "What was compared, best first: a list of dictionaries.")
        .def_readonly("shortestTransient", &Plan::shortest_transient, "Times above this are resolved to 1 % [s].")
        .add_property("cells", &cells, "Cells along x, y, z.")
        .def_readonly("memory", &Plan::memory_bytes, "Memory of the fluid [bytes].")
        .add_property("warnings", &warnings, "What may go wrong, a list of sentences.")
        .def_readonly("report", &Plan::report, "All of it as text.")
        .def(
            "__str__", +[](const Plan& plan) { return plan.report; })
        .def(
            "__repr__", +[](const Plan& plan) { return plan.report; });
}

/// Nothing of YADE is touched, and no class registered, before the layout was found right.
void refuse_other_layouts()
{
    try {
        yadelbm::check_layout();
    } catch (const yadelbm::LayoutMismatch& mismatch) {
        const std::string found = bp::extract<std::string>(bp::str(bp::import("yade.config").attr("version")));
        const std::string message =
            "yadelbm cannot be used with this YADE: its objects in memory are not laid out as declared. YADE found: " +
            found + "; declared: " + kDeclared + ". First difference: " + mismatch.what() +
            ". Way out: install the YADE that is declared, or build yadelbm against the sources of this YADE (cmake "
            "-DYADE_SOURCE_DIR=...). YADE itself is not affected and goes on without the fluid.";
        PyErr_SetString(PyExc_ImportError, message.c_str());
        bp::throw_error_already_set();
    }
}

void define_module()
{
    const bp::docstring_options docstrings(true, false, false);
    define_plan();
    yadelbm::LbmEngine().pyRegisterClass(bp::scope());
}

}  // namespace

/// What BOOST_PYTHON_MODULE would write, except that an exception makes the import fail instead of being passed over.
extern "C" BOOST_SYMBOL_EXPORT PyObject* PyInit__yadelbm()  // NOLINT(bugprone-reserved-identifier)
{
    static PyModuleDef definition = {
        PyModuleDef_HEAD_INIT, "_yadelbm", nullptr, -1, nullptr, nullptr, nullptr, nullptr, nullptr};
    if (bp::handle_exception(&refuse_other_layouts)) return nullptr;
    PyObject* module = bp::detail::init_module(definition, &define_module);
    if (module && PyErr_Occurred()) {
        Py_DECREF(module);
        return nullptr;
    }
    return module;
}
