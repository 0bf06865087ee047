#include "bandwidth.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>

namespace lbm {
namespace {

constexpr std::ptrdiff_t kElements = std::ptrdiff_t{1} << 25;  // 256 MB an array
constexpr int kRuns = 5;

template <class Body>
double best_rate(double bytes_per_element, int threads, Body body)
{
    double best = 0;
    for (int run = 0; run < kRuns; ++run) {
        const auto start = std::chrono::steady_clock::now();
#pragma omp parallel for schedule(static) num_threads(threads)
        for (std::ptrdiff_t i = 0; i < kElements; ++i) body(i);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        best = std::max(best, bytes_per_element * kElements / seconds);
    }
    return best;
}

}  // namespace

Bandwidth measure_bandwidth(int threads)
{
    const std::unique_ptr<double[]> memory(new double[3 * kElements]);  // touched first in parallel
    double* const a = memory.get();
    double* const b = a + kElements;
    double* const c = b + kElements;
#pragma omp parallel for schedule(static) num_threads(threads)
    for (std::ptrdiff_t i = 0; i < kElements; ++i) {
        a[i] = 0;
        b[i] = 1;
        c[i] = 2;
    }
    Bandwidth result{};
    result.copy = best_rate(24, threads, [=](std::ptrdiff_t i) { a[i] = 1.5 * b[i]; });
    result.triad = best_rate(32, threads, [=](std::ptrdiff_t i) { a[i] = b[i] + 1.5 * c[i]; });
    result.in_place = best_rate(16, threads, [=](std::ptrdiff_t i) { a[i] = 0.5 * a[i] + 1.0; });
    return result;
}

}  // namespace lbm
