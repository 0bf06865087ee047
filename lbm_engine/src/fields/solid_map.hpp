#pragma once

#include "fields/lattice_solid.hpp"
#include "fields/narrow_pores.hpp"
#include "fields/row_saturation.hpp"
#include "fields/row_units.hpp"
#include "fields/solid_row.hpp"
#include "lattice/vec3.hpp"
#include "physics/rates.hpp"
#include "physics/solid_fraction.hpp"

#include <atomic>
#include <cstdint>
#include <vector>

namespace lbm {

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
 * row of the lattice the pieces of spans that lie in it.
 *
 * Only solids that moved are evaluated again, those of their body that overlap may, and spheres beside them. Sums are kept per solid and unit of rows (RowUnits).
 */
class SolidMap {
public:
    /**
     * @param periodic  for each axis
     * @param mirrors   faces behind which a sphere sees its mirror image
     * @param thicken   whether cells cut by a sphere count as more solid opposite other spheres (CutCells)
     */
    SolidMap(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic, const std::array<bool, 6>& mirrors,
             const Weighting& weighting, bool thicken);

    std::size_t size() const noexcept { return solids_.size(); }
    const LatticeSolid& solid(std::size_t s) const noexcept { return solids_[s].solid; }
    /// Inside the lattice; what a solid shares with earlier ones of its body is theirs.
    double volume(std::size_t s) const noexcept { return solids_[s].volume; }
    const RowUnits& units() const noexcept { return units_; }

    /**
     * The solids that are there now.
     * @param previous  for each of them its index in the map as it stands, or -1
     */
    void update(const std::vector<LatticeSolid>& solids, const std::vector<int>& previous);

    /// The time step becomes s times what it was: so do velocities in lattice units.
    void scale_velocities(double s);

    bool covers(std::size_t row) const noexcept { return row_begin_[row] != row_end_[row]; }

    /// Asks memory for the fractions of a row, which lie scattered, solid by solid, and for the sums if they are `heard`.
    void prefetch(std::size_t row, bool heard) const noexcept;
    /// Writes what the solids say to the cells of a row, and marks the covered blocks.
    void saturate(std::size_t row, RowSaturation& cells) const;
    /// Adds the cells' answers to the solids' sums.
    void collect(std::size_t row, const RowSaturation& cells);
    /// Whether all solids are at rest, and not free to move.
    bool all_fixed() const noexcept { return all_fixed_; }

    void clear_sums();
    SolidSums sums(std::size_t solid) const;

    std::size_t memory_bytes() const;

private:
    struct MappedSolid {
        LatticeSolid solid;
        double k = 0, volume = 0;
        int y0 = 0, ny = 0, z0 = 0, nz = 0;  // rows, not wrapped
        int units_y = 0, units_z = 0;        // of rows, that they lie in; at most all
        std::vector<Opposite> opposite;      // that leave a narrow pore
        std::vector<Span> spans;             // ny * nz, where x is not wrapped
        std::vector<double> fractions;       // a block of padding before and after those of the spans
        std::size_t pieces = 0;              // spans that are not empty, cut at periodic faces
        bool whole_cells = false;
        std::vector<std::uint8_t> bounce;  // of a box along the lattice: whether a cell turns populations round
    };
    /// The rows of a solid that lie in a unit of rows: some of each of some planes.
    struct Visit {
        RowOfSolid seen;
        const Span* spans;
        std::int32_t rows, planes, next_plane;  // spans from one plane to the next
        std::uint32_t row;                      // of the lattice, the first of them
    };
    std::vector<std::vector<int>> earlier_of_body(const std::vector<LatticeSolid>& solids) const;
    double k(const SolidGeometry& geometry) const;
    void mark_walls();
    void map(MappedSolid& solid, SolidFraction& fraction, CutCells& cut,
             const std::vector<SolidGeometry>& others) const;
    RowEnds stored_ends(Shape shape, const SolidFraction& fraction, int j, int k) const;
    void measure(MappedSolid& solid, const SolidFraction& fraction, bool lone_sphere) const;
    void list_rows();
    void list_rows_of(int unit, std::atomic<std::uint32_t>& listed);
    void tell_rows();
    template <class Body>
    void for_spans(const std::vector<Visit>& visits, Body body) const;
    PiecesOfRow pieces(std::size_t row) const noexcept;
    /// Whether a row or plane, not wrapped, is part of the box.
    bool is_inside(int i, int axis) const noexcept { return periodic_[axis] || (i >= 0 && i < n_[axis]); }
    bool is_row_inside(const SolidFraction& fraction, int j, int k) const noexcept
    {
        return is_inside(fraction.first()[1] + j, 1) && is_inside(fraction.first()[2] + k, 2);
    }

    std::array<int, 3> n_;
    std::array<bool, 3> periodic_;
    Weighting weighting_;
    bool thicken_;
    RowUnits units_;
    std::vector<MappedSolid> solids_;
    NarrowPores pores_;
    std::vector<std::uint8_t> moved_;              // while updating
    std::vector<SolidFraction> fractions_;         // for each thread
    std::vector<std::vector<Opposite>> opposite_;  // the same
    std::vector<CutCells> cut_cells_;              // the same
    std::vector<RowSolid> row_solids_;
    bool all_fixed_ = false;
    std::vector<std::vector<Visit>> visits_;          // for each unit, while sorting
    std::vector<std::uint32_t> row_begin_, row_end_;  // for each row, among the pieces
    std::vector<Piece> pieces_;                       // of each row side by side
    std::vector<std::uint32_t> sums_begin_;           // for each solid
    std::vector<PieceSums> sums_;
};

}  // namespace lbm
