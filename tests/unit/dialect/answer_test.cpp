// Understanding a controller's answers.
#include "host_tools/controller/dialect/answer.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::dialect;

TEST_GROUP(Answer){};

TEST(Answer, TellsTheKindsApart)
{
    CHECK(parse_answer("ok").kind == AnswerKind::kOk);
    LONGS_EQUAL(33, parse_answer("error:33").code);
    LONGS_EQUAL(9, parse_answer("ALARM:9").code);
    CHECK(parse_answer("Grbl 1.1h ['$' for help]").kind == AnswerKind::kBanner);
    STRCMP_EQUAL("MSG:Pgm End", parse_answer("[MSG:Pgm End]").text.c_str());
    CHECK(parse_answer("error:x").kind == AnswerKind::kOther);
    CHECK(parse_answer("okay").kind == AnswerKind::kOther);
    CHECK(parse_answer("").kind == AnswerKind::kOther);
}

TEST(Answer, ReadsAStatusReport)
{
    const Answer answer = parse_answer(
        "<Hold:1|MPos:-1.500,2.000,0.250|Bf:15,128|Ln:77|FS:1200,8000|WCO:1.000,0.000,0.000|Ov:90,"
        "100,100|A:SF>");
    CHECK(answer.kind == AnswerKind::kStatus);
    STRCMP_EQUAL("Hold", answer.status.state.c_str());
    LONGS_EQUAL(1, answer.status.substate);
    DOUBLES_EQUAL(-1.5, answer.status.machine_position->x, 0.0);
    LONGS_EQUAL(77, *answer.status.line);
    DOUBLES_EQUAL(1200.0, *answer.status.feed, 0.0);
    LONGS_EQUAL(90, *answer.status.feed_override);
}

TEST(Answer, ReadsTheRotaryAxisWhereItIsReported)
{
    const Answer with = parse_answer("<Idle|MPos:1.000,2.000,3.000,-45.500|FS:0,0>");
    DOUBLES_EQUAL(-45.5, (*with.status.machine_position)[cusp::kLinearAxes], 0.0);
    const Answer without = parse_answer("<Idle|MPos:1.000,2.000,3.000|FS:0,0>");
    DOUBLES_EQUAL(0.0, (*without.status.machine_position)[cusp::kLinearAxes], 0.0);
}

TEST(Answer, LeavesOutWhatADamagedReportDoesNotSay)
{
    const Answer answer = parse_answer("<Run|MPos:1.0,xx,3|Ln:-4|FS:|Ov>");
    CHECK(answer.kind == AnswerKind::kStatus);
    CHECK_FALSE(answer.status.machine_position.has_value());
    CHECK_FALSE(answer.status.line.has_value());
    CHECK_FALSE(answer.status.feed.has_value());
}

TEST(Answer, HasWordsForEveryCode)
{
    STRCMP_EQUAL("a number is too large", std::string{error_text(38)}.c_str());
    STRCMP_EQUAL("the tool change needs a homed machine", std::string{error_text(46)}.c_str());
    STRCMP_EQUAL("no feed rate is set", std::string{error_text(22)}.c_str());
    STRCMP_EQUAL("homing did not find the switch", std::string{alarm_text(9)}.c_str());
    STRCMP_EQUAL("unknown", std::string{alarm_text(-1)}.c_str());
    STRCMP_EQUAL("unknown", std::string{error_text(200)}.c_str());
}
