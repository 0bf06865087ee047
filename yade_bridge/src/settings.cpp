#include "settings.hpp"

#include "text.hpp"

#include "lbm/errors.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace yadelbm {
namespace {

constexpr double kWholeCells = 1e-6;  // relative; decimal input such as 0.16 / 1e-3 is off by 1e-14
constexpr const char* kFaceNames[6] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};

[[noreturn]] void refuse(const std::string& what, const std::string& value, const std::string& rule)
{
    throw lbm::ConfigError("LbmEngine." + what + " = " + value + ": " + rule);
}

void require_positive(const char* name, double value, const char* unit, bool complete)
{
    if (std::isnan(value) && !complete) return;
    if (!(std::isfinite(value) && value > 0))
        refuse(name, text(value), std::string("must be finite and > 0 [") + unit + "]");
}

void require_finite(const std::string& name, const lbm::Vec3& v, const char* unit)
{
    for (double component : v)
        if (!std::isfinite(component)) refuse(name, text(v), std::string("must be finite [") + unit + "]");
}

void require_one_of(const char* name, const std::string& value, std::initializer_list<const char*> choices)
{
    std::string list;
    for (const char* choice : choices) {
        if (value == choice) return;
        list += std::string(list.empty() ? "'" : ", '") + choice + "'";
    }
    refuse(name, "'" + value + "'", "must be one of " + list);
}

std::string where(int face) { return std::string("[") + kFaceNames[face] + "]"; }

bool upper_unset(const Settings& s)
{
    return std::isnan(s.upper[0]) && std::isnan(s.upper[1]) && std::isnan(s.upper[2]);
}

void check_numbers(const Settings& s, bool complete)
{
    require_positive("dx", s.dx, "m", complete);
    require_positive("density", s.density, "kg/m3", complete);
    require_positive("viscosity", s.viscosity, "Pa s, dynamic", complete);
    require_positive("maxMach", s.max_mach, "-", true);
    require_positive("accuracy", s.accuracy, "-", true);
    if (s.magic_parameter < lbm::kMinLambda || s.magic_parameter > lbm::kMaxLambda)
        refuse("magicParameter", text(s.magic_parameter),
               "must be between " + text(lbm::kMinLambda) + " and " + text(lbm::kMaxLambda) +
                   ", beyond which drag is off by more than 2 %; NaN: the scheme's own");
    if (!(s.lubrication_roughness >= lbm::kMinRoughness && s.lubrication_roughness <= lbm::kMaxRoughness))
        refuse("lubricationRoughness", text(s.lubrication_roughness),
               "must be between " + text(lbm::kMinRoughness) + " and " + text(lbm::kMaxRoughness) +
                   " radii of the smaller sphere");
    require_finite("lower", s.lower, "m");
    require_finite("gravity", s.gravity, "m/s2");
    require_finite("acceleration", s.acceleration, "m/s2");
    require_finite("initialVelocity", s.initial_velocity, "m/s");
    if (complete || !upper_unset(s)) require_finite("upper", s.upper, "m");
    if (!std::isnan(s.tau) && !(s.tau >= lbm::kMinTau && s.tau <= lbm::kMaxTau))
        refuse("tau", text(s.tau),
               "must be between " + text(lbm::kMinTau) + " and " + text(lbm::kMaxTau) + ", or NaN to have it chosen");
}

void check_choices(const Settings& s)
{
    require_one_of("scheme", s.scheme,
                   {"exact", "nobleTorczynski", "nobleTorczynskiLinear", "superposition", "bounceBack"});
    require_one_of("collision", s.collision, {"trt", "bgk"});
    require_one_of("lattice", s.lattice, {"D3Q19", "D3Q27"});
    if (s.collision == "bgk" && !std::isnan(s.magic_parameter))
        refuse("magicParameter", text(s.magic_parameter),
               "with collision = 'bgk' it is (tau - 1/2)^2; leave it out or use 'trt'");
    if (s.storage != "double" && s.storage != "single")
        refuse("storage", "'" + s.storage + "'", "must be 'double' or 'single'");
    if (s.ranks != 0) refuse("ranks", std::to_string(s.ranks), "only 0, the fluid in this process, is supported today");
}

struct FaceName {
    const char* name;
    lbm::FaceType type;
};
constexpr FaceName kFaceTypes[] = {{"periodic", lbm::FaceType::periodic},
                                   {"noSlip", lbm::FaceType::no_slip},
                                   {"freeSlip", lbm::FaceType::free_slip},
                                   {"velocity", lbm::FaceType::velocity},
                                   {"pressure", lbm::FaceType::pressure}};

const FaceName* find_type(const std::string& name)
{
    const auto found =
        std::find_if(std::begin(kFaceTypes), std::end(kFaceTypes), [&](const FaceName& t) { return name == t.name; });
    return found == std::end(kFaceTypes) ? nullptr : found;
}

template <class Value>
void require_six(const char* name, const std::vector<Value>& values, const char* kind)
{
    if (values.size() != 6)
        refuse(name, "list of " + std::to_string(values.size()),
               std::string("must have six ") + kind + ": xmin, xmax, ymin, ymax, zmin, zmax");
}

