// The refused word, and its message.
#include "host_tools/controller/dialect/refusal.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::dialect;

TEST_GROUP(Refusals){};

namespace {

void check_word(const char* expected, int code, const char* line)
{
    const Refusal found = refusal(code, line);
    const std::string word{std::string_view{line}.substr(found.begin, found.end - found.begin)};
    STRCMP_EQUAL_TEXT(expected, word.c_str(), line);
}

}  // namespace

TEST(Refusals, NamesTheFirstWordThatIsRefused)
{
    check_word("E1.5", 20, "G1 X20 E1.5");
    check_word("G96", 20, "N7 G96 S100");
    check_word("M98", 20, "M98 P1000");
    check_word("X", 2, "G0 X Y5");
    check_word("F-1", 4, "G1 X1 F-1");
    check_word("G18", 21, "G17 G18");
    check_word("X2", 25, "X1 X2");
    check_word("#1", 1, "#1=5");
    check_word("[2+3", 1, "[2+3]");
}

TEST(Refusals, PassesOverComments)
{
    LONGS_EQUAL(10, refusal(20, "(E2) G1 X1E2").begin);
    check_word("E2", 20, "(E1) G1 (E3) X1 E2 ; E4");
    check_word("", 20, "(all is well");
    check_word("Q4", 36, "G1 X6 Q4 (a comment) (and one more)");
    check_word("X7", 25, "G1 X6 X7(beside it) Y1");
}

TEST(Refusals, NamesAWordThatNothingUses)
{
    check_word("P5", 36, "G1 X1 P5");
    check_word("L3", 20, "G10 L3 P1 X0");
    check_word("R5", 20, "G10 L2 P1 X0 R5");
    check_word("A5", 20, "G1 X2 A5");
    check_word("B6.5", 20, "G0 X2 A0 B6.5 F100");
}

TEST(Refusals, NamesTheParameterOrExpressionInPlaceOfANumber)
{
    check_word("X#1", 2, "G1 X#1 Y2");
    check_word("X [#1 + 2]", 2, "G1 X [#1 + 2] F5");
    check_word("Z#<depth>", 2, "G0 Z#<depth>(deep)");
    STRCMP_CONTAINS("parameters are LinuxCNC", refusal(2, "G0 X1 Y#1").text.c_str());
    STRCMP_CONTAINS("expressions are LinuxCNC", refusal(2, "G0 X[1+2]").text.c_str());
    STRCMP_CONTAINS("O100 in", refusal(20, "O100 sub").text.c_str());
    STRCMP_CONTAINS("tapping", refusal(20, "G84 X1 Z-1 R1").text.c_str());
    STRCMP_CONTAINS("cubic splines", refusal(20, "G5 X1 I1 J1 P1 Q1").text.c_str());
    STRCMP_CONTAINS("quadratic splines", refusal(20, "G5.1 X1 I1 J1").text.c_str());
    STRCMP_CONTAINS("not turned", refusal(20, "G10 L2 P1 R30").text.c_str());
    check_word("G33", 20, "\xEF\xBB\xBFG33 Z1 K1");
}

TEST(Refusals, NamesNoWordWhereNoneIsAtFault)
{
    check_word("", 33, "G2 X5 Y5 I9 J0");
    check_word("", 22, "G1 X1");
}

TEST(Refusals, SaysWhatTheWordIsElsewhere)
{
    STRCMP_CONTAINS("E1 in \"G1 X2 E1\": E drives the extruder",
                    refusal(20, "G1 X2 E1").text.c_str());
    STRCMP_CONTAINS("lathe", refusal(20, "g96 s100").text.c_str());
    STRCMP_CONTAINS("subprograms", refusal(20, "O100 sub").text.c_str());
    STRCMP_CONTAINS("millimetres are G21", refusal(20, "G71").text.c_str());
    STRCMP_CONTAINS("P is the order of the NURBS, degree + 1: 2 to 5",
                    refusal(33, "G6.2 P6 K0 X0 Y0").text.c_str());
    STRCMP_CONTAINS("L is the order", refusal(33, "G5.2 L9 X1 P1").text.c_str());
}

TEST(Refusals, ShowsOnlyWhatFitsAMessage)
{
    const std::string text = refusal(20, std::string(70000, 'E') + "\x1b[31m").text;
    CHECK(text.size() < 300);
    CHECK(refusal(20, "G1 \x1b[31m").text.find('\x1b') == std::string::npos);
}

TEST(Refusals, SaysTheCodeAloneWithoutALine)
{
    STRCMP_EQUAL("a G or M word is not supported", refusal(20, "").text.c_str());
}
