// Processes that answer, that fail, and that are ended.
#include "host_tools/cli/studio/call_process.hpp"

#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>

#include "CppUTest/TestHarness.h"

using cusp::studio::CallProcess;

namespace {

std::string all_of(CallProcess& process)
{
    constexpr int kWait = 100;  // ms
    std::string all;
    while (const std::optional<std::string> piece = process.read(kWait)) {
        all += *piece;
    }
    return all;
}

}  // namespace

TEST_GROUP(CallProcess){};

TEST(CallProcess, ItReadsItsInputAndItsOutputIsRead)
{
    std::string input;
    for (int k = 0; k < 300'000; ++k) {
        input += std::to_string(k) + "\n";  // more than a pipe holds
    }
    CallProcess process{{"/bin/cat"}, input};
    CHECK(all_of(process) == input);
    STRCMP_EQUAL("", process.fault().c_str());
}

TEST(CallProcess, HowItEndedIsSaid)
{
    CallProcess failing{{"/bin/sh", "-c", "exit 3"}, ""};
    STRCMP_EQUAL("", all_of(failing).c_str());
    STRCMP_EQUAL("the call ended with status 3", failing.fault().c_str());
    CallProcess killed{{"/bin/sh", "-c", "kill -9 $$"}, ""};
    all_of(killed);
    STRCMP_EQUAL("the call was ended by signal 9 (Killed)", killed.fault().c_str());
}

TEST(CallProcess, NothingYetIsNoEndAndItEndsWithTheObject)
{
    const auto start = std::chrono::steady_clock::now();
    {
        CallProcess process{{"/bin/sleep", "60"}, ""};
        constexpr int kShort = 20;  // ms
        STRCMP_EQUAL("", process.read(kShort).value().c_str());
    }
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds{20});
}

TEST(CallProcess, AProgramThatIsNotThereIsRefused)
{
    CHECK_THROWS(std::runtime_error, CallProcess({"/no/such/program"}, ""));
}
