#pragma once

#include <cstring>
#include <type_traits>

namespace lbm {

/// W doubles side by side, on which the arithmetic operators work lane by lane: the collision is written once for all W.
template <int W>
struct PackOf {
    using type [[gnu::vector_size(W * sizeof(double))]] = double;
};
template <>
struct PackOf<1> {
    using type = double;
};
template <int W>
using Pack = typename PackOf<W>::type;

template <int W, class T>
[[gnu::always_inline]] inline Pack<W> load(const T* p)
{
    if constexpr (W == 1) {
        return *p;
    } else {
        using Raw [[gnu::vector_size(W * sizeof(T))]] = T;
        Raw raw;
        std::memcpy(&raw, p, sizeof(raw));
        return __builtin_convertvector(raw, Pack<W>);
    }
}

template <int W, class T>
[[gnu::always_inline]] inline void store(T* p, const Pack<W>& v)
{
    if constexpr (W == 1) {
        *p = static_cast<T>(v);
    } else {
        using Raw [[gnu::vector_size(W * sizeof(T))]] = T;
        const Raw raw = __builtin_convertvector(v, Raw);
        std::memcpy(p, &raw, sizeof(raw));
    }
}

}  // namespace lbm
