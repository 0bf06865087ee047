#include "layout_probe.hpp"

#include <malloc.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace yadelbm {
namespace {

std::string hex(const std::vector<unsigned char>& bytes)
{
    std::string result;
    for (unsigned char byte : bytes) {
        std::array<char, 3> digits{};
        std::snprintf(digits.data(), digits.size(), "%02x", byte);
        result += digits.data();
    }
    return result;
}

/// Without the permission to ask the kernel nothing can be verified, and nothing is loaded.
bool read_safely(const void* from, void* to, std::size_t size)
{
    const iovec local{to, size};
    const iovec remote{const_cast<void*>(from), size};
    if (process_vm_readv(getpid(), &local, 1, &remote, 1, 0) == static_cast<ssize_t>(size)) return true;
    std::FILE* memory = std::fopen("/proc/self/mem", "rb");
    if (!memory) return false;
    std::setvbuf(memory, nullptr, _IONBF, 0);
    const bool done = std::fseek(memory, static_cast<long>(reinterpret_cast<std::size_t>(from)), SEEK_SET) == 0 &&
                      std::fread(to, 1, size, memory) == size;
    std::fclose(memory);
    return done;
}

}  // namespace

LayoutProbe::LayoutProbe()
{
    const char* variable = std::getenv("YADELBM_SIMULATE_LAYOUT");
    const std::string text = variable ? variable : "";
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) return;
    simulated_member_ = text.substr(0, equals);
    simulated_offset_ = std::strtoul(text.c_str() + equals + 1, nullptr, 10);
}

std::size_t LayoutProbe::declared(const char* member, std::size_t offset) const
{
    return simulated_member_ == member ? simulated_offset_ : offset;
}

void LayoutProbe::require_size(const char* class_name, const void* object, std::size_t size) const
{
    const std::string name = std::string("sizeof ") + class_name;
    size = declared(name.c_str(), size);
    const std::size_t allocated = malloc_usable_size(const_cast<void*>(object));
    // allocators round up, by a quarter at most
    if (allocated < size || allocated > size + size / 4 + 64)
        mismatch(name + ": declared " + std::to_string(size) + " bytes, YADE allocates " + std::to_string(allocated));
}

void LayoutProbe::require_bytes(const char* member, const void* object, std::size_t offset, const void* expected,
                                std::size_t size) const
{
    std::vector<unsigned char> found(size), wanted(size);
    read_bytes(member, object, offset, found.data(), size);
    std::memcpy(wanted.data(), expected, size);
    if (found != wanted)
        mismatch(std::string(member) + " at byte " + std::to_string(declared(member, offset)) + ": expected " +
                 hex(wanted) + ", found " + hex(found));
}

void LayoutProbe::read_bytes(const char* member, const void* object, std::size_t offset, void* to,
                             std::size_t size) const
{
    offset = declared(member, offset);
    if (!read_safely(static_cast<const char*>(object) + offset, to, size))
        mismatch(std::string(member) + " at byte " + std::to_string(offset) + " cannot be read");
}

void LayoutProbe::mismatch(const std::string& difference) { throw LayoutMismatch(difference); }

}  // namespace yadelbm
