#pragma once

#include "fields/populations.hpp"

#include <vector>

namespace lbm {

/// Asks for memory that will be read or written soon: what solids have of their own lies scattered, far from the caches.
template <class T>
void prefetch_memory(const T* begin, const T* end)
{
    for (auto line = reinterpret_cast<const char*>(begin); line < reinterpret_cast<const char*>(end);
         line += kCacheLine)
        __builtin_prefetch(line);
}
template <class T>
void prefetch_memory(const std::vector<T>& list)
{
    prefetch_memory(list.data(), list.data() + list.size());
}

}  // namespace lbm
