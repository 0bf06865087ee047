// What a SolidMap says to the rows of the lattice, and hears from them.

#include "fields/solid_map.hpp"

#include "fields/populations.hpp"

namespace lbm {

PiecesOfRow SolidMap::pieces(std::size_t row) const noexcept
{
    return {pieces_.data() + row_begin_[row], pieces_.data() + row_end_[row], row_solids_.data(), n_,
            static_cast<int>(row % n_[1]),    static_cast<int>(row / n_[1]),  all_fixed_};
}

void SolidMap::prefetch(std::size_t row) const noexcept
{
    if (row == row_begin_.size()) return;
    const Piece* const next = pieces_.data() + row_end_[row];  // of the row after it, about as many
    for (const Piece* line = next; line < next + (row_end_[row] - row_begin_[row]); line += kCacheLine / sizeof(Piece))
        __builtin_prefetch(line);
    for (std::uint32_t p = row_begin_[row]; p < row_end_[row]; ++p) {
        const Piece& piece = pieces_[p];
        const RowSolid& solid = row_solids_[piece.solid];
        const PieceSums& sums = sums_[solid.sums + piece.unit];
        for (const double* const lanes : {sums.plain, sums.x, sums.y, sums.z}) __builtin_prefetch(lanes, 1);
        const double* const fractions = solid.fractions + piece.fractions;
        const int stored = piece.n - piece.full;
        // Blocks are read whole: up to kBlock - 1 beyond the end.
        for (int i = 0; i < stored + kBlock - 1; i += kBlock) __builtin_prefetch(fractions + i);
        __builtin_prefetch(fractions + stored + kBlock - 2);
    }
}

void SolidMap::saturate(std::size_t row, RowSaturation& cells) const
{
    static const auto kernel = solid_row_kernels().saturate;
    kernel(pieces(row), cells);
}

void SolidMap::collect(std::size_t row, RowSaturation& cells)
{
    static const auto kernel = solid_row_kernels().collect;
    kernel(pieces(row), cells, sums_.data());
    cells.clear();
}

void SolidMap::clear_sums()
{
    const auto count = static_cast<std::ptrdiff_t>(sums_.size());
#pragma omp parallel for schedule(static) if (count > 256)
    for (std::ptrdiff_t i = 0; i < count; ++i) sums_[i] = PieceSums{};
}

SolidSums SolidMap::sums(std::size_t solid) const
{
    PieceSums s{};
    for (std::uint32_t i = sums_begin_[solid]; i < sums_begin_[solid + 1]; ++i)
        for (int l = 0; l < 8; ++l) {
            s.plain[l] += sums_[i].plain[l];
            s.x[l] += sums_[i].x[l];
            s.y[l] += sums_[i].y[l];
            s.z[l] += sums_[i].z[l];
        }
    SolidSums total;
    for (int d = 0; d < 3; ++d) {
        total.force[d] = s.plain[d];
        total.momentum[d] = s.plain[3 + d];
        total.first_moment[0][d] = s.x[d];
        total.first_moment[1][d] = s.y[d];
        total.first_moment[2][d] = s.z[d];
    }
    const double xPy = s.x[3], xPz = s.x[4];
    total.angular_momentum = {s.y[5] - s.z[4], s.z[3] - xPz, xPy - s.y[3]};
    total.coupling = s.plain[6];
    total.spin_coupling = (2.0 / 3) * s.plain[7];
    return total;
}

}  // namespace lbm
