// Runs all tests, as CppUTest's runner does without arguments.
#pragma once

#include "CppUTest/TestHarness.h"

struct CommandLineTestRunner {
    static int RunAllTests(int /*count*/, char** /*arguments*/) { return UtestShell::run_all(); }
};
