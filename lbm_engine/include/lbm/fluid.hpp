#pragma once

#include "lbm/errors.hpp"
#include "lbm/fluid_config.hpp"
#include "lbm/solid.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lbm {

/// Wall-clock time spent in the parts of a step since construction [s].
struct StepTimes {
    double map = 0;             ///< solids onto the lattice
    double exchange = 0;        ///< faces
    double collide_stream = 0;  ///< the sweep over the cells
    double loads = 0;           ///< sums over the solids
    double films = 0;           ///< film_loads
};

/**
 * Mean stress in the box, by what carries it. Tension is positive; [a][b] is the force along a on planes with normal b. Pressures are in excess of
 * hydrostatic and drive.
 */
struct StressParts {
    Mat3 fluid{};   ///< pressure, viscous stress and momentum of all cells [Pa]
    Mat3 solids{};  ///< first moments of the forces on the solids (stresslets and torques) per volume [Pa]
};

/**
 * A box of viscous fluid with rigid solids in it: D3Q19 or D3Q27, two relaxation times, viscosity-exact partially saturated cells.
 *
 * A coupled step reads: `place_solids` (where they are now), `step`, `loads` (what to apply until the next step), and in each of the solids' own steps until then
 * `film_loads`, which the lattice does not resolve.
 * All quantities are SI. The object is valid from construction on, prints nothing and owns the whole state of the fluid. Where memory runs out, what changes it
 * throws a RunError and it must not be used any more; what only reads it throws std::bad_alloc.
 */
class Fluid {
public:
    /**
     * Fluid at rest, without solids.
     * @throws ConfigError  for a value outside its range; the message names it and says what would do
     */
    explicit Fluid(const FluidConfig& config);
    /// @throws ConfigError  as the constructor would, without building anything
    static void check(const FluidConfig& config);
    ~Fluid();
    Fluid(Fluid&&) noexcept;
    Fluid& operator=(Fluid&&) noexcept;

    const FluidConfig& config() const noexcept;

    /**
     * The solids that are in the fluid now. They replace the earlier set: a solid is known by its id, one that was there before
     * keeps its momentum bookkeeping (unless it jumped by more than its radius, or half its thickness), new ones start consistent with the flow around them, the others leave. A
     * solid that has not moved costs nothing. Solids may overlap each other and stand out of faces that are not periodic.
     * @throws ConfigError  for a radius below two cells, a sphere larger than the box (than twice the box along axes that are not periodic), a box in the fluid thinner than two cells, a turned one longer than a periodic axis, a bore that
     *         does not fit, a value that is not finite, an id given twice
     */
    void place_solids(const std::vector<Solid>& solids);

    /**
     * Fluid steps of length dt(), the solids staying where they are. Of several steps around solids that are all fixed (at rest, of infinite mass and inertia) loads are found for
     * the last one only: dense beds take 4/5 of the time.
     * @param count  of steps, >= 0
     * @throws ConfigError  for a negative number of steps
     * @throws RunError  with where and when: if a surface in the box moves beyond the Mach limit (the flow is untouched then), or if the flow
     *         diverged, went beyond that limit or, with inertia, has a density that is off by more than kMaxDensityDeviation
     */
    void step(int count = 1);

    /**
     * Goes on with another relaxation time, and so with another dt(), in the same flow: velocities, pressures, stresses and loads
     * stay what they are (in steady Stokes flow exactly; beside boxes that stand along the lattice, and with the published schemes, after some tens of steps).
     * @param tau  kMinTau to kMaxTau
     * @throws ConfigError  if it is outside, or the present speed would go beyond the Mach limit; nothing has changed then
     */
    void change_tau(double tau);

    /**
     * Gives the faces other velocities and pressures: an oscillating wall, a pressure that rises. What holds for the middle of the next step is exact to
     * second order in time.
     * @throws ConfigError  for a value outside its range, or a face of another type than before; nothing has changed then
     */
    void change_faces(const std::array<FaceCondition, 6>& faces);

