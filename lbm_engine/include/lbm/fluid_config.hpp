#pragma once

#include "lbm/solid.hpp"

#include <array>
#include <limits>

namespace lbm {

/// Faces of the box, in the order used by every array of six.
enum Face { kXMin, kXMax, kYMin, kYMax, kZMin, kZMax };

/**
 * no_slip   a wall, at rest or moving in its own plane
 * free_slip a plane without friction, a plane of symmetry
 * velocity  fluid with the given velocity, in or out
 * pressure  fluid at the given pressure that flows along the normal, in or out
 */
enum class FaceType { periodic, no_slip, free_slip, velocity, pressure };

/// What happens at one face of the box. It stands half a cell outside the last cell centres.
struct FaceCondition {
    FaceType type = FaceType::periodic;
    Vec3 velocity{};      ///< of a velocity face; of a no-slip wall, in its own plane [m/s]
    double pressure = 0;  ///< of a pressure face, excess over hydrostatic and drive, as Fluid::pressure_at [Pa]
};

/// How cells with solids collide: the scheme of this engine, or a published one for comparison (docs/physics.md).
enum class Scheme {
    exact,                    ///< partially saturated cells, independent of tau in Stokes flow
    noble_torczynski,         ///< bounce-back of what is out of equilibrium, B = eps Lp / (1 - eps + Lp)
    noble_torczynski_linear,  ///< the same with B = eps
    superposition,            ///< superposition of fluid and solid equilibria, B = eps Lp / (1 - eps + Lp)
    bounce_back               ///< of all populations in cells that are more than half solid
};

/// Two relaxation times, whose magic parameter is fixed, or one (Lambda = (tau - 1/2)^2), for comparison.
enum class Collision { trt, bgk };

/// The velocity set. D3Q27 is isotropic to higher order and costs about half as much again in time and memory.
enum class Lattice { d3q19, d3q27 };

/// How much storage a population takes. Populations are kept as deviations from rest.
enum class Storage { double_precision, single_precision };

/// Everything that defines a fluid. SI units.
struct FluidConfig {
    Vec3 lower{};                ///< lower corner of the box [m]
    std::array<int, 3> cells{};  ///< cells along x, y, z, each >= 1
    double dx = 0;               ///< cell size [m], > 0
    double density = 0;          ///< [kg/m3], > 0
    double viscosity = 0;        ///< dynamic [Pa s], > 0
    double tau = 0;              ///< relaxation time [fluid steps], kMinTau to kMaxTau; sets the time step
    double magic_parameter =
        std::numeric_limits<double>::quiet_NaN();  ///< Lambda, kMinLambda to kMaxLambda; NaN: the scheme's own
    Vec3 gravity{};           ///< buoyancy on solids [m/s2]; hydrostatic pressure is left out of the fields
    Vec3 acceleration{};      ///< uniform drive: a mean pressure gradient of -density * acceleration [m/s2]
    Vec3 initial_velocity{};  ///< of the fluid at the start, everywhere [m/s]
    std::array<FaceCondition, 6> faces{};
    bool inertia = true;  ///< false: Stokes flow, the quadratic terms dropped
    Scheme scheme = Scheme::exact;
    Collision collision = Collision::trt;
    Lattice lattice = Lattice::d3q19;
    Storage storage = Storage::double_precision;
    bool lubrication =
        true;  ///< Fluid::film_loads: what the lattice does not resolve of narrow gaps; exact scheme only
    double lubrication_roughness =
        1e-3;               ///< gap, in radii of the smaller sphere, below which films get no stronger, > 0
    double max_mach = 0.2;  ///< a step that goes beyond it ends the run, > 0
    int threads = 0;        ///< of the fluid's loops; 0: as OpenMP decides
};

inline constexpr double kMinTau = 0.505;  ///< below, no flow of interest was found stable
inline constexpr double kMaxTau = 20.0;   ///< above, the slip of first order in the Knudsen number is no longer small
/// Of the magic parameter. The resistance of solids is fitted for 1/12 to 1/4; at these ends the drag of a sphere is about 1 % too high and 1 to 2 % too low.
inline constexpr double kMinLambda = 0.01, kMaxLambda = 0.5;
inline constexpr double kMinRoughness = 1e-6, kMaxRoughness = 0.1;  ///< of films, in radii
inline constexpr double kMaxDensityDeviation =
    0.5;  ///< relative to rest; with inertia, a step that goes beyond it ends the run
inline constexpr double kMinRadiusInCells = 2.0;
inline constexpr double kMinHalfExtentInCells = 1.0;
inline constexpr double kMaxCells = 2e9;  ///< no machine at hand holds more

}  // namespace lbm
