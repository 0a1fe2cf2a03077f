// For tests with several threads: CppUTest's leak detection is not thread-safe by default.
#pragma once

#include "CppUTest/MemoryLeakWarningPlugin.h"
#include "CppUTest/TestHarness.h"

namespace cusp::test {

inline const bool kLeaksAreCountedOnThreads = [] {
    MemoryLeakWarningPlugin::turnOnThreadSafeNewDeleteOverloads();
    return true;
}();

}  // namespace cusp::test
