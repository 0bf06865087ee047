#pragma once

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

namespace yadelbm {

/// The declarations that this library was built with are not those of the YADE that runs.
class LayoutMismatch : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/**
 * Compares memory of the running YADE with what the declarations say. Reads through the kernel, which refuses a bad
 * address instead of crashing, and inside the allocation of an object only.
 *
 * For tests, the environment variable YADELBM_SIMULATE_LAYOUT="Class.member=OFFSET" pretends that a member is declared
 * at another offset [bytes].
 */
class LayoutProbe {
public:
    LayoutProbe();

    /// @throws LayoutMismatch  if the allocation cannot hold `size` bytes, or is much larger
    void require_size(const char* class_name, const void* object, std::size_t size) const;

    /// @throws LayoutMismatch  if the bytes at `offset` are not those of `expected`
    template <class T>
    void require(const char* member, const void* object, std::size_t offset, const T& expected) const
    {
        require_bytes(member, object, offset, &expected, sizeof(T));
    }

    void require_bytes(const char* member, const void* object, std::size_t offset, const void* expected,
                       std::size_t size) const;

    /// @throws LayoutMismatch  if the address cannot be read
    template <class T>
    T read(const char* member, const void* object, std::size_t offset) const
    {
        T value;
        read_bytes(member, object, offset, &value, sizeof(T));
        return value;
    }

    [[noreturn]] static void mismatch(const std::string& difference);

private:
    void read_bytes(const char* member, const void* object, std::size_t offset, void* to, std::size_t size) const;
    std::size_t declared(const char* member, std::size_t offset) const;

    std::string simulated_member_;
    std::size_t simulated_offset_ = 0;
};

}  // namespace yadelbm
