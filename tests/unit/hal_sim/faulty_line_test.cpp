// A line that damages bytes.
#include "hal/sim/faulty_line.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp::hal;

TEST_GROUP(FaultyLine){static std::string pass(const LineFaults& faults,
                                               const std::string& text){FaultyLine line{faults, 1};
line.put(text);
return line.take();
}
}
;

TEST(FaultyLine, PassesEverythingOnWithoutFaults)
{
    STRCMP_EQUAL("G1 X1\n", pass({}, "G1 X1\n").c_str());
}

TEST(FaultyLine, FlipsOneBitOfAboutAsManyBytesAsAsked)
{
    LineFaults faults;
    faults.noise = 0.1;
    const std::string out = pass(faults, std::string(10'000, 'x'));
    LONGS_EQUAL(10'000, out.size());
    int damaged = 0;
    for (const char byte : out) {
        const auto bits = static_cast<unsigned char>(byte ^ 'x');
        CHECK((bits & (bits - 1)) == 0);
        damaged += bits != 0 ? 1 : 0;
    }
    CHECK(damaged > 900 && damaged < 1100);
}

TEST(FaultyLine, LosesAndDoublesBytes)
{
    LineFaults faults;
    faults.loss = 0.1;
    CHECK(pass(faults, std::string(10'000, 'x')).size() < 9'200);
    faults.loss = 0.0;
    faults.doubling = 0.1;
    CHECK(pass(faults, std::string(10'000, 'x')).size() > 10'800);
}

TEST(FaultyLine, DelaysBytesButKeepsTheirOrder)
{
    LineFaults faults;
    faults.delay = 1.0;
    FaultyLine line{faults, 3};
    line.put("abcdefgh");
    STRCMP_EQUAL("", line.take().c_str());
    std::string all;
    for (int tick = 0; tick < 30; ++tick) {
        line.advance();
        all += line.take();
    }
    STRCMP_EQUAL("abcdefgh", all.c_str());
}
