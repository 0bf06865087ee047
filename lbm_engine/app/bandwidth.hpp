#pragma once

namespace lbm {

/// Sustained traffic between processor and memory, with what a store reads first counted in [bytes/s].
struct Bandwidth {
    double copy;      ///< a = b: 24 bytes an element
    double triad;     ///< a = b + s c: 32 bytes an element
    double in_place;  ///< a = s a + b: 16 bytes an element, the pattern of streaming in place
};

/**
 * Best of a few runs over arrays far larger than any cache.
 * @param threads  >= 1
 */
Bandwidth measure_bandwidth(int threads);

}  // namespace lbm
