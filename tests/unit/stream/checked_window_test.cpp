// Checked lines: numbers, CRCs, and going back.
#include "host_tools/controller/stream/checked_window.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::stream;

TEST_GROUP(CheckedWindow)
{
    CheckedWindow window{1024};
    CheckedWindow::Clock::time_point now{};
};

TEST(CheckedWindow, WritesLinesAsTheProtocolsExample)
{
    STRCMP_EQUAL("N1G21*A00D41FF", checked_line(1, "G21").c_str());
    STRCMP_EQUAL("N2G0X5*5908B732", checked_line(2, "G0X5").c_str());
}

TEST(CheckedWindow, BelievesOnlyAnswersWhoseCheckIsRight)
{
    STRCMP_EQUAL("ok N1", checked_answer("ok N1*360E43D2")->c_str());
    CHECK_FALSE(checked_answer("ok N2*360E43D2").has_value());
    CHECK_FALSE(checked_answer("ok").has_value());
    CHECK_FALSE(checked_answer("ok N1*360E43D").has_value());
}

TEST(CheckedWindow, GoesBackToTheLineExpectedOnceTheLineIsDry)
{
    window.add(10, "G21");
    window.add(11, "G0X5");
    window.add(12, "G0X6");
    STRCMP_EQUAL("N1G21*A00D41FF\n", window.next(now)->c_str());
    CHECK(window.next(now).has_value());
    CHECK(window.next(now).has_value());
    CHECK_FALSE(window.next(now).has_value());
    LONGS_EQUAL(1, window.take("ok N1*360E43D2", now)->done_lines);
    LONGS_EQUAL(0, window.take("resend N2*29C8D9EE", now)->done_lines);
    CHECK_FALSE(window.next(now).has_value());
    now += std::chrono::milliseconds{50};
    STRCMP_EQUAL("N2G0X5*5908B732\n", window.next(now)->c_str());
    LONGS_EQUAL(11, window.program_line_of(2));
}

TEST(CheckedWindow, TakesALaterAnswerForThoseBefore)
{
    window.add(10, "G21");
    window.add(11, "G0X5");
    window.next(now);
    window.next(now);
    const auto verdict = window.take("ok N2*AF071268", now);
    LONGS_EQUAL(2, verdict->done_lines);
    LONGS_EQUAL(11, verdict->program_line);
    CHECK(window.empty());
}

TEST(CheckedWindow, GoesBackAtOnceWhenNothingIsUnderWay)
{
    window.add(10, "G21");
    window.next(now);
    window.take("resend N1*B0C18854", now);
    STRCMP_EQUAL("N1G21*A00D41FF\n", window.next(now)->c_str());
}

TEST(CheckedWindow, AsksByAnEmptyLineWhenNothingIsHeard)
{
    window.add(10, "G21");
    window.next(now);
    CHECK_FALSE(window.next(now).has_value());
    now += std::chrono::milliseconds{300};
    STRCMP_EQUAL("\n", window.next(now)->c_str());
    CHECK_FALSE(window.next(now).has_value());
    LONGS_EQUAL(1, window.take("resend N2*29C8D9EE", now)->done_lines);
    CHECK(window.empty());
}

TEST(CheckedWindow, AsksAtOnceWhenTheLastAnswerWasDamaged)
{
    window.add(10, "G21");
    window.next(now);
    CHECK_FALSE(window.take("ok N1*360E43D3", now).has_value());
    STRCMP_EQUAL("\n", window.next(now)->c_str());
}

TEST(CheckedWindow, TellsOfAControllerThatDoesNotCheckAnyMore)
{
    for (int i = 0; i < 3; ++i) {
        window.take("error:1", now);
    }
    window.take("ok N9", now);
    for (int i = 0; i < 4; ++i) {
        CHECK_FALSE(window.lapsed());
        window.take(i == 0 ? "ok" : "error:20", now);
    }
    CHECK(window.lapsed());
}
