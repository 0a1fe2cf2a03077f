// Decimal numbers: exact lengths, and what is no number.
#include "firmware/gcode/decimal.hpp"

#include <cstdio>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::gcode;

namespace {

Decimal decimal(std::string_view text)
{
    std::size_t place = 0;
    const Result<Decimal> value = read_decimal(text, place);
    CHECK(static_cast<bool>(value));
    LONGS_EQUAL(text.size(), place);
    return *value;
}

std::int64_t nanometres(std::string_view text, bool inches = false)
{
    const Result<ExactLength> length = to_length(decimal(text), inches);
    CHECK(static_cast<bool>(length));
    return length->rounded();
}

}  // namespace

TEST_GROUP(Decimal) { std::mt19937_64 random{3}; };

TEST(Decimal, IsExactToSixDecimalsInMillimetresAndFiveInInches)
{
    LONGS_EQUAL(1234567, nanometres("1.234567"));
    LONGS_EQUAL(-1, nanometres("-0.000001"));
    LONGS_EQUAL(500000, nanometres("+.5"));
    LONGS_EQUAL(5000000, nanometres("5."));
    LONGS_EQUAL(254, nanometres("0.00001", true));
    LONGS_EQUAL(25400000 + 254, nanometres("1.00001", true));
    LONGS_EQUAL(99999999999, nanometres("99999.999999"));
}

TEST(Decimal, RoundTripsEveryNanometreCount)
{
    std::uniform_int_distribution<std::int64_t> counts{-kMaxCoordinateNm + 1, kMaxCoordinateNm - 1};
    for (int i = 0; i < 100000; ++i) {
        const std::int64_t nm = counts(random);
        const std::int64_t size = nm < 0 ? -nm : nm;
        char text[40];
        (void)std::snprintf(text, sizeof text, "%s%lld.%06lld", nm < 0 ? "-" : "",
                            static_cast<long long>(size / 1000000),
                            static_cast<long long>(size % 1000000));
        LONGS_EQUAL(nm, nanometres(text));
    }
}

TEST(Decimal, CarriesDigitsBelowANanometre)
{
    // A third of a micrometre, three times: the sum is rounded, not each.
    const ExactLength third = *to_length(decimal("0.000333333333"), false);
    ExactLength sum;
    for (int i = 0; i < 3000000; ++i) {
        sum = sum + third;
    }
    LONGS_EQUAL(999999999, sum.rounded());
    // 0.0000003 in = 7.62 nm
    const ExactLength small = *to_length(decimal("0.0000003"), true);
    LONGS_EQUAL(7, small.nm);
    LONGS_EQUAL(620000, small.millionths);
    const ExactLength negative = *to_length(decimal("-0.0000003"), true);
    LONGS_EQUAL(-8, negative.nm);
    LONGS_EQUAL(380000, negative.millionths);
    LONGS_EQUAL(0, (small + negative).rounded());
}

TEST(Decimal, ReadsNoExponent)
{
    std::size_t place = 0;
    CHECK(static_cast<bool>(read_decimal("1e3", place)));
    LONGS_EQUAL(1, place);
}

TEST(Decimal, RefusesWhatHasNoDigitOrTooMany)
{
    for (const char* text : {"", "-", "+", ".", "-.", "x"}) {
        std::size_t place = 0;
        CHECK(Error::kBadNumberFormat == read_decimal(text, place).error());
    }
    std::size_t place = 0;
    CHECK(Error::kGcodeMaxValueExceeded == read_decimal("1234567890123", place).error());
    CHECK(Error::kGcodeMaxValueExceeded == to_length(decimal("100001"), false).error());
    CHECK(Error::kGcodeMaxValueExceeded == to_length(decimal("-4000"), true).error());
}

TEST(Decimal, RoundsDigitsBeyondTheSeventeenth)
{
    DOUBLES_EQUAL(0.1, to_double(decimal("0.1000000000000000000000000000000000001")), 0);
    DOUBLES_EQUAL(1, to_double(decimal("0.99999999999999999999999999")), 0);
    DOUBLES_EQUAL(46.3799497524505, to_double(decimal("46.3799497524505")), 0);
}

TEST(Decimal, KnowsWholeNumbers)
{
    CHECK(is_whole(decimal("3.0"), 5));
    CHECK(!is_whole(decimal("3.1"), 5));
    CHECK(!is_whole(decimal("6"), 5));
    CHECK(!is_whole(decimal("-1"), 5));
    LONGS_EQUAL(3, whole_part(decimal("3.00")));
}
