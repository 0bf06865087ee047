#pragma once

#include "lattice/vec3.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lbm {

/**
 * Who is near whom, in a box that may be periodic: points sorted into bins that are as wide as the range, where the box allows it.
 */
class Neighbours {
public:
    /**
     * @param cells     of the box
     * @param periodic  for each axis
     */
    Neighbours(const std::array<int, 3>& cells, const std::array<bool, 3>& periodic) : n_(cells), periodic_(periodic) {}

    /**
     * @param points  inside the box along periodic axes
     * @param range   > 0: up to which distance neighbours will be asked for [cells]
     */
    void sort(const std::vector<Vec3>& points, double range);

    /// Calls body(other, shift) for all images (place: that of the point + shift) that may be within the range of a point; its own images are among them, it is not.
    template <class Body>
    void for_near(std::int32_t point, Body body) const;

private:
    std::array<int, 3> n_;
    std::array<bool, 3> periodic_;
    std::array<int, 3> bins_{}, reach_{};
    std::vector<std::int32_t> begin_, next_, in_bin_, bin_of_;  // counting sort
};

template <class Body>
void Neighbours::for_near(std::int32_t point, Body body) const
{
    int bin[3], rest = bin_of_[point];
    for (int d = 0; d < 3; ++d) {
        bin[d] = rest % bins_[d];
        rest /= bins_[d];
    }
    int first[3], last[3], at[3];
    for (int d = 0; d < 3; ++d) {
        first[d] = bin[d] - reach_[d];
        last[d] = bin[d] + reach_[d];
        if (!periodic_[d]) {
            first[d] = std::max(first[d], 0);
            last[d] = std::min(last[d], bins_[d] - 1);
        }
    }
    for (at[2] = first[2]; at[2] <= last[2]; ++at[2])
        for (at[1] = first[1]; at[1] <= last[1]; ++at[1])
            for (at[0] = first[0]; at[0] <= last[0]; ++at[0]) {
                Vec3 shift{};
                std::size_t other = 0;
                bool turned = false;
                for (int d = 2; d >= 0; --d) {
                    const int turns = static_cast<int>(std::floor(static_cast<double>(at[d]) / bins_[d]));
                    turned = turned || turns != 0;
                    shift[d] = static_cast<double>(turns) * n_[d];
                    other = other * bins_[d] + (at[d] - turns * bins_[d]);
                }
                for (std::int32_t i = begin_[other]; i < begin_[other + 1]; ++i)
                    if (in_bin_[i] != point || turned) body(in_bin_[i], shift);
            }
}

}  // namespace lbm
