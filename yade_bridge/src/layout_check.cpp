#include "layout_check.hpp"

#include "layout_probe.hpp"
#include "lbm_engine.hpp"

#ifdef YADELBM_OWN_DECLARATIONS
#include <layout_assertions.hpp>
#endif

#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>

#include <dlfcn.h>
#include <link.h>

#include <cstddef>
#include <cstdint>
#include <new>

// offsetof works for these classes with GCC and Clang: no virtual bases
#pragma GCC diagnostic ignored "-Winvalid-offsetof"

/// Compares a member of an object with its sentinel.
#define REQUIRE_MEMBER(probe, Class, member, object, expected)                                                         \
    (probe).require(#Class "." #member, object, offsetof(yade::Class, member), expected)

namespace yadelbm {
namespace {

namespace bp = boost::python;
using Vec3 = lbm::Vec3;

/// The C++ object in a Python one; YADE's own conversion, no layout involved.
template <class T>
T* native(const bp::object& object)
{
    return &static_cast<T&>(bp::extract<T&>(object));
}

bp::object vector3(const Vec3& v) { return bp::import("yade.minieigenHP").attr("Vector3")(v[0], v[1], v[2]); }

/// Where a virtual function stands in the table, as the declarations have it (Itanium C++ ABI: 1 + offset).
template <class MemberFunction>
std::size_t declared_slot(MemberFunction function)
{
    std::ptrdiff_t parts[2];
    static_assert(sizeof function == sizeof parts);
    std::memcpy(parts, &function, sizeof parts);
    return static_cast<std::size_t>(parts[0] - 1) / sizeof(void*);
}

std::size_t table_size(const char* name, const void* first_function)
{
    Dl_info info;
    ElfW(Sym)* symbol = nullptr;
    if (dladdr1(first_function, &info, reinterpret_cast<void**>(&symbol), RTLD_DL_SYMENT) == 0 || !symbol)
        LayoutProbe::mismatch(std::string("virtual functions of ") + name + ": no exported table");
    return symbol->st_size;
}

void check_virtual_functions(const LayoutProbe& probe)
{
    const auto* table = static_cast<void* const*>(dlsym(RTLD_DEFAULT, "_ZTVN4yade12GlobalEngineE"));
    if (!table) LayoutProbe::mismatch("virtual functions of GlobalEngine: no exported table");
    table += 2;  // offset to top, type information
    const struct {
        const char* name;
        std::size_t slot;
        const char* symbol;
    } expected[] = {
        {"Engine::isActivated", declared_slot(&yade::Engine::isActivated), "_ZN4yade6Engine11isActivatedEv"},
        {"Engine::action", declared_slot(&yade::Engine::action), "_ZN4yade6Engine6actionEv"},
        {"GlobalEngine::callPostLoad", declared_slot(&yade::Serializable::callPostLoad),
         "_ZN4yade12GlobalEngine12callPostLoadEv"},
        {"GlobalEngine::pyDict", declared_slot(&yade::Serializable::pyDict), "_ZNK4yade12GlobalEngine6pyDictEv"},
        {"GlobalEngine::pyRegisterClass", declared_slot(&yade::Serializable::pyRegisterClass),
         "_ZN4yade12GlobalEngine15pyRegisterClassEN5boost6python3api6objectE"},
    };
    for (const auto& function : expected)
        probe.require(function.name, table, function.slot * sizeof(void*), dlsym(RTLD_DEFAULT, function.symbol));

    const LbmEngine engine;
    const void* own = *reinterpret_cast<void* const* const*>(&engine);
    const std::size_t own_size = table_size("LbmEngine", own), yades = table_size("GlobalEngine", table);
    if (own_size != yades)
        LayoutProbe::mismatch("virtual functions of GlobalEngine: declared " + std::to_string(own_size) +
                              " bytes, YADE has " + std::to_string(yades));
}

void check_state_body_shapes(const LayoutProbe& probe, const bp::object& yade)
{
    const Vec3 position{1.5, -2.25, 3.125}, velocity{4.5, 5.25, -6.125}, rotation{7.5, -8.25, 9.125},
        inertia{0.5, 0.625, 0.75};
    const double mass = 11.5, radius = 0.1875;
    bp::object state = yade.attr("State")();
    state.attr("pos") = vector3(position);
    state.attr("ori") = bp::import("yade.minieigenHP").attr("Quaternion")(0.5, -0.5, 0.5, 0.5);  // (w, x, y, z)
    state.attr("vel") = vector3(velocity);
    state.attr("angVel") = vector3(rotation);
    state.attr("inertia") = vector3(inertia);
    state.attr("mass") = mass;
    state.attr("blockedDOFs") = "xzY";
    const auto* native_state = native<yade::State>(state);
    probe.require_size("State", native_state, sizeof(yade::State));
    probe.require("State.pos", native_state, offsetof(yade::State, se3), position);
    probe.require("State.ori", native_state, offsetof(yade::State, se3) + sizeof(yade::Vector3r),
                  std::array<double, 4>{-0.5, 0.5, 0.5, 0.5});  // (x, y, z, w)
    REQUIRE_MEMBER(probe, State, vel, native_state, velocity);
    REQUIRE_MEMBER(probe, State, angVel, native_state, rotation);
    REQUIRE_MEMBER(probe, State, inertia, native_state, inertia);
    REQUIRE_MEMBER(probe, State, mass, native_state, mass);
    REQUIRE_MEMBER(probe, State, blockedDOFs, native_state, 1u + 4u + 16u);

    bp::object sphere = yade.attr("Sphere")();
    sphere.attr("radius") = radius;
    const auto* native_sphere = native<yade::Sphere>(sphere);
    probe.require_size("Sphere", native_sphere, sizeof(yade::Sphere));
    REQUIRE_MEMBER(probe, Sphere, radius, native_sphere, radius);

    const Vec3 extents{0.375, 1.625, 2.875};
    bp::object box = yade.attr("Box")();
    box.attr("extents") = vector3(extents);
    const auto* native_box = native<yade::Box>(box);
    probe.require_size("Box", native_box, sizeof(yade::Box));
    REQUIRE_MEMBER(probe, Box, extents, native_box, extents);

    bp::dict values;
    values["id"] = 1234567;
    values["groupMask"] = 7654321;
    values["clumpId"] = 2345678;
    bp::object body = yade.attr("Body")(*bp::tuple(), **values);
    body.attr("state") = state;
    body.attr("shape") = sphere;
    const auto* native_body = native<yade::Body>(body);
    probe.require_size("Body", native_body, sizeof(yade::Body));
    REQUIRE_MEMBER(probe, Body, id, native_body, 1234567);
    REQUIRE_MEMBER(probe, Body, groupMask, native_body, 7654321);
    REQUIRE_MEMBER(probe, Body, clumpId, native_body, 2345678);
    REQUIRE_MEMBER(probe, Body, state, native_body, native_state);
    REQUIRE_MEMBER(probe, Body, shape, native_body, static_cast<const yade::Shape*>(native_sphere));
}

void check_engine(const LayoutProbe& probe, const bp::object& yade)
{
    const char label[] = "sentinel";  // short: kept inside the string object
    bp::dict values;
    values["dead"] = true;
    values["ompThreads"] = 1234567;
    values["label"] = label;
    bp::object engine = yade.attr("ForceResetter")(*bp::tuple(), **values);
    engine.attr("execTime") = 87654321;
    engine.attr("execCount") = 12345678;
    auto* native_engine = native<yade::Engine>(engine);
    probe.require_size("Engine", native_engine, sizeof(yade::Engine));
    REQUIRE_MEMBER(probe, Engine, scene, native_engine, Singleton<yade::Omega>::instance().getScene().get());
    REQUIRE_MEMBER(probe, Engine, timingInfo, native_engine, (std::array<std::int64_t, 2>{12345678, 87654321}));
    REQUIRE_MEMBER(probe, Engine, timingDeltas, native_engine, (std::array<void*, 2>{}));
    REQUIRE_MEMBER(probe, Engine, dead, native_engine, true);
    REQUIRE_MEMBER(probe, Engine, ompThreads, native_engine, 1234567);
    constexpr std::size_t kStringText = 2 * sizeof(void*);
    probe.require_bytes("Engine.label", native_engine, offsetof(yade::Engine, label) + kStringText, label,
                        sizeof label);

    // room to spare, and zeros in it: a YADE with larger timings would find empty lists
    alignas(16) static char storage[1024];
    auto* timings = new (storage) yade::TimingDeltas;
    timings->data.assign(2, yade::TimingInfo());
    timings->data[1].nExec = 23456789;
    timings->data[1].nsec = 98765432;
    timings->labels = {"first", "second"};
    native_engine->timingDeltas = yade::shared_ptr<yade::TimingDeltas>(timings, [](yade::TimingDeltas*) {});
    const bp::object seen = engine.attr("timingDeltas").attr("data");
    native_engine->timingDeltas.reset();
    const bool equal = bp::len(seen) == 2 && seen[1] == bp::make_tuple("second", 98765432, 23456789);
    timings->~TimingDeltas();
    if (!equal) LayoutProbe::mismatch("TimingDeltas.data: YADE does not read back what was written");
}

void check_integrator(const LayoutProbe& probe, const bp::object& yade)
{
    const Vec3 gravity{1.5, -2.25, 3.125};
    bp::object integrator = yade.attr("NewtonIntegrator")();
    integrator.attr("gravity") = vector3(gravity);
    const auto* native_integrator = static_cast<yade::NewtonIntegrator*>(native<yade::Engine>(integrator));
    REQUIRE_MEMBER(probe, NewtonIntegrator, gravity, native_integrator, gravity);
}

void check_scene_members(const LayoutProbe& probe, const bp::object& yade)
{
    const yade::Scene* current = Singleton<yade::Omega>::instance().getScene().get();
    probe.require_size("Scene", current, sizeof(yade::Scene));

    bp::object cell = yade.attr("Cell")();
    cell.attr("hSize") = bp::import("yade.minieigenHP").attr("Matrix3")(2.5, 0.25, 0.5, 0.125, 3.5, 0.75, 0, 1, 4.5);
    const auto* native_cell = native<yade::Cell>(cell);
    probe.require_size("Cell", native_cell, sizeof(yade::Cell));
    // columns first
    REQUIRE_MEMBER(probe, Cell, hSize, native_cell,
                   (std::array<double, 9>{2.5, 0.125, 0, 0.25, 3.5, 1, 0.5, 0.75, 4.5}));

    bp::object engine = yade.attr("ForceResetter")();
    bp::dict values;
    values["dt"] = 1.75e-3;
    values["iter"] = 123456789;
    values["time"] = 2.125;
    values["isPeriodic"] = true;
    values["cell"] = cell;
    values["engines"] = bp::list(bp::make_tuple(engine));
    const bp::object scene = yade.attr("Scene")(*bp::tuple(), **values);
    auto* native_scene = native<yade::Scene>(scene);
    REQUIRE_MEMBER(probe, Scene, dt, native_scene, 1.75e-3);
    REQUIRE_MEMBER(probe, Scene, iter, native_scene, 123456789L);
    REQUIRE_MEMBER(probe, Scene, time, native_scene, 2.125);
    REQUIRE_MEMBER(probe, Scene, isPeriodic, native_scene, true);
    REQUIRE_MEMBER(probe, Scene, cell, native_scene, native_cell);
    const auto* first = probe.read<const void*>("Scene.engines", native_scene, offsetof(yade::Scene, engines));
    probe.require("Scene.engines[0]", first, 0, static_cast<const void*>(native<yade::Engine>(engine)));

    auto* bodies = probe.read<yade::BodyContainer*>("Scene.bodies", native_scene, offsetof(yade::Scene, bodies));
    const char* table = static_cast<const char*>(dlsym(RTLD_DEFAULT, "_ZTVN4yade13BodyContainerE"));
    probe.require("Scene.bodies (its virtual functions)", bodies, 0, table + 2 * sizeof(void*));
    probe.require_size("BodyContainer", bodies, sizeof(yade::BodyContainer));
    const bp::object body = yade.attr("Body")();
    const yade::Body* native_body = native<yade::Body>(body);
    bodies->insert(yade::shared_ptr<yade::Body>(bp::extract<yade::shared_ptr<yade::Body>>(body)()));
    const auto* list = probe.read<const char*>("BodyContainer.body", bodies, offsetof(yade::BodyContainer, body));
    const auto* end =
        probe.read<const char*>("BodyContainer.body", bodies, offsetof(yade::BodyContainer, body) + sizeof(void*));
    if (end - list != static_cast<std::ptrdiff_t>(sizeof(yade::shared_ptr<yade::Body>)))
        LayoutProbe::mismatch("BodyContainer.body: not the list of bodies");
    probe.require("BodyContainer.body[0]", list, 0, native_body);
}

/// A force written natively must be the one that YADE reads; the scene's own gets it and loses it again.
void check_forces(const LayoutProbe& probe, const bp::object& yade)
{
    yade::Scene& scene = *Singleton<yade::Omega>::instance().getScene();
    // the container begins with two lists, one entry per thread, of lists: do not call into anything else
    const auto offset = offsetof(yade::Scene, forces);
    const auto lists = probe.read<std::array<const char*, 6>>("Scene.forces", &scene, offset);
    const std::ptrdiff_t threads = (lists[1] - lists[0]) / static_cast<std::ptrdiff_t>(sizeof(std::vector<Vec3>));
    if (!(threads >= 1 && threads <= 4096 && lists[4] - lists[3] == lists[1] - lists[0]))
        LayoutProbe::mismatch("Scene.forces at byte " + std::to_string(offset) + ": not the container of forces");
    (void)probe.read<char>("Scene.forces (first list)", lists[0], 0);

    // YADE's Python does not answer for bodies that do not exist
    const bp::object omega = yade.attr("Omega")();
    const bool ask_python = bp::len(omega.attr("bodies")) > 0;
    const bp::object forces = omega.attr("forces");
    const auto force = [&] {
        return ask_python ? yade::Vector3r(bp::extract<yade::Vector3r>(forces.attr("f")(0, true)))
                          : scene.forces.getForceSingle(0);
    };
    const auto torque = [&] {
        return ask_python ? yade::Vector3r(bp::extract<yade::Vector3r>(forces.attr("t")(0, true)))
                          : scene.forces.getTorqueSingle(0);
    };
    const yade::Vector3r sentinel(1.5, -2.25, 3.125), before = force(), torque_before = torque();
    scene.forces.addForce(0, sentinel);
    scene.forces.addTorque(0, 2 * sentinel);
    const yade::Vector3r after = force(), torque_after = torque();
    scene.forces.addForce(0, -sentinel);
    scene.forces.addTorque(0, -2 * sentinel);
    (void)force();  // or YADE shows the last summand until the next step
    if (after != before + sentinel || torque_after != torque_before + 2 * sentinel)
        LayoutProbe::mismatch("Scene.forces: YADE does not read back what was written");
}

}  // namespace

void check_layout()
{
    const LayoutProbe probe;
    const bp::object yade = bp::import("yade.wrapper");
    check_engine(probe, yade);
    check_virtual_functions(probe);
    check_state_body_shapes(probe, yade);
    check_integrator(probe, yade);
    check_scene_members(probe, yade);
    check_forces(probe, yade);
}

}  // namespace yadelbm
