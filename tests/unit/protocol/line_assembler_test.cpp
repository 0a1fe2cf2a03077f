#include "firmware/protocol/line_assembler.hpp"

#include <string>

#include "CppUTest/TestHarness.h"

using cusp::protocol::LineAssembler;

TEST_GROUP(Line)
{
    LineAssembler line;
    std::string cleaned(const std::string& text)
    {
        line.begin_line();
        for (const char c : text) {
            if (line.add(static_cast<std::uint8_t>(c))) {
                break;
            }
        }
        return std::string{line.line()};
    }
};

TEST(Line, HasNoSpacesControlCharactersOrSlashesAndOnlyCapitals)
{
    CHECK_EQUAL(std::string{"G1X-2.5"}, cleaned(" /g1 \t x - 2.5\x01\n"));
}

TEST(Line, HasNoComments)
{
    CHECK_EQUAL(std::string{"G1X2"}, cleaned("G1(X9;)X2;Y7(\n"));
    CHECK_EQUAL(std::string{""}, cleaned("(never closed G1X1\n"));
}

TEST(Line, EndsAtCarriageReturnAndAtLineFeed)
{
    CHECK(line.add('\r'));
    CHECK(line.add('\n'));
    CHECK_FALSE(line.add('G'));
}

TEST(Line, Holds255CharactersAndFlagsMore)
{
    CHECK_EQUAL(std::size_t{255}, cleaned(std::string(255, 'X')).size());
    CHECK_FALSE(line.overflow());
    (void)cleaned(std::string(256, 'X'));
    CHECK(line.overflow());
    line.begin_line();
    CHECK_FALSE(line.overflow());
}