    /// Loads of the last step, in the order of the last `place_solids`, without films; zero before the first step.
    const std::vector<SolidLoad>& loads() const noexcept;

    /**
     * What thin films between surfaces do to the solids in one of their own steps, of any length beside the fluid's (`lubrication`; docs/physics.md, "Films"). Films are
     * implicit: they answer to the velocities at the end of that step, take energy whatever its length, and are equal and opposite between two solids.
     * @param solids  where they are at the start of the step, with the velocities that they would have at its end without films: after loads, weight and contacts
     * @param dt      length of the step [s], > 0
     * @return loads over the step, in the order of `solids`; zero without `lubrication`. Valid until the next call.
     * @throws ConfigError  for a step or a value out of range
     */
    const std::vector<SolidLoad>& film_loads(const std::vector<Solid>& solids, double dt);

    double dt() const noexcept;    ///< [s]
    double time() const noexcept;  ///< that the steps have covered [s]
    std::int64_t steps() const noexcept;
    double max_mach() const noexcept;  ///< largest Mach number seen in the last step [-]
    StepTimes times() const noexcept;
    std::size_t memory_bytes() const;  ///< populations and solids' maps

    Vec3 average_velocity() const;  ///< superficial: over all cells, solid ones included [m/s]
    /// mu U.G / |G|^2 for the drive G = density * acceleration + the drop between pressure faces that face each other, over the length of the box
    /// between them [m2]; NaN without one
    double permeability() const;
    double total_mass() const;  ///< of the lattice's fluid [kg]
    /// Momentum of the fluid outside the solids, with the part of it that is on its way to them [kg m/s]: adding the solids' own
    /// (m V) gives a sum that only drive, weight and walls change. It has had half a step less of the drive than the velocities.
    Vec3 total_momentum() const;
    /**
     * The same for angular momentum about the origin of the coordinates [kg m2/s]: with the solids' own (m X x V and that of their spin) the sum changes by the torques of walls, weight and
     * drive (density * acceleration * V_box at the middle of the box) alone, to round-off. In periodic directions there is no such law.
     */
    Vec3 total_angular_momentum() const;
    /// Volume of fluid per time (mass over `density`) that left the box through a face in the last step; through a periodic one too [m3/s].
    double boundary_flux(Face face) const;
    /**
     * Force of the fluid on a face, from the momentum that crosses its links between the last collision and the next one; zero for a periodic face. Of
     * the excess pressure, like the pressure field: neither hydrostatic pressure nor the drive's is in it. For a velocity or pressure face it
     * contains the momentum that the fluid carries through it, without that of what fills solids which cross it, between their last two places. What films add to the force on a wall is that of the last `film_loads`.
     * In each step, with faces F without films, drive a and loads on the solids: total_momentum changes by density * acceleration * V_box - sum F (before the step, after place_solids) -
     * loads (of the step, without buoyancy).
     */
    Vec3 boundary_force(Face face) const;  ///< [N]
    /// The same for the moment of this force about the origin of the coordinates, without films [N m].
    Vec3 boundary_torque(Face face) const;
    /// In steady motion the sum of its parts is the mean stress on the faces: of a solid that does not turn freely, with its torque.
    StressParts stress() const;
    double kinetic_energy() const;          ///< of the fluid outside the solids [J]
    double mean_density_deviation() const;  ///< relative to `density` [-]

    Vec3 velocity_at(const Vec3& position) const;      ///< trilinear; @throws ConfigError outside the box [m/s]
    double pressure_at(const Vec3& position) const;    ///< excess over hydrostatic and drive, trilinear [Pa]
    std::vector<double> velocity_field() const;        ///< (nz, ny, nx, 3) [m/s]
    std::vector<double> pressure_field() const;        ///< (nz, ny, nx) [Pa]
    std::vector<double> solid_fraction_field() const;  ///< (nz, ny, nx) [-]

    /// Writes velocity, pressure and solid fraction as VTK image data (.vti). @throws RunError if the file cannot be written
    void save_vtk(const std::string& path) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace lbm
