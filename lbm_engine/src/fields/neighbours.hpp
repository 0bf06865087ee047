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
    Vec3 shift{};
    int bin_at[3], turns[3];
    const auto go_to = [&](int d) {
        turns[d] = at[d] >= 0 ? at[d] / bins_[d] : -((bins_[d] - 1 - at[d]) / bins_[d]);
        shift[d] = static_cast<double>(turns[d]) * n_[d];
        bin_at[d] = at[d] - turns[d] * bins_[d];
    };
    for (at[2] = first[2]; at[2] <= last[2]; ++at[2]) {
        go_to(2);
        for (at[1] = first[1]; at[1] <= last[1]; ++at[1]) {
            go_to(1);
            for (at[0] = first[0]; at[0] <= last[0]; ++at[0]) {
                go_to(0);
                const bool turned = turns[0] != 0 || turns[1] != 0 || turns[2] != 0;
                const std::size_t other =
                    (static_cast<std::size_t>(bin_at[2]) * bins_[1] + bin_at[1]) * bins_[0] + bin_at[0];
                for (std::int32_t i = begin_[other]; i < begin_[other + 1]; ++i)
                    if (in_bin_[i] != point || turned) body(in_bin_[i], shift);
            }
        }
    }
}

}  // namespace lbm
