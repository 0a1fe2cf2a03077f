// Moving averages that lose nothing.
#include "firmware/interpolator/box_filter.hpp"

#include <cstdint>
#include <random>

#include "CppUTest/TestHarness.h"

using namespace cusp::interpolator;

TEST_GROUP(BoxFilters){};

TEST(BoxFilters, WhatGoesInComesOutToTheLastUnit)
{
    std::mt19937_64 random{811};
    for (std::uint32_t length = 1; length <= 50; ++length) {
        RunningSum<std::int32_t, 50> filter;
        filter.set_length(length);
        ExactDivision division;
        division.set(static_cast<std::int32_t>(length), 0);
        std::int64_t in = 0;
        std::int64_t out = 0;
        for (int k = 0; k < 500; ++k) {
            const auto value =
                static_cast<std::int32_t>(static_cast<std::int64_t>(random() % 20001) - 10000);
            in += value;
            out += division.divide(filter.add(value));
        }
        std::uint32_t ticks = 0;
        while (!filter.drained()) {
            LONGS_EQUAL(length - ticks, filter.ticks_left());
            out += division.divide(filter.add(0));
            ++ticks;
        }
        CHECK(in == out);
    }
}

TEST(BoxFilters, ADivisionRoundsDownAndKeepsTheRest)
{
    ExactDivision division;
    division.set(7, 0);
    LONGS_EQUAL(-1, division.divide(-1));
    LONGS_EQUAL(0, division.divide(0));
    LONGS_EQUAL(1, division.divide(1 + 0 + 1));
}
