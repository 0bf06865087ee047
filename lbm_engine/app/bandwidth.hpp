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

/// Measures with arrays that are far larger than any cache.
class BandwidthMeter {
public:
    explicit BandwidthMeter(int threads);  ///< >= 1
    Bandwidth best() const;                ///< of a few runs
    double triad_now() const;              ///< of one run

private:
    template <class Body>
    double rate(double bytes_per_element, Body body) const;

    int threads_;
    std::unique_ptr<double[]> memory_;
};

}  // namespace lbm
