#include "fields/populations.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

namespace lbm {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;

}  // namespace

void AlignedMemory::Free::operator()(void* p) const noexcept { std::free(p); }

AlignedMemory::AlignedMemory(std::size_t bytes) : bytes_(bytes)
{
    const std::size_t alignment = bytes >= 2 * kHugePage ? kHugePage : kCacheLine;
    const std::size_t size = (bytes + alignment - 1) / alignment * alignment;
    data_.reset(std::aligned_alloc(alignment, size));
    if (!data_) throw std::bad_alloc();
    if (alignment == kHugePage) madvise(data_.get(), size, MADV_HUGEPAGE);
    char* const begin = static_cast<char*>(data_.get());
    const auto pages = static_cast<std::ptrdiff_t>((size + kHugePage - 1) / kHugePage);
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t page = 0; page < pages; ++page) {
        const std::size_t from = static_cast<std::size_t>(page) * kHugePage;
        std::memset(begin + from, 0, std::min(kHugePage, size - from));
    }
}

}  // namespace lbm
