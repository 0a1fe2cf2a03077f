// Lines as they go over the wire.
#include "host_tools/controller/dialect/program_lines.hpp"

#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::dialect;

TEST_GROUP(ProgramLines){};

TEST(ProgramLines, HaveNoCommentsAndBlanks)
{
    STRCMP_EQUAL("G1X1Y2", bare_line(" G1 (to the right) X1\tY2 ; far").c_str());
    STRCMP_EQUAL("$J=G91 X1 F100", bare_line("$J=G91 X1 F100").c_str());
    STRCMP_EQUAL("", bare_line("%").c_str());
    STRCMP_EQUAL("", bare_line("(only)").c_str());
    STRCMP_EQUAL("", bare_line("\xEF\xBB\xBF%").c_str());
    STRCMP_EQUAL("", bare_line("\xEF\xBB\xBF").c_str());
    STRCMP_EQUAL("G21", bare_line("\xEF\xBB\xBFG21").c_str());
}

TEST(ProgramLines, CarryTheNumberOfTheFilesLine)
{
    STRCMP_EQUAL("N7G1X1", numbered_line("G1X1", 7).c_str());
    STRCMP_EQUAL("N7G1X1", numbered_line("N120G1X1", 7).c_str());
    STRCMP_EQUAL("N7G1X1.5", numbered_line("N10.5G1X1.5", 7).c_str());
    STRCMP_EQUAL("N7G1", numbered_line("N10.G1", 7).c_str());
    STRCMP_EQUAL("$H", numbered_line("$H", 7).c_str());
}

TEST(ProgramLines, LeaveBadLineNumbersToTheController)
{
    STRCMP_EQUAL("NG1X1", numbered_line("NG1X1", 7).c_str());
    STRCMP_EQUAL("N12345678G1", numbered_line("N12345678G1", 7).c_str());
    STRCMP_EQUAL("N-1G1", numbered_line("N-1G1", 7).c_str());
    STRCMP_EQUAL("N1.5.2G1", numbered_line("N1.5.2G1", 7).c_str());
    // a line end that was lost: as one line it would go straight to both places
    STRCMP_EQUAL("N1G0Z5N2X50", numbered_line("N1G0Z5N2X50", 7).c_str());
    STRCMP_EQUAL("G1X1n3N3", numbered_line("G1X1n3N3", 7).c_str());
}

TEST(ProgramLines, AreNeverMadeTooLong)
{
    const std::string longest(255, 'X');
    LONGS_EQUAL(255, numbered_line(longest, 7).size());
}

TEST(ProgramLines, HaveNoControlCharacters)
{
    using cusp::dialect::bare_line;
    CHECK_EQUAL(std::string{"G1X1"}, bare_line(std::string{"\0G1\x7f X1\x1a\x0c", 9}));
    CHECK_EQUAL(std::string{"$N0=G21 G90"}, bare_line("  $N0=G21 G90\x01"));
    CHECK_EQUAL(std::string{}, bare_line("\x1a"));
}

TEST(ProgramLines, NameTheFirstByteThatAControllerActsOn)
{
    using cusp::dialect::realtime_byte;
    for (const char* words : {"G1!", "G1~", "G1?", "G1\x84", "G1\xff"}) {
        CHECK(realtime_byte(words) == 2U);
    }
    CHECK(!realtime_byte("$J=G91X1F100"));
}

TEST(ProgramLines, EndAtM2AndM30)
{
    using cusp::dialect::ends_program;
    for (const char* words : {"M2", "m02", "M30", "M030", "G1X3M2", "M5M30", "M2.0"}) {
        CHECK(ends_program(words));
    }
    for (const char* words : {"M3", "M300", "M20", "G2", "M", "$N0=M30", "M0", "M2.5"}) {
        CHECK(!ends_program(words));
    }
}

TEST(ProgramLines, EndAtTheSecondTapeMark)
{
    const auto ends_at = [](const std::vector<std::string>& lines) {
        cusp::dialect::EndLine end_line;
        std::size_t line = 0;
        while (line < lines.size() && !end_line.at(lines[line])) {
            ++line;
        }
        return line;
    };
    UNSIGNED_LONGS_EQUAL(3, ends_at({"", " % ", "G21", "%\r", "G1"}));
    UNSIGNED_LONGS_EQUAL(4, ends_at({"G21", "%", "G1", "%"}));
    UNSIGNED_LONGS_EQUAL(3, ends_at({"%", "%O1000", "G1"}));
}
