#include "fields/neighbours.hpp"

#include <algorithm>

namespace lbm {

void Neighbours::sort(const std::vector<Vec3>& points, double range)
{
    std::size_t count = 1;
    for (int d = 0; d < 3; ++d) {
        bins_[d] = std::max(1, static_cast<int>(n_[d] / range));
        const double reach = std::ceil(range * bins_[d] / n_[d]);
        reach_[d] = static_cast<int>(periodic_[d] ? reach : std::min<double>(reach, bins_[d]));
        count *= bins_[d];
    }
    bin_of_.resize(points.size());
    begin_.assign(count + 1, 0);
    for (std::size_t p = 0; p < points.size(); ++p) {
        std::int32_t bin = 0;
        for (int d = 2; d >= 0; --d) {
            const double place = std::floor(points[p][d] * bins_[d] / n_[d]);
            bin = bin * bins_[d] + static_cast<std::int32_t>(std::clamp(place, 0.0, bins_[d] - 1.0));
        }
        bin_of_[p] = bin;
        ++begin_[bin + 1];
    }
    for (std::size_t b = 0; b < count; ++b) begin_[b + 1] += begin_[b];
    in_bin_.resize(points.size());
    next_.assign(begin_.begin(), begin_.end() - 1);
    for (std::size_t p = 0; p < points.size(); ++p) in_bin_[next_[bin_of_[p]]++] = static_cast<std::int32_t>(p);
}

}  // namespace lbm
