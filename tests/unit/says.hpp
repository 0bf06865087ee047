#pragma once

#include <cppunit/TestAssert.h>

#include <functional>
#include <string>

namespace lbm::test {

/// What an exception of the wanted type says; empty if nothing was thrown.
template <class Error>
std::string says(const std::function<void()>& action)
{
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

inline void assert_says(const std::string& message, const std::string& part)
{
    CPPUNIT_ASSERT_MESSAGE("\"" + message + "\" does not say \"" + part + "\"",
                           message.find(part) != std::string::npos);
}

}  // namespace lbm::test
