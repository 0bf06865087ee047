#include <cppunit/BriefTestProgressListener.h>
#include <cppunit/CompilerOutputter.h>
#include <cppunit/TestResult.h>
#include <cppunit/TestResultCollector.h>
#include <cppunit/TestRunner.h>
#include <cppunit/TestSuite.h>
#include <cppunit/extensions/TestFactoryRegistry.h>

#include <iostream>
#include <memory>
#include <string>

namespace {

// CppUnit names a suite after its class, with namespaces.
bool is_named(const CppUnit::Test& suite, const std::string& name)
{
    const std::string& full = suite.getName();
    return full == name || full.ends_with("::" + name);
}

CppUnit::Test* find(const CppUnit::Test& all, const std::string& name)
{
    for (int i = 0; i < all.getChildTestCount(); ++i)
        if (is_named(*all.getChildTestAt(i), name)) return all.getChildTestAt(i);
    return nullptr;
}

}  // namespace

/// usage: unit_tests [SUITE]: runs the suite of that class, or all.
int main(int argc, char** argv)
{
    const std::unique_ptr<CppUnit::Test> all(CppUnit::TestFactoryRegistry::getRegistry().makeTest());
    CppUnit::Test* const chosen = argc > 1 ? find(*all, argv[1]) : all.get();
    if (argc > 2 || !chosen) {
        std::cerr << "usage: unit_tests [SUITE]; the suites are\n";
        for (int i = 0; i < all->getChildTestCount(); ++i)
            std::cerr << "    " << all->getChildTestAt(i)->getName() << '\n';
        return 2;
    }

    CppUnit::TestResult events;
    CppUnit::TestResultCollector results;
    CppUnit::BriefTestProgressListener progress;
    events.addListener(&results);
    events.addListener(&progress);
    chosen->run(&events);

    CppUnit::CompilerOutputter(&results, std::cout).write();
    return results.wasSuccessful() && results.runTests() > 0 ? 0 : 1;
}