void check_faces(const Settings& s)
{
    require_six("boundary", s.boundary, "names");
    require_six("boundaryVelocity", s.boundary_velocity, "vectors");
    require_six("boundaryPressure", s.boundary_pressure, "numbers");
    for (int face = 0; face < 6; ++face) {
        const std::string& type = s.boundary[face];
        if (!find_type(type))
            refuse("boundary" + where(face), "'" + type + "'",
                   "must be 'periodic', 'noSlip', 'freeSlip', 'velocity' or 'pressure'");
        if ((type == "periodic") != (s.boundary[face ^ 1] == "periodic"))
            refuse("boundary" + where(face), "'" + type + "'",
                   "the opposite face is '" + s.boundary[face ^ 1] + "': both faces of a pair are periodic or none");
        require_finite("boundaryVelocity" + where(face), s.boundary_velocity[face], "m/s");
        if (!std::isfinite(s.boundary_pressure[face]))
            refuse("boundaryPressure" + where(face), text(s.boundary_pressure[face]), "must be finite [Pa]");
    }
}

/// Velocities and pressures are where the faces have them.
void check_face_values(const Settings& s)
{
    for (int face = 0; face < 6; ++face) {
        const std::string& type = s.boundary[face];
        const lbm::Vec3& velocity = s.boundary_velocity[face];
        if (type == "noSlip" && velocity[face / 2] != 0)
            refuse("boundaryVelocity" + where(face), text(velocity),
                   "a noSlip wall moves in its own plane only; 'velocity' lets fluid through");
        if (type != "noSlip" && type != "velocity" && velocity != lbm::Vec3{})
            refuse("boundaryVelocity" + where(face), text(velocity),
                   type + " faces have no velocity; use 'noSlip', 'velocity' or zero");
        if (type != "pressure" && s.boundary_pressure[face] != 0)
            refuse("boundaryPressure" + where(face), text(s.boundary_pressure[face]),
                   type + " faces have no pressure of their own; use 'pressure' or zero");
    }
}

}  // namespace

void check_values(const Settings& s)
{
    check_numbers(s, false);
    check_choices(s);
    check_faces(s);
}

void check(const Settings& s, bool complete)
{
    check_numbers(s, complete);
    check_choices(s);
    check_faces(s);
    check_face_values(s);
    if (complete || !(upper_unset(s) || std::isnan(s.dx))) (void)cells(s);
}

std::array<int, 3> cells(const Settings& s)
{
    std::array<int, 3> result{};
    for (int axis = 0; axis < 3; ++axis) {
        const std::string name = std::string("upper - lower along ") + "xyz"[axis];
        const double length = s.upper[axis] - s.lower[axis];
        const double count = length / s.dx;
        if (!(length > 0)) refuse(name, text(length), "must be > 0 [m]");
        if (!(count < 1e6))
            refuse(name, text(length),
                   "is " + text(count) + " cells of dx = " + text(s.dx) + ", at most 1e6 are possible");
        const double whole = std::max(1.0, std::round(count));
        if (std::abs(count - whole) > kWholeCells * whole)
            refuse(name, text(length),
                   "is " + text(count) + " cells of dx = " + text(s.dx) + ", must be a whole number; dx = " +
                       text(length / whole) + " or a length of " + text(whole * s.dx) + " would do");
        result[axis] = static_cast<int>(whole);
    }
    return result;
}

std::array<lbm::FaceCondition, 6> face_conditions(const Settings& s)
{
    std::array<lbm::FaceCondition, 6> faces;
    for (int face = 0; face < 6; ++face)
        faces[face] = {find_type(s.boundary[face])->type, s.boundary_velocity[face], s.boundary_pressure[face]};
    return faces;
}

namespace {

lbm::Scheme scheme(const std::string& name)
{
    if (name == "nobleTorczynski") return lbm::Scheme::noble_torczynski;
    if (name == "nobleTorczynskiLinear") return lbm::Scheme::noble_torczynski_linear;
    if (name == "superposition") return lbm::Scheme::superposition;
    if (name == "bounceBack") return lbm::Scheme::bounce_back;
    return lbm::Scheme::exact;
}

}  // namespace

lbm::FluidConfig fluid_config(const Settings& s, double tau, int threads)
{
    check(s, true);
    lbm::FluidConfig config;
    config.lower = s.lower;
    config.cells = cells(s);
    config.dx = s.dx;
    config.density = s.density;
    config.viscosity = s.viscosity;
    config.tau = tau;
    config.magic_parameter = s.magic_parameter;
    config.gravity = s.gravity;
    config.acceleration = s.acceleration;
    config.initial_velocity = s.initial_velocity;
    config.faces = face_conditions(s);
    config.scheme = scheme(s.scheme);
    config.collision = s.collision == "bgk" ? lbm::Collision::bgk : lbm::Collision::trt;
    config.lattice = s.lattice == "D3Q27" ? lbm::Lattice::d3q27 : lbm::Lattice::d3q19;
    config.inertia = s.inertia;
    config.storage = s.storage == "single" ? lbm::Storage::single_precision : lbm::Storage::double_precision;
    config.lubrication = s.lubrication;
    config.lubrication_roughness = s.lubrication_roughness;
    config.max_mach = s.max_mach;
    config.threads = threads;
    return config;
}

}  // namespace yadelbm
