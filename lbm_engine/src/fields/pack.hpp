#pragma once

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

/// The same number of values in memory, wherever they begin. (A copy through memcpy goes by halves and over the stack.)
template <int W, class T>
struct InMemoryOf {
    using type [[gnu::vector_size(W * sizeof(T)), gnu::aligned(alignof(T)), gnu::may_alias]] = T;
};
template <int W, class T>
using InMemory = typename InMemoryOf<W, T>::type;

template <int W, class T>
[[gnu::always_inline]] inline Pack<W> load(const T* p)
{
    if constexpr (W == 1) return *p;
    else return __builtin_convertvector(*reinterpret_cast<const InMemory<W, T>*>(p), Pack<W>);
}

template <int W, class T>
[[gnu::always_inline]] inline void store(T* p, const Pack<W>& v)
{
    if constexpr (W == 1) *p = static_cast<T>(v);
    else *reinterpret_cast<InMemory<W, T>*>(p) = __builtin_convertvector(v, InMemory<W, T>);
}

}  // namespace lbm
