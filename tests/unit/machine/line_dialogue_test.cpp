// Lines in, answers out, without a machine.
#include "firmware/machine/line_dialogue.hpp"

#include <string>

#include "CppUTest/TestHarness.h"

namespace cusp::machine {

TEST_GROUP(LineDialogue)
{
    protocol::ReplyQueue replies;
    LineDialogue lines{replies};
    std::string answered;

    void send(std::string_view text, std::uint32_t now = 0)
    {
        for (const char c : text) {
            CHECK_FALSE(lines.receive(static_cast<std::uint8_t>(c), now));
        }
    }
    // Executes all that has come and answers each line with ok: the lines, each ended by '|'.
    std::string execute_all()
    {
        std::string executed;
        std::string_view text;
        for (;;) {
            const LineDialogue::Progress progress = lines.read(text);
            answers();
            if (progress == LineDialogue::Progress::kNothing) {
                return executed;
            }
            if (progress == LineDialogue::Progress::kLine) {
                executed.append(text).append("|");
                lines.answer(std::nullopt);
                lines.next();
            }
        }
    }
    std::string answers()
    {
        while (!replies.empty()) {
            for (const std::uint8_t byte : replies.pending()) {
                answered += static_cast<char>(byte);
            }
            replies.drop(static_cast<std::uint32_t>(replies.pending().size()));
        }
        return answered;
    }
};

TEST(LineDialogue, GivesEachLineOnceInOrder)
{
    send("G1 X1\ng0 y2\n$$\n");
    STRCMP_EQUAL("G1X1|G0Y2|$$|", execute_all().c_str());
    STRCMP_EQUAL("ok\r\nok\r\nok\r\n", answers().c_str());
    CHECK(lines.empty());
}

TEST(LineDialogue, SaysWhichBytesAreRealtime)
{
    CHECK(lines.receive('?', 0));
    CHECK(lines.receive('!', 0));
    CHECK_FALSE(lines.receive('G', 0));
    CHECK(lines.receive(0x85, 0));
}

TEST(LineDialogue, AnswersALineThatIsTooLongItself)
{
    send(std::string(300, 'X') + "\nG4P0\n");
    STRCMP_EQUAL("G4P0|", execute_all().c_str());
    STRCMP_EQUAL("error:11\r\nok\r\n", answers().c_str());
}

TEST(LineDialogue, AnswersEveryLineWhoseBytesFoundNoRoom)
{
    constexpr int kLines = 600;  // of three bytes: more than the queue holds
    std::string text;
    for (int i = 0; i < kLines; ++i) {
        text += "M5\n";
    }
    send(text);
    execute_all();
    const std::string all = answers();
    int count = 0;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        count += all.compare(i, 4, "ok\r\n") == 0 || all.compare(i, 8, "error:11") == 0 ? 1 : 0;
    }
    CHECK_EQUAL(kLines, count);
    CHECK(all.find("Receive buffer overflow") != std::string::npos);
}

TEST(LineDialogue, RefusesTheLineAloneInWhichTheLinkLostBytes)
{
    send("G4P1\nG1X");
    lines.bytes_lost();
    send("Y5\nM5\n");
    CHECK_FALSE(lines.all_read());
    STRCMP_EQUAL("G4P1|M5|", execute_all().c_str());
    STRCMP_EQUAL("ok\r\n[MSG:Serial overrun: bytes lost]\r\nerror:11\r\nok\r\n", answers().c_str());
    CHECK(lines.all_read());
}

TEST(LineDialogue, CancelsTheLinesThatBeganBeforeTheCancel)
{
    std::string_view text;
    send("$J=X1\n$J=X2");
    lines.cancel(true);
    send("\n$J=X3\n");
    for (const bool cancelled : {true, true, false}) {
        CHECK(lines.read(text) == LineDialogue::Progress::kLine);
        CHECK_EQUAL(cancelled, lines.cancelled());
        CHECK_EQUAL(cancelled, lines.cancelled_in_jog());
        lines.next();
    }
}

TEST(LineDialogue, AsksForACheckedLineAgainThatIsDamaged)
{
    std::string_view text;
    lines.switch_checked(true);
    send("N1 G1 X1*00000000\n");
    CHECK(lines.read(text) == LineDialogue::Progress::kWorked);
    STRCMP_EQUAL("resend N1*", answers().substr(0, 10).c_str());
}

TEST(LineDialogue, LetsCheckedLinesLapseAfterThreeSecondsWithoutText)
{
    send("G4P0\n", 10);
    CHECK_FALSE(lines.may_lapse(100000));
    lines.switch_checked(true);
    CHECK_FALSE(lines.may_lapse(3010));
    (void)lines.receive('?', 3000);
    CHECK(lines.may_lapse(3011));
    lines.lapse();
    CHECK_FALSE(lines.checked());
}

}  // namespace cusp::machine
