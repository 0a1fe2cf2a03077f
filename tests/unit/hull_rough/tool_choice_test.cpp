// Time, fitness and changes.
#include "host_tools/cam/hull_rough/tool_choice.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::hull_rough;

TEST_GROUP(ToolChoice){};

TEST(ToolChoice, KeepsOneCutterWhereAChangeCostsMoreThanItSaves)
{
    const ToolChoice choice = choose_tools({{{10, 100}, {30, 100}}, {{20, 100}, {15, 100}}}, 60);
    LONGS_EQUAL(0, choice.changes);
    LONGS_EQUAL(0, choice.of_layer[1]);
    DOUBLES_EQUAL(30, choice.seconds, 1e-12);
}

TEST(ToolChoice, ChangesWhereItPays)
{
    const ToolChoice choice = choose_tools({{{10, 100}, {300, 100}}, {{400, 100}, {15, 100}}}, 60);
    LONGS_EQUAL(1, choice.changes);
    DOUBLES_EQUAL(85, choice.seconds, 1e-12);
    DOUBLES_EQUAL(315, choice.seconds_with_one, 1e-12);
}

TEST(ToolChoice, TakesNoCutterThatDoesNotFit)
{
    const ToolChoice choice = choose_tools({{{10, 50}, {30, 100}}}, 60);
    LONGS_EQUAL(1, choice.of_layer[0]);
}
