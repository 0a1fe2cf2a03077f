// The numbers of a scale are round and lie on it.
#include "host_tools/judge/report/colour_scale.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::report;

namespace {

bool shows(const std::string& bar, const std::string& number)
{
    return bar.find(">" + number + "</text>") != std::string::npos;
}

}  // namespace

TEST_GROUP(ColourScale){};

TEST(ColourScale, RoundsDownToOneTwoOrFive)
{
    DOUBLES_EQUAL(50, round_below(50), 1e-12);
    DOUBLES_EQUAL(20, round_below(49.9), 1e-12);
    DOUBLES_EQUAL(0.01, round_below(0.0125), 1e-15);
    DOUBLES_EQUAL(1, round_below(0), 0);
}

TEST(ColourScale, HasRoundNumbersBetweenItsEnds)
{
    const std::string depth = scale_bar({0, 0, 100, 5}, -25.7, 0, "z");
    CHECK(shows(depth, "-25") && shows(depth, "-5") && shows(depth, "0"));
    CHECK_FALSE(shows(depth, "-30"));
    const std::string left = scale_bar({0, 0, 100, 5}, 0, 0.05, "left");
    CHECK(shows(left, "0") && shows(left, "0.01") && shows(left, "0.05"));
}

TEST(ColourScale, OfOneValueHasOneNumber)
{
    const std::string flat = scale_bar({0, 0, 100, 5}, -3, -3, "z");
    CHECK(shows(flat, "-3"));
}
