// The watchdog: a run that goes wrong is stopped, with where and why.

#include "facade/implementation.hpp"
#include "lattice/message.hpp"

#include <algorithm>

namespace lbm {
namespace {

constexpr double kNothing = 1e-6;  // of a cell: the volume in the box is a difference and carries round-off

}  // namespace

/// Before the flow takes harm: no surface in the box may move faster than the flow may.
void Fluid::Implementation::watch_surfaces() const
{
    const double limit = config.max_mach * kSpeedOfSound * units.velocity;
    for (std::size_t s = 0; s < solids.size(); ++s) {
        const Solid& solid = solids[s];
        const double reach = solid.shape == Shape::box ? norm(solid.half_extents) : solid.radius;
        const double spin = reach * norm(solid.angular_velocity);
        // |V + W x r| is largest where W x r has the direction of the part of V across W
        const double speed2 = dot(solid.velocity, solid.velocity);
        const double along = spin > 0 ? dot(solid.velocity, solid.angular_velocity) / norm(solid.angular_velocity) : 0;
        const double fastest = std::hypot(along, std::sqrt(std::max(0.0, speed2 - along * along)) + spin);
        if (fastest <= limit || map.volume(s) < kNothing) continue;
        const Vec3& at = solid.position;
        throw RunError(message("solid ", solid.id, " at (", at[0], ", ", at[1], ", ", at[2], ") before step ",
                               steps + 1, " (t = ", time(), " s): its surface moves at ", fastest, " m/s, ",
                               fastest / units.velocity, " cells per fluid step, Mach number ",
                               fastest / units.velocity / kSpeedOfSound, " is above the limit ", config.max_mach,
                               ": that needs a fluid step (now ", dt, " s) smaller by that ratio"));
    }
}

void Fluid::Implementation::watch(const FlowWatch& flow) const
{
    const double limit = config.max_mach * kSpeedOfSound;
    const bool diverged = !std::isfinite(flow.sum2);
    const bool too_fast = flow.max2 > limit * limit;
    // Stokes flow is linear in the pressure: its density has no size that could be too large.
    const bool compressed = config.inertia && !(flow.drho2 <= kMaxDensityDeviation * kMaxDensityDeviation);
    if (!diverged && !too_fast && !compressed) return;

    std::vector<double> fluid_fraction(static_cast<std::size_t>(cell_count()));
    for_cells([&](const CellState& cell) { fluid_fraction[index(cell)] = 1 - cell.epsilon; });
    std::ptrdiff_t where = -1;
    double worst = -1, drho = 0;
    std::visit(
        [&]<class L, class T>(const Populations<L, T>& f) {
            const auto [nx, ny, nz] = f.layout.n;
            for (std::ptrdiff_t cell = 0; cell < static_cast<std::ptrdiff_t>(nx) * ny * nz; ++cell) {
                double p[L::Q];
                f.outgoing(static_cast<int>(cell % nx), static_cast<int>(cell / nx % ny),
                           static_cast<int>(cell / nx / ny), p);
                const Moments<double> m = moments<L>(p);
                double bad = diverged || too_fast ? dot({m.j[0], m.j[1], m.j[2]}, {m.j[0], m.j[1], m.j[2]}) /
                                                        ((1 + m.drho) * (1 + m.drho))
                                                  : std::abs(fluid_fraction[static_cast<std::size_t>(cell)] * m.drho);
                if (!std::isfinite(bad)) bad = std::numeric_limits<double>::max();
                if (bad > worst) {
                    worst = bad;
                    drho = m.drho;
                    where = cell;
                }
            }
        },
        populations);
    const auto [nx, ny, nz] = config.cells;
    const std::ptrdiff_t at[3] = {where % nx, where / nx % ny, where / nx / ny};
    const auto in_metres = [&](int d) { return config.lower[d] + (static_cast<double>(at[d]) + 0.5) * config.dx; };
    const auto place = message("at step ", steps, " (t = ", time(), " s), cell (", at[0], ", ", at[1], ", ", at[2],
                               ") at (", in_metres(0), ", ", in_metres(1), ", ", in_metres(2), ") m");
    if (diverged)
        throw RunError(message("the fluid diverged ", place,
                               ": use a smaller time step of the fluid or more cells, or keep tau above 0.52"));
    if (too_fast)
        throw RunError(message("Mach number ", std::sqrt(flow.max2) / kSpeedOfSound, " ", place, " is above the limit ",
                               config.max_mach, ": the speed of ", std::sqrt(flow.max2) * units.velocity,
                               " m/s needs a fluid step (now ", dt, " s) smaller by that ratio"));
    throw RunError(message("the density is off by ", 100 * drho, " % ", place, ", a pressure of ",
                           drho / 3 * units.pressure, " Pa: above the limit of ", 100 * kMaxDensityDeviation,
                           " % the fluid is not nearly incompressible; use a smaller time step of the fluid (now ", dt,
                           " s), or let fluid leave a box that is filled"));
}

}  // namespace lbm
