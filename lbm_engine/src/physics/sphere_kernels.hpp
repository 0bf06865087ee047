#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lbm {

/// Arrays that these kernels work on have room for whole packs; what lies beyond the last element is no more than read, or overwritten.
inline constexpr std::size_t kPack = 8;

/// Cells that a pore is asked about at a time: two registers of floats.
inline constexpr std::size_t kPore = 4 * kPack;

constexpr std::size_t padded_to_packs(std::size_t n) { return (n + kPack - 1) / kPack * kPack; }

/// Numbers in memory that begins on a cache line: packs of them then cross no border of one.
template <class T>
class Packed {
public:
    /// Room for n of them; keeps what is there.
    void reserve(std::size_t n)
    {
        if (padded_to_packs(n) > kPack * packs_.size()) packs_.resize(n / kPack + 1 + packs_.size() / 2);
    }
    T* data() noexcept { return packs_.data()->numbers; }
    const T* data() const noexcept { return packs_.data()->numbers; }
    T& operator[](std::size_t i) noexcept { return data()[i]; }
    T operator[](std::size_t i) const noexcept { return data()[i]; }

private:
    struct alignas(kPack * sizeof(T)) Numbers {
        T numbers[kPack]{};
    };
    std::vector<Numbers> packs_;
};
using PackedNumbers = Packed<double>;

/// The cells of a row that a solid touches, begin to end; those from full_begin to full_end are full. Without full cells both are the end.
struct RowEnds {
    int begin = 0, full_begin = 0, full_end = 0, end = 0;
};

/// Planes of the lattice across an axis as a sphere of radius R sees them, one cell apart, from the first that may cut it on.
struct SpherePlanes {
    const double* at;      ///< from the centre, clamped to +-R
    const double* cap;     ///< G2(|at|, 0) (SphereFraction)
    const double* moment;  ///< |at| (R^2 - at^2 / 3) / 2
};

/// Corners of cells in a plane z: lines along x, one for each y.
struct CornerPlane {
    const double *x, *y, *cap;  ///< planes, and G2(|x|, 0)
    const double *xy, *xz;      ///< G2 of x and y, lines side by side, and of x and z
    const double* rest;         ///< G2(0, 0) - G2(y, 0) - G2(0, z) + G2(y, z), for each line
    std::size_t line;           ///< corners in a line, in whole packs
    int lines;
    double z, R;
};

/// Rows of cells in a plane, by the nearest and the farthest points of their cells along y, squared, as seen from the centre of a sphere.
struct PlaneOfRows {
    const double *near2, *far2;
    int count;
    double x;              ///< of the centre, from the first cell on
    int cells;             ///< of a row
    double out2, inside2;  ///< R^2 without what the nearest and the farthest points along z take
};

/// The cells of a row that are kept: some before and some after those that are full.
struct CutRow {
    const double* fractions;  ///< of all of them
    int before, full, after;
    std::array<double, 3> first;  ///< centre of the first one
};

/// A pore between a sphere and what stands opposite (CutCells), in the form h = curvature r^2 - r.towards + distance. Its law is an empirical one: 32 bits do.
struct PoreShape {
    std::array<float, 3> towards;
    float curvature, distance, over_widest, near, far;
    float facing, curvature2;  ///< C / R1 and 1 / R2
    float inner2;              ///< no cell whose centre is nearer than this, squared, is cut
};

/// What takes time when spheres are mapped (SphereFraction, CutCells).
struct SphereKernels {
    /// G2 of pairs of planes p (a line) and q (one line for each).
    void (*pair_table)(const SpherePlanes& p, std::size_t line, const SpherePlanes& q, int lines, double R,
                       double* table) noexcept;
    /**
     * Fractions of the cells between a plane of corners and the one before.
     * @param along_y   differences of H along y in the plane before; become those of this one
     * @param mixed     scratch, a pack more than there are corners
     * @param small     fractions nearer to 0 or 1 are round-off
     * @param fraction  null: there is no plane before
     */
    void (*fractions)(const CornerPlane& plane, double* along_y, double* mixed, double small,
                      double* fraction) noexcept;
    void (*ends)(const PlaneOfRows& rows, RowEnds* ends) noexcept;
    /// Copies the cells of rows one after the other: fractions and places.
    void (*gather)(const CutRow* row, const CutRow* end, double* fraction, float* x, float* y, float* z) noexcept;
    /// Raises the thickening of cells, kPore at a time, by what a pore asks for.
    void (*narrow)(const PoreShape& pore, const float* x, const float* y, const float* z, std::size_t count,
                   float* thickening) noexcept;
    /// Thickens fractions, in whole packs.
    void (*thicken)(const float* thickening, std::size_t count, double* fraction) noexcept;
};

/// The widest variant that this processor runs. All variants give the same bits.
const SphereKernels& sphere_kernels();

}  // namespace lbm
