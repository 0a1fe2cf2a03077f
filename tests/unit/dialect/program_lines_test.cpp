// Lines as they go over the wire.
#include "host_tools/dialect/program_lines.hpp"

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
}

TEST(ProgramLines, CarryTheNumberOfTheFilesLine)
{
    STRCMP_EQUAL("N7G1X1", numbered_line("G1X1", 7).c_str());
    STRCMP_EQUAL("N7G1X1", numbered_line("N120G1X1", 7).c_str());
    STRCMP_EQUAL("$H", numbered_line("$H", 7).c_str());
}

TEST(ProgramLines, LeaveBadLineNumbersToTheController)
{
    STRCMP_EQUAL("NG1X1", numbered_line("NG1X1", 7).c_str());
    STRCMP_EQUAL("N12345678G1", numbered_line("N12345678G1", 7).c_str());
    STRCMP_EQUAL("N-1G1", numbered_line("N-1G1", 7).c_str());
    STRCMP_EQUAL("N1.5G1", numbered_line("N1.5G1", 7).c_str());
}

TEST(ProgramLines, AreNeverMadeTooLong)
{
    const std::string longest(255, 'X');
    LONGS_EQUAL(255, numbered_line(longest, 7).size());
}
