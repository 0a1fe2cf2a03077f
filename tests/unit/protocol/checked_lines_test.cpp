#include "firmware/protocol/checked_lines.hpp"

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "CppUTest/TestHarness.h"

using namespace cusp::protocol;

namespace {

std::string checked(const std::string& text)
{
    Crc32 crc;
    for (const char c : text) {
        crc.add(static_cast<std::uint8_t>(c));
    }
    char digits[9];
    (void)std::snprintf(digits, sizeof digits, "%08X", static_cast<unsigned>(crc.value()));
    return text + "*" + digits;
}

LineAssembler assembled(const std::string& text)
{
    LineAssembler line;
    for (const char c : text) {
        (void)line.add(static_cast<std::uint8_t>(c));
    }
    return line;
}

}  // namespace

TEST_GROUP(Crc){};

TEST(Crc, OfTheStandardTextIsTheStandardValue)
{
    Crc32 crc;
    for (const char c : std::string{"123456789"}) {
        crc.add(static_cast<std::uint8_t>(c));
    }
    UNSIGNED_LONGS_EQUAL(0xCBF43926U, crc.value());
}

TEST_GROUP(CheckedLine)
{
    CheckedLines lines;
    void setup() override { lines.switch_on(); }

    bool accepts(const std::string& text, const std::string& content)
    {
        const LineAssembler line = assembled(text);
        const std::optional<std::string_view> accepted = lines.accept(line);
        return accepted && *accepted == content;
    }
    bool refuses(const std::string& text)
    {
        const LineAssembler line = assembled(text);
        return !lines.accept(line);
    }
};

TEST(CheckedLine, RunsOnceAndInOrder)
{
    CHECK(accepts(checked("N1 G1 x5 (a * b)"), "G1X5"));
    CHECK(refuses(checked("N1 G1 x5 (a * b)")));
    CHECK(refuses(checked("N3G0")));
    CHECK(accepts(checked("N2$G"), "$G"));
    UNSIGNED_LONGS_EQUAL(3, lines.expected());
}

TEST(CheckedLine, IsRefusedWithAnyByteChangedDroppedOrDoubled)
{
    const std::string good = checked("N1G1X12.5Y-3F600");
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (int byte = 0; byte < 128; ++byte) {
            std::string bad = good;
            bad[i] = static_cast<char>(byte);
            const bool same_digit =
                bad[i] == good[i] || (i > good.find('*') && (bad[i] | 32) == (good[i] | 32));
            CHECK(same_digit || byte == '\n' || byte == '\r' || refuses(bad));
        }
        CHECK(refuses(good.substr(0, i) + good.substr(i + 1)));
        CHECK(refuses(good.substr(0, i) + good[i] + good.substr(i)));
    }
    UNSIGNED_LONGS_EQUAL(1, lines.expected());
}

TEST(CheckedLine, IsRefusedWithANumberOfMoreThanNineDigits)
{
    CHECK(refuses(checked("N0000000001G1")));
    CHECK(accepts(checked("N000000001G1"), "G1"));
}

TEST(CheckedLine, MayHave255CharactersBeforeItsCheck)
{
    CHECK(refuses(checked("N1" + std::string(254, 'X'))));
    CHECK(accepts(checked("N1" + std::string(253, 'X')), std::string(253, 'X')));
}

TEST(CheckedLine, LetsARealtimeByteCountAtItsThirdRepetition)
{
    CHECK(lines.accept_realtime('?'));
    CHECK_FALSE(lines.accept_realtime('!'));
    CHECK_FALSE(lines.accept_realtime('!'));
    CHECK(lines.accept_realtime('!'));
    CHECK_FALSE(lines.accept_realtime('!'));
    lines.text();
    CHECK_FALSE(lines.accept_realtime('!'));
    CHECK_FALSE(lines.accept_realtime('!'));
    lines.switch_off();
    CHECK(lines.accept_realtime('!'));
}
