// Messages of the three protocols against bytes that their manuals and other programs print.
#include "firmware/vfd/vfd_protocol.hpp"

#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::vfd;

namespace {

void check_bytes(const std::vector<unsigned>& expected, const Message& message)
{
    UNSIGNED_LONGS_EQUAL(expected.size(), message.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        UNSIGNED_LONGS_EQUAL(expected[i], message[i]);
    }
}

Answer parse(Protocol protocol,
             Query query,
             const Message& message,
             std::vector<std::uint8_t> bytes)
{
    return parse_answer(protocol, query, message, {bytes.data(), bytes.size()});
}

}  // namespace

TEST_GROUP(VfdProtocol)
{
    static VfdSetup setup(Protocol protocol)
    {
        VfdSetup setup;
        setup.protocol = protocol;
        return setup;
    }
    const VfdSetup huanyang = setup(Protocol::kHuanyang);
    const VfdSetup p2a = setup(Protocol::kHuanyangP2A);
    const VfdSetup plain = setup(Protocol::kPlain);
};

// The checksums are those of the Modbus specification's polynomial, computed by another program.
TEST(VfdProtocol, SpeaksHuanyang)
{
    check_bytes({0x01, 0x03, 0x01, 0x01, 0x31, 0x88}, run_message(huanyang, Turning::kClockwise));
    check_bytes({0x01, 0x03, 0x01, 0x11, 0x30, 0x44},
                run_message(huanyang, Turning::kCounterClockwise));
    check_bytes({0x01, 0x03, 0x01, 0x08, 0xF1, 0x8E}, run_message(huanyang, Turning::kOff));
    check_bytes({0x01, 0x05, 0x02, 0x09, 0xC4, 0xBF, 0x0F}, speed_message(huanyang, 2500));
    // 25 Hz are 1500 rpm of a motor with 3000 at 50 Hz.
    UNSIGNED_LONGS_EQUAL(2500, speed_word(huanyang, 1500, 3000));
    DOUBLES_EQUAL(1500, speed_of(huanyang, 2500, 3000), 0.01);
}

TEST(VfdProtocol, SpeaksHuanyangP2A)
{
    check_bytes({0x01, 0x06, 0x20, 0x00, 0x00, 0x01, 0x43, 0xCA},
                run_message(p2a, Turning::kClockwise));
    check_bytes({0x01, 0x06, 0x20, 0x00, 0x00, 0x06, 0x02, 0x08}, run_message(p2a, Turning::kOff));
    check_bytes({0x01, 0x03, 0xB0, 0x05, 0x00, 0x02, 0xF2, 0xCA}, scale_message(p2a));
    // 24000 rpm at most.
    const Answer answer = parse(p2a.protocol, Query::kScale, scale_message(p2a),
                                {0x01, 0x03, 0x00, 0x04, 0x5D, 0xC0, 0x3C, 0xCB});
    CHECK(answer.kind == AnswerKind::kGood);
    UNSIGNED_LONGS_EQUAL(24000, answer.value);
    UNSIGNED_LONGS_EQUAL(5000, speed_word(p2a, 12000, 24000));
}

TEST(VfdProtocol, SpeaksPlainModbus)
{
    check_bytes({0x01, 0x06, 0x20, 0x00, 0x00, 0x12, 0x02, 0x07},
                run_message(plain, Turning::kClockwise));
    check_bytes({0x01, 0x03, 0x21, 0x03, 0x00, 0x01, 0x7E, 0x36}, read_message(plain));
    UNSIGNED_LONGS_EQUAL(10000, speed_word(plain, 12000, 1));
    DOUBLES_EQUAL(12000, speed_of(plain, 20000, 1), 0.01);
}

TEST(VfdProtocol, TakesNoAnswerWithAnyBitWrong)
{
    const Message message = speed_message(huanyang, 2500);
    const std::vector<std::uint8_t> right(message.begin(), message.end());
    CHECK(parse(huanyang.protocol, Query::kSpeed, message, right).kind == AnswerKind::kGood);
    for (std::size_t bit = 0; bit < 8 * right.size(); ++bit) {
        std::vector<std::uint8_t> wrong = right;
        wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ 1U << bit % 8);
        CHECK(parse(huanyang.protocol, Query::kSpeed, message, wrong).kind == AnswerKind::kGarbled);
    }
    for (std::size_t size = 0; size < right.size(); ++size) {
        CHECK(parse(huanyang.protocol, Query::kSpeed, message,
                    {right.begin(), right.begin() + static_cast<int>(size)})
                  .kind == AnswerKind::kGarbled);
    }
}

TEST(VfdProtocol, HearsARefusal)
{
    Message refusal;
    for (const unsigned byte : {1U, 0x86U, 2U}) {
        (void)refusal.try_push_back(static_cast<std::uint8_t>(byte));
    }
    add_checksum(refusal);
    CHECK(
        parse_answer(plain.protocol, Query::kRun, run_message(plain, Turning::kOff), refusal.span())
            .kind == AnswerKind::kRefused);
    CHECK(parse_answer(plain.protocol, Query::kRead, read_message(plain), refusal.span()).kind ==
          AnswerKind::kGarbled);
}
