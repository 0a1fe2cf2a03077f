#include "firmware/machine/input_filter.hpp"

#include "CppUTest/TestHarness.h"

using cusp::machine::InputFilter;

TEST_GROUP(Input)
{
    InputFilter filter;
    void setup() override { filter.set_ticks(3); }
    void sample(std::uint16_t inputs, unsigned times)
    {
        for (unsigned i = 0; i < times; ++i) {
            filter.sample(inputs);
        }
    }
};

TEST(Input, CountsOnceItHasLasted)
{
    sample(cusp::kLimitX, 3);
    UNSIGNED_LONGS_EQUAL(0, filter.steady());
    sample(cusp::kLimitX, 1);
    UNSIGNED_LONGS_EQUAL(cusp::kLimitX, filter.steady());
    UNSIGNED_LONGS_EQUAL(0, filter.glitches());
}

TEST(Input, DoesNotCountWhereItIsNoise)
{
    for (unsigned i = 0; i < 10; ++i) {
        sample(cusp::kLimitZ | cusp::kDoor, 2);
        sample(0, 1);
    }
    UNSIGNED_LONGS_EQUAL(0, filter.steady());
    UNSIGNED_LONGS_EQUAL(20, filter.glitches());
}

TEST(Input, CountsAtOnceWithoutAFilter)
{
    filter.set_ticks(0);
    sample(cusp::kProbe, 1);
    UNSIGNED_LONGS_EQUAL(cusp::kProbe, filter.steady());
    sample(0, 1);
    UNSIGNED_LONGS_EQUAL(0, filter.steady());
}
