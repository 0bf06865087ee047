#pragma once

namespace lbm {

/// W numbers side by side, on which the arithmetic operators work lane by lane: the collision is written once for all W.
template <int W, class S>
struct PackOf {
    using type [[gnu::vector_size(W * sizeof(S))]] = S;
};
template <class S>
struct PackOf<1, S> {
    using type = S;
};
template <int W, class S = double>
using Pack = typename PackOf<W, S>::type;

/// The same number of values in memory, wherever they begin. (A copy through memcpy goes by halves and over the stack.)
template <int W, class T>
struct InMemoryOf {
    using type [[gnu::vector_size(W * sizeof(T)), gnu::aligned(alignof(T)), gnu::may_alias]] = T;
};
template <int W, class T>
using InMemory = typename InMemoryOf<W, T>::type;

template <int W, class S = double, class T>
[[gnu::always_inline]] inline Pack<W, S> load(const T* p)
{
    if constexpr (W == 1) return *p;
    else return __builtin_convertvector(*reinterpret_cast<const InMemory<W, T>*>(p), Pack<W, S>);
}

template <int W, class S = double, class T>
[[gnu::always_inline]] inline void store(T* p, const Pack<W, S>& v)
{
    if constexpr (W == 1) *p = static_cast<T>(v);
    else *reinterpret_cast<InMemory<W, T>*>(p) = __builtin_convertvector(v, InMemory<W, T>);
}

}  // namespace lbm
