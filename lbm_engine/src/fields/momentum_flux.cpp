#include "fields/momentum_flux.hpp"

#include <vector>

namespace lbm {

template <class L, class T>
Mat3 momentum_flux(const Populations<L, T>& populations)
{
    const auto [nx, ny, nz] = populations.layout.n;
    const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(ny) * nz;
    std::vector<Mat3> rows(count, Mat3{});  // added up in order: the same bits for any number of threads
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t row = 0; row < count; ++row) {
        double sum[L::Q] = {};
        for (int x = 0; x < nx; ++x) {
            double leaving[L::Q], arriving[L::Q];
            populations.outgoing(x, static_cast<int>(row % ny), static_cast<int>(row / ny), leaving);
            populations.incoming(x, static_cast<int>(row % ny), static_cast<int>(row / ny), arriving);
            for (int i = 0; i < L::Q; ++i) sum[i] += 0.5 * (leaving[i] + arriving[i]);
        }
        for (int i = 0; i < L::Q; ++i)
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) rows[row][a][b] += L::c[i][a] * L::c[i][b] * sum[i];
    }
    Mat3 total{};
    for (const Mat3& row : rows)
        for (int a = 0; a < 3; ++a) total[a] += row[a];
    return total;
}

template Mat3 momentum_flux(const Populations<D3Q19, double>&);
template Mat3 momentum_flux(const Populations<D3Q19, float>&);
template Mat3 momentum_flux(const Populations<D3Q27, double>&);
template Mat3 momentum_flux(const Populations<D3Q27, float>&);

}  // namespace lbm
