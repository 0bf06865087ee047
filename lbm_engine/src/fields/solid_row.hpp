#pragma once

#include "fields/row_saturation.hpp"
#include "lattice/vec3.hpp"
#include "lattice/wrap.hpp"

#include <cstdint>

namespace lbm {

/// What rows need to know of a solid.
struct RowSolid {
    Vec3 centre, velocity, angular_velocity;
    double k;                    ///< of its strength
    std::uint32_t sums;          ///< the first of its own
    const double* fractions;     ///< of its cells
    const std::uint8_t* bounce;  ///< which of them turn populations round, or null
};

/// Cells side by side in a row that a solid touches. Of its inside, where fractions are 1, most are not stored.
struct Span {
    std::int32_t x0, n;
    std::uint32_t
        fractions;  ///< of the first cell among those of the solid; a block more may be read before and after the span
    std::uint16_t full;   ///< cells without: all 1
    std::uint8_t before;  ///< cells with fractions before those without
};

/// Into which periodic faces cut a span.
inline std::uint32_t pieces_of(const Span& span, int nx)
{
    if (span.x0 >= 0 && span.x0 + span.n <= nx) return 1;
    return (wrap(span.x0, nx) + span.n + nx - 1) / nx;
}

/// A row of the lattice as a solid in it sees it.
struct RowOfSolid {
    std::int32_t solid;
    std::int8_t image[3];  ///< of the lattice in which its cells lie as the solid's centre sees it
    std::uint8_t unit;     ///< of rows, among those that the solid lies in: which of its sums
};

/// A span, or a part of one, in a row of the lattice.
struct Piece : Span, RowOfSolid {};

/**
 * Sums over cells of a solid, eight lanes each: F, P, b and b r^2 in `plain`; rx F, rx Py, rx Pz in `x`; ry and rz times the plain ones. F is the solid
 * force, P = eps j_post, b the weight of RowSaturation; r from the solid's centre.
 */
struct alignas(64) PieceSums {
    double plain[8], x[8], y[8], z[8];
};

struct PiecesOfRow {
    const Piece *begin, *end;
    const RowSolid* solids;
    std::array<int, 3> n;  ///< cells of the lattice
    int y, z;              ///< of the row
    bool fixed;            ///< all solids of the lattice are at rest, and not free to move
};

struct SolidRowKernels {
    /// Writes what the solids say to the cells of a row, and marks the covered blocks.
    void (*saturate)(const PiecesOfRow& row, RowSaturation& cells) noexcept;
    /// Adds the cells' answers to the solids' sums.
    void (*collect)(const PiecesOfRow& row, const RowSaturation& cells, PieceSums* sums) noexcept;
};

/// The widest variant that this processor runs. All variants give the same bits.
SolidRowKernels solid_row_kernels();

}  // namespace lbm
