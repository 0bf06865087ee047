#pragma once

#include "lbm/solid.hpp"
#include "physics/sphere_kernels.hpp"

#include <array>
#include <vector>

namespace lbm {

/**
 * Exact solid fractions of the unit cells that a sphere touches.
 *
 * With H(a, b, c) the volume that the sphere, centred at the origin, shares with the box [0,a]x[0,b]x[0,c] (odd in each
 * argument), the volume in any cell is the mixed difference of H over its eight corners. H is a b c where the corner lies inside the sphere; outside
 *
 *     H = G2(0,0) - G2(a,0) - G2(b,0) - G2(c,0) + G2(a,b) + G2(b,c) + G2(a,c)
 *
 * with G2(a, b) the volume of the part of the sphere with x > a, y > b, z > 0, known in closed form. So a sphere costs three tables of G2 over pairs of
 * lattice planes and a few additions per corner. The error is round-off, of the order of 1e-16 R^3.
 */
class SphereFraction {
public:
    /**
     * Evaluates the fractions. Buffers are kept from call to call.
     * @param centre  in cells; cell i reaches from i to i + 1
     * @param radius  in cells, > 0
     */
    void evaluate(const Vec3& centre, double radius);

    const std::array<int, 3>& first() const noexcept { return first_; }  ///< lowest cell of the bounding box
    const std::array<int, 3>& count() const noexcept { return count_; }  ///< its cells
    const double* row(int j, int k) const noexcept;      ///< fractions of count()[0] cells in row (j, k)
    std::size_t line() const noexcept { return line_; }  ///< between rows; a line, at least 8, may be read after a row
    const RowEnds* ends() const noexcept
    {
        return ends_.data();
    }  ///< of the rows of count()[1] x count()[2], counted from first()[0]

private:
    void find_ends();

    SpherePlanes planes(int axis) const noexcept
    {
        return {plane_[axis].data(), cap_[axis].data(), moment_[axis].data()};
    }

    Vec3 centre_{};
    double R_ = 0;
    std::array<int, 3> first_{}, count_{};
    std::array<PackedNumbers, 3> plane_, cap_, moment_;  // SpherePlanes
    std::array<PackedNumbers, 3> pairs_;                 // G2 of planes (x,y), (y,z), (x,z)
    std::size_t line_ = 0;                               // between rows of fractions
    PackedNumbers rest_, along_y_, mixed_;               // while evaluating
    PackedNumbers fraction_;
    std::array<PackedNumbers, 2> near2_, far2_;  // of cells along y and z from the centre, squared
    std::vector<RowEnds> ends_;
};

}  // namespace lbm
