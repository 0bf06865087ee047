#include "bandwidth.hpp"

#include <omp.h>
#include <sys/mman.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <new>

namespace lbm {
namespace {

constexpr std::ptrdiff_t kElements = std::ptrdiff_t{1} << 25;  // 256 MB an array
constexpr std::size_t kBytes = 3 * kElements * sizeof(double);
constexpr std::size_t kHugePage = std::size_t{1} << 21;
constexpr int kRuns = 5;

}  // namespace

void BandwidthMeter::Free::operator()(double* p) const noexcept { std::free(p); }

BandwidthMeter::BandwidthMeter(int threads)
    : threads_(threads)
    , memory_(static_cast<double*>(std::aligned_alloc(kHugePage, kBytes)))
{
    if (!memory_) throw std::bad_alloc();
    madvise(memory_.get(), kBytes, MADV_HUGEPAGE);
    double* const a = memory_.get();
#pragma omp parallel for schedule(static) num_threads(threads_)
    for (std::ptrdiff_t i = 0; i < kElements; ++i) {  // touched first by the threads that will use them
        a[i] = 0;
        a[kElements + i] = 1;
        a[2 * kElements + i] = 2;
    }
}

template <class Body>
double BandwidthMeter::rate(double bytes_per_element, Body body) const
{
    const auto start = std::chrono::steady_clock::now();
#pragma omp parallel for schedule(static) num_threads(threads_)
    for (std::ptrdiff_t i = 0; i < kElements; ++i) body(i);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return bytes_per_element * kElements / seconds;
}

double BandwidthMeter::triad_now() const
{
    triad();
    return triad();
}

double BandwidthMeter::triad() const
{
    double* const a = memory_.get();
    double *const b = a + kElements, *const c = b + kElements;
    return rate(32, [=](std::ptrdiff_t i) { a[i] = b[i] + 1.5 * c[i]; });
}

Bandwidth BandwidthMeter::best() const
{
    double* const a = memory_.get();
    double* const b = a + kElements;
    Bandwidth best{};
    for (int run = 0; run < kRuns; ++run) {
        best.copy = std::max(best.copy, rate(24, [=](std::ptrdiff_t i) { a[i] = 1.5 * b[i]; }));
        best.triad = std::max(best.triad, triad());
        best.in_place = std::max(best.in_place, rate(16, [=](std::ptrdiff_t i) { a[i] = 0.5 * a[i] + 1.0; }));
    }
    return best;
}

}  // namespace lbm
