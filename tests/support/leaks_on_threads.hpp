// For tests of what works on several threads: CppUTest's list of what is allocated is for one,
// unless it is told.
#pragma once

#include "CppUTest/MemoryLeakWarningPlugin.h"
#include "CppUTest/TestHarness.h"

namespace cusp::test {

inline const bool kLeaksAreCountedOnThreads = [] {
    MemoryLeakWarningPlugin::turnOnThreadSafeNewDeleteOverloads();
    return true;
}();

}  // namespace cusp::test
