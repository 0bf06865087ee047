#pragma once

#include <cstddef>
#include <memory>

namespace lbm {

/// Sustained traffic between processor and memory, with what a store reads first counted in [bytes/s].
struct Bandwidth {
    double copy;      ///< a = b: 24 bytes an element
    double triad;     ///< a = b + s c: 32 bytes an element
    double in_place;  ///< a = s a + b: 16 bytes an element, the pattern of streaming in place
};

/// Measures with arrays that are far larger than any cache, on huge pages as the populations are.
class BandwidthMeter {
public:
    explicit BandwidthMeter(int threads);  ///< >= 1
    Bandwidth best() const;                ///< of a few runs
    double triad_now() const;              ///< of one run, after one that brings the translations of its addresses back

private:
    template <class Body>
    double rate(double bytes_per_element, Body body) const;

    double triad() const;

    struct Free {
        void operator()(double* p) const noexcept;
    };
    int threads_;
    std::unique_ptr<double, Free> memory_;
};

}  // namespace lbm
