#pragma once

#include "fields/row_saturation.hpp"
#include "lattice/vec3.hpp"
#include "physics/rates.hpp"
#include "physics/solid_fraction.hpp"

#include <cstdint>
#include <vector>

namespace lbm {

/// A solid in lattice units.
struct LatticeSolid {
    SolidGeometry geometry;
    std::int64_t body = -1;
    Vec3 velocity{}, angular_velocity{};
};

/// Sums of one solid over its cells in one step, in lattice units; moments about its centre.
struct SolidSums {
    Vec3 force{};              ///< sum F_s: of the solid on the fluid
    Mat3 first_moment{};       ///< sum r F_s, [position][force]
    Vec3 momentum{};           ///< P_in = sum eps j_post
    Vec3 angular_momentum{};   ///< L_in = sum eps r x j_post
    double coupling = 0;       ///< B = sum (1 - eps) kk rho
    double spin_coupling = 0;  ///< mean over axes of sum (1 - eps) kk rho (r^2 - (r.n)^2)

    Vec3 torque() const  ///< sum r x F_s
    {
        const Mat3& m = first_moment;
        return {m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]};
    }
};

/**
 * Which cells the solids cover, and how much: for every solid the spans of its rows with exact fractions, and for every
 * row of the lattice the spans that lie in it.
 *
 * Only solids that moved are evaluated again, and those of their body that overlap may. Sums are kept per span and added up span by span, so that the result does not depend on
 * which thread swept which row.
 */
class SolidMap {
public:
    /// @param periodic  for each axis
    SolidMap(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic, const Weighting& weighting);

    std::size_t size() const noexcept { return solids_.size(); }
    const LatticeSolid& solid(std::size_t s) const noexcept { return solids_[s].solid; }
    /// Inside the lattice; what a solid shares with earlier ones of its body is theirs.
    double volume(std::size_t s) const noexcept { return solids_[s].volume; }

    /**
     * The solids that are there now.
     * @param previous  for each of them its index in the map as it stands, or -1
     */
    void update(const std::vector<LatticeSolid>& solids, const std::vector<int>& previous);

    /// The time step becomes s times what it was: so do velocities in lattice units.
    void scale_velocities(double s) noexcept;

    bool covers(std::size_t row) const noexcept { return !solids_.empty() && row_begin_[row] != row_begin_[row + 1]; }

    /// Asks memory for what `row` and the one after it will need: spans lie scattered, solid by solid.
    void prefetch(std::size_t row) const noexcept;
    /// Writes what the solids say to the cells of a row, and marks the covered blocks.
    void saturate(std::size_t row, RowSaturation& cells) const;
    /// Reads the cells' answers into the spans' sums, and clears the row for the next one.
    void collect(std::size_t row, RowSaturation& cells);
    void clear(RowSaturation& cells) const;

    SolidSums sums(std::size_t solid) const;

    std::size_t memory_bytes() const;

private:
    using SpanSums = std::array<double, 13>;  // F, rx F, P, rx P (y and z), b, b rx^2
    struct Span {
        std::int32_t x0, n;       // x0 not wrapped
        std::uint32_t fractions;  // offset; padded with zeros to whole blocks
    };
    struct MappedSolid {
        LatticeSolid solid;
        double k = 0, volume = 0;
        int y0 = 0, ny = 0, z0 = 0, nz = 0;  // rows, not wrapped
        std::vector<Span> spans;             // ny * nz
        std::vector<double> fractions;
        bool whole_cells = false;
        std::vector<std::uint8_t> bounce;  // of a box along the lattice: whether a cell turns populations round
        std::vector<SpanSums> sums;
    };
    struct RowEntry {
        std::int32_t solid, span;
    };

    std::vector<std::vector<int>> earlier_of_body(const std::vector<LatticeSolid>& solids) const;
    double k(const SolidGeometry& geometry) const;
    void mark_walls();
    bool is_wall_cell(const LatticeSolid& own, const std::vector<const LatticeSolid*>& boxes,
                      const std::array<int, 3>& cell) const;
    void map(MappedSolid& solid, SolidFraction& fraction, const std::vector<SolidGeometry>& others) const;
    void list_rows();
    /// Whether a row or plane, not wrapped, is part of the box.
    bool is_inside(int i, int axis) const noexcept { return periodic_[axis] || (i >= 0 && i < n_[axis]); }

    std::array<int, 3> n_;
    std::array<bool, 3> periodic_;
    Weighting weighting_;
    std::vector<MappedSolid> solids_;
    std::vector<std::uint32_t> row_begin_;  // (ny * nz + 1)
    std::vector<std::uint32_t> row_next_;   // while sorting
    std::vector<RowEntry> entries_;
};

}  // namespace lbm
