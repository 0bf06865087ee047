#include "facade/implementation.hpp"
#include "fields/momentum_flux.hpp"
#include "lattice/message.hpp"
#include "output/vtk.hpp"

#include <algorithm>

namespace lbm {
Vec3 Fluid::average_velocity() const
{
    const auto& fluid = *implementation_;
    const Vec3 sum = fluid.sum_cells<Vec3>([](const CellState& cell) { return cell.u; });
    return (fluid.units.velocity / fluid.cell_count()) * sum;
}

double Fluid::permeability() const
{
    const FluidConfig& c = config();
    Vec3 drive = c.density * c.acceleration;
    for (int d = 0; d < 3; ++d) {
        const FaceCondition &low = c.faces[2 * d], &high = c.faces[2 * d + 1];
        if (low.type == FaceType::pressure && high.type == FaceType::pressure)
            drive[d] += (low.pressure - high.pressure) / (c.cells[d] * c.dx);
    }
    return c.viscosity * dot(average_velocity(), drive) / dot(drive, drive);
}

std::array<Faces::Passage, 6> Fluid::Implementation::passages() const
{
    return std::visit(
        [&]<class L, class T>(const Populations<L, T>& f) {
            return faces.passages(f.data(), f.odd, [&](int x, int y, int z) {
                double in[L::Q];
                f.incoming(x, y, z, in);
                return moments<L>(in).drho;
            });
        },
        populations);
}

double Fluid::boundary_flux(Face face) const
{
    const Units& units = implementation_->units;
    return units.mass / (units.density * units.time) * implementation_->passages()[face].volume;
}

Vec3 Fluid::boundary_force(Face face) const
{
    const auto& fluid = *implementation_;
    return fluid.units.force * (fluid.passages()[face].momentum + fluid.carried_by_face[face].momentum) +
           fluid.film_forces_on_walls[face];
}

Vec3 Fluid::boundary_torque(Face face) const
{
    const auto& fluid = *implementation_;
    const Faces::Passage passage = fluid.passages()[face];
    const auto& carried = fluid.carried_by_face[face];
    return fluid.units.torque * (passage.moment + carried.moment) +
           cross(config().lower, fluid.units.force * (passage.momentum + carried.momentum));
}

double Fluid::mean_density_deviation() const
{
    const auto& fluid = *implementation_;
    return fluid.sum_cells<double>([](const CellState& cell) { return cell.drho; }) / fluid.cell_count();
}

double Fluid::total_mass() const
{
    const auto& fluid = *implementation_;
    return fluid.units.mass * fluid.cell_count() * (1 + mean_density_deviation());
}

Vec3 Fluid::total_momentum() const
{
    const auto& fluid = *implementation_;
    Vec3 sum = fluid.sum_cells<Vec3>([](const CellState& cell) { return cell.momentum; });
    for (const LoadLedger& ledger : fluid.ledgers) sum += ledger.outstanding() - ledger.momentum;
    return fluid.units.momentum * sum;
}

Vec3 Fluid::total_angular_momentum() const
{
    const auto& fluid = *implementation_;
    const Vec3 sum = fluid.sum_cells<Vec3>([](const CellState& cell) {
        return cross({cell.x + 0.5, cell.y + 0.5, cell.z + 0.5}, cell.momentum);
    });
    Vec3 total = (fluid.units.momentum * fluid.units.length) * sum;
    for (std::size_t s = 0; s < fluid.ledgers.size(); ++s) {
        const LoadLedger& ledger = fluid.ledgers[s];
        total += (fluid.units.momentum * fluid.units.length) * (ledger.outstanding_moment() - ledger.angular_momentum);
        total += cross(fluid.solids[s].position - config().lower,
                       fluid.units.momentum * (ledger.outstanding() - ledger.momentum));
    }
    return total + cross(config().lower, total_momentum());
}

StressParts Fluid::stress() const
{
    const auto& fluid = *implementation_;
    const ThreadCount threads(config());
    const Mat3 flux = std::visit([](const auto& f) { return momentum_flux(f); }, fluid.populations);
    StressParts stress;
    for (int a = 0; a < 3; ++a) stress.fluid[a] = (-fluid.units.pressure / fluid.cell_count()) * flux[a];
    const double volume = fluid.cell_count() * std::pow(config().dx, 3);
    for (const auto* loads : {&fluid.loads, &fluid.loads_of_films})
        for (const SolidLoad& load : *loads)
            for (int a = 0; a < 3; ++a) {
                const int b = (a + 1) % 3, c = (a + 2) % 3;
                stress.solids[a] += (1 / volume) * load.stresslet[a];
                stress.solids[a][a] += load.isotropic_moment / volume;
                stress.solids[c][b] += 0.5 * load.torque[a] / volume;
                stress.solids[b][c] -= 0.5 * load.torque[a] / volume;
            }
    return stress;
}

double Fluid::kinetic_energy() const
{
    const auto& fluid = *implementation_;
    return fluid.units.energy * fluid.sum_cells<double>([](const CellState& cell) {
        return 0.5 * (1 - cell.epsilon) * (1 + cell.drho) * dot(cell.u, cell.u);
    });
}

std::vector<double> Fluid::velocity_field() const
{
    const auto& fluid = *implementation_;
    std::vector<double> field(3 * static_cast<std::size_t>(fluid.cell_count()));
    fluid.for_cells([&](const CellState& cell) {
        for (int d = 0; d < 3; ++d) field[3 * fluid.index(cell) + d] = fluid.units.velocity * cell.u[d];
    });
    return field;
}

std::vector<double> Fluid::pressure_field() const
{
    const auto& fluid = *implementation_;
    std::vector<double> field(static_cast<std::size_t>(fluid.cell_count()));
    fluid.for_cells([&](const CellState& cell) {
        field[fluid.index(cell)] = fluid.units.pressure * kSpeedOfSound * kSpeedOfSound * cell.drho;
    });
    return field;
}

std::vector<double> Fluid::solid_fraction_field() const
{
    const auto& fluid = *implementation_;
    std::vector<double> field(static_cast<std::size_t>(fluid.cell_count()));
    fluid.for_cells([&](const CellState& cell) { field[fluid.index(cell)] = cell.epsilon; });
    return field;
}

namespace {

/// The eight cell centres around a position and their trilinear weights; beyond the last centre next to a wall, that of the wall's cell.
struct Stencil {
    int cell[3][2];
    double weight[3][2];
};

Stencil stencil(const FluidConfig& c, const Vec3& position)
{
    Stencil s{};
    for (int d = 0; d < 3; ++d) {
        const int n = c.cells[d];
        const double x = (position[d] - c.lower[d]) / c.dx;
        if (!(x >= 0 && x <= n))
            throw ConfigError(message("position ", position[d], " m along ", "xyz"[d], " is outside the box, ",
                                      c.lower[d], " to ", c.lower[d] + n * c.dx, " m"));
        const double left = std::floor(x - 0.5);
        const bool periodic = c.faces[2 * d].type == FaceType::periodic;
        for (int side = 0; side < 2; ++side) {
            const int cell = static_cast<int>(left) + side;
            s.cell[d][side] = periodic ? (cell + n) % n : std::clamp(cell, 0, n - 1);
            s.weight[d][side] = side ? x - 0.5 - left : 1 - (x - 0.5 - left);
        }
    }
    return s;
}

}  // namespace

CellState Fluid::Implementation::cell_at(int x, int y, int z) const
{
    CellState found{};
    std::visit(
        [&](const auto& f) {
            RowSaturation cells(config.cells[0]);
            const std::size_t row = static_cast<std::size_t>(z) * config.cells[1] + y;
            if (map.covers(row)) map.saturate(row, cells);
            const auto take = [&](const CellState& cell) {
                if (cell.x == x) found = cell;
            };
            read_row(f, collision, config.inertia, y, z, cells, take);
        },
        populations);
    return found;
}

/// Calls body(weight, cell) for the cells around a position.
template <class Body>
static void interpolate(const Stencil& s, Body body)
{
    for (int corner = 0; corner < 8; ++corner) {
        const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        body(s.weight[0][i] * s.weight[1][j] * s.weight[2][k], s.cell[0][i], s.cell[1][j], s.cell[2][k]);
    }
}

Vec3 Fluid::velocity_at(const Vec3& position) const
{
    Vec3 u{};
    interpolate(stencil(config(), position),
                [&](double weight, int x, int y, int z) { u += weight * implementation_->cell_at(x, y, z).u; });
    return implementation_->units.velocity * u;
}

double Fluid::pressure_at(const Vec3& position) const
{
    double drho = 0;
    interpolate(stencil(config(), position),
                [&](double weight, int x, int y, int z) { drho += weight * implementation_->cell_at(x, y, z).drho; });
    return implementation_->units.pressure * kSpeedOfSound * kSpeedOfSound * drho;
}

void Fluid::save_vtk(const std::string& path) const
{
    const auto u = velocity_field(), p = pressure_field(), epsilon = solid_fraction_field();
    write_vti(path, config().cells, config().lower, config().dx,
              {{"velocity", 3, &u}, {"pressure", 1, &p}, {"solidFraction", 1, &epsilon}});
}

}  // namespace lbm
