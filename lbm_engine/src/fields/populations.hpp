#pragma once

#include "lattice/d3q19.hpp"
#include "lattice/d3q27.hpp"

#include <array>
#include <cstddef>
#include <memory>

namespace lbm {

/// Bytes of a cache line; rows start on one.
inline constexpr std::size_t kCacheLine = 64;

/// Zeroed memory, aligned to huge pages where it is large, touched first by the threads that will sweep it.
class AlignedMemory {
public:
    explicit AlignedMemory(std::size_t bytes);
    void* data() const noexcept { return data_.get(); }
    std::size_t bytes() const noexcept { return bytes_; }

private:
    struct Free {
        void operator()(void* p) const noexcept;
    };
    std::size_t bytes_;
    std::unique_ptr<void, Free> data_;
};

/// Of a slot in memory, or a distance between slots.
using Slot = std::ptrdiff_t;

/**
 * Where the populations of lattice L live: one ghost cell around nx x ny x nz, for each row (y, z) the Q lines along x one after the
 * other. One slot per population and cell: streaming is in place (AA pattern).
 *
 * Between steps a slot holds, by the parity of the number of steps done,
 *
 *     even:  slot(i, x)        = f_i(x), ready to collide
 *     odd:   slot(opp(i), x)   = f*_i(x), collided; f_i(x) is found in slot(opp(i), x - c_i)
 *
 * so that a step, of either parity, reads and writes the same Q slots, and no other cell touches them.
 * @see Bailey, Myre, Walsh, Lilja & Saar (2009), Int. Conf. Parallel Processing, 550
 */
template <class L>
struct Layout {
    std::array<int, 3> n;  ///< cells, without ghosts
    Slot line;             ///< between populations of a row
    Slot row;              ///< between rows along y
    Slot plane;            ///< between rows along z
    Slot origin;           ///< of slot (0, 0, 0, 0)
    std::size_t slots;

    Layout(const std::array<int, 3>& cells, std::size_t slot_bytes) : n(cells)
    {
        // The right ghost of a line and the left one of the next share the padding.
        const Slot per_line = static_cast<Slot>(kCacheLine / slot_bytes);
        // An odd number of cache lines: Q lines side by side at a power of 2 would meet in few places of a cache.
        line = ((n[0] + 2 + per_line - 1) / per_line | 1) * per_line;
        row = line * L::Q;
        plane = row * (n[1] + 2);
        origin = per_line + row + plane;
        slots = static_cast<std::size_t>(plane * (n[2] + 2) + 2 * per_line);
    }

    Slot slot(int i, int x, int y, int z) const noexcept { return origin + z * plane + y * row + i * line + x; }
    Slot shift(int i) const noexcept { return L::c[i][2] * plane + L::c[i][1] * row + L::c[i][0]; }

    /// Slot of the population f_i that is about to collide in cell (x, y, z).
    Slot incoming(int i, int x, int y, int z, bool odd) const noexcept
    {
        return odd ? slot(L::opposite(i), x, y, z) - shift(i) : slot(i, x, y, z);
    }
    /// Slot of the population f*_i that left cell (x, y, z) in the last collision.
    Slot outgoing(int i, int x, int y, int z, bool odd) const noexcept
    {
        return odd ? slot(L::opposite(i), x, y, z) : slot(i, x, y, z) + shift(i);
    }
};

/// The populations of a box, and the parity that says where they stand.
template <class L, class T>
struct Populations {
    Layout<L> layout;
    AlignedMemory memory;
    bool odd = false;

    explicit Populations(const std::array<int, 3>& cells) : layout(cells, sizeof(T)), memory(layout.slots * sizeof(T))
    {
    }
    T* data() noexcept { return static_cast<T*>(memory.data()); }
    const T* data() const noexcept { return static_cast<const T*>(memory.data()); }

    void incoming(int x, int y, int z, double (&f)[L::Q]) const noexcept
    {
        for (int i = 0; i < L::Q; ++i) f[i] = data()[layout.incoming(i, x, y, z, odd)];
    }
    void outgoing(int x, int y, int z, double (&f)[L::Q]) const noexcept
    {
        for (int i = 0; i < L::Q; ++i) f[i] = data()[layout.outgoing(i, x, y, z, odd)];
    }
};

}  // namespace lbm
