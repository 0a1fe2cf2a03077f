// Tools in one word: what is read, and what is refused with which words.
#include "host_tools/job/import/tool_text.hpp"

#include "CppUTest/TestHarness.h"

#include "tests/support/refusal.hpp"

using namespace cusp;
using namespace cusp::import;

namespace {

std::string refused(const std::string& text)
{
    return cusp::test::refusal([&] { tool_of_text(text, false); });
}

}  // namespace

TEST_GROUP(ToolText){};

TEST(ToolText, NamesShapeDiameterAndCornerRadius)
{
    const NamedTool bull = tool_of_text("bull:10:1.5", false);
    STRCMP_EQUAL("bull", bull.shape.c_str());
    DOUBLES_EQUAL(10.0, bull.diameter, 0.0);
    DOUBLES_EQUAL(1.5, bull.corner_radius, 0.0);
    STRCMP_EQUAL("bull 10 mm with corners of 1.5 mm", words_of(bull, false).c_str());
    const NamedTool ball = tool_of_text("ball:6", false);
    STRCMP_EQUAL("ball", ball.shape.c_str());
    DOUBLES_EQUAL(0.0, ball.corner_radius, 0.0);
}

TEST(ToolText, DrillsAndVeesHaveATip)
{
    DOUBLES_EQUAL(118.0, tool_of_text("drill:5", false).tip_angle, 0.0);
    DOUBLES_EQUAL(90.0, tool_of_text("drill:5:90", false).tip_angle, 0.0);
    const NamedTool vee = tool_of_text("vee:6:60", false);
    DOUBLES_EQUAL(60.0, vee.tip_angle, 0.0);
    STRCMP_EQUAL("vee 6 mm of 60 degrees", words_of(vee, false).c_str());
    STRCMP_CONTAINS("--tool vee:6: \"\" is no angle of the tip", refused("vee:6").c_str());
    STRCMP_CONTAINS("\"180\" is no angle", refused("vee:6:180").c_str());
    STRCMP_CONTAINS("a drill has a diameter and the angle", refused("drill:6:90:1").c_str());
}

TEST(ToolText, LengthsMayNameTheirUnit)
{
    DOUBLES_EQUAL(6.35, tool_of_text("ball:0.25in", false).diameter, 1e-12);
    DOUBLES_EQUAL(0.25, tool_of_text("ball:0.25in", true).diameter, 0.0);
    DOUBLES_EQUAL(0.25, tool_of_text("flat:6.35mm", true).diameter, 1e-12);
    DOUBLES_EQUAL(0.25, tool_of_text("flat:0.25", true).diameter, 0.0);
}

TEST(ToolText, OtherTextsAreRefusedWithWhatIsWrong)
{
    STRCMP_CONTAINS("--tool cone:6: no shape is named \"cone\"", refused("cone:6").c_str());
    STRCMP_CONTAINS("no shape is named \"\"", refused("").c_str());
    STRCMP_CONTAINS("--tool ball: the diameter is missing", refused("ball").c_str());
    STRCMP_CONTAINS("--tool ball:: the diameter is missing", refused("ball:").c_str());
    STRCMP_CONTAINS("\"six\" is no diameter", refused("ball:six").c_str());
    STRCMP_CONTAINS("\"nan\" is no diameter", refused("ball:nan").c_str());
    STRCMP_CONTAINS("\"inf\" is no diameter", refused("ball:inf").c_str());
    STRCMP_CONTAINS("\"1e999\" is no diameter", refused("ball:1e999").c_str());
    STRCMP_CONTAINS("the diameter is 0, it must be above 0", refused("ball:0").c_str());
    STRCMP_CONTAINS("the diameter is -6", refused("ball:-6").c_str());
    STRCMP_CONTAINS("\"cm\" is no unit", refused("ball:6cm").c_str());
    STRCMP_CONTAINS("has a diameter only", refused("ball:6:3").c_str());
    STRCMP_CONTAINS("the corner radius is missing", refused("bull:6").c_str());
    STRCMP_CONTAINS("the corner radius is 4, the tool's radius only 3",
                    refused("bull:6:4").c_str());
    STRCMP_CONTAINS("bull:10:1.5", refused("bull:6:1:1").c_str());
}
