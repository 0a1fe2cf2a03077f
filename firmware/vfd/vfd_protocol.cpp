// Messages and answers, byte by byte.
#include "firmware/vfd/vfd_protocol.hpp"

#include <array>

namespace cusp::vfd {
namespace {

constexpr std::uint8_t kReadRegisters = 3;
constexpr std::uint8_t kWriteRegister = 6;
// A Huanyang has its own meanings for the functions 1 to 5.
constexpr std::uint8_t kHuanyangReadSetting = 1;
constexpr std::uint8_t kHuanyangControl = 3;
constexpr std::uint8_t kHuanyangReadState = 4;
constexpr std::uint8_t kHuanyangWriteSpeed = 5;
constexpr std::uint8_t kSpeedAt50Hz = 144;  // its setting PD144

constexpr float kHundredthsOf50Hz = 5000;
constexpr float kWholeOfP2A = 10000;

template <std::size_t N>
Message message_of(const std::array<unsigned, N>& bytes) noexcept
{
    Message message;
    for (const unsigned byte : bytes) {
        (void)message.try_push_back(static_cast<std::uint8_t>(byte & 0xFFU));
    }
    add_checksum(message);
    return message;
}
Message of_register(const VfdSetup& setup,
                    unsigned function,
                    unsigned place,
                    unsigned value) noexcept
{
    return message_of<6>({setup.address, function, place >> 8U, place, value >> 8U, value});
}

}  // namespace

Message scale_message(const VfdSetup& setup) noexcept
{
    constexpr unsigned kGreatestSpeed = 0xB005;
    if (setup.protocol == Protocol::kHuanyang) {
        return message_of<6>({setup.address, kHuanyangReadSetting, 3, kSpeedAt50Hz, 0, 0});
    }
    return of_register(setup, kReadRegisters, kGreatestSpeed, 2);
}

Message run_message(const VfdSetup& setup, Turning turning) noexcept
{
    constexpr std::array<unsigned, 3> kOfHuanyang{0x08, 0x01, 0x11};
    constexpr std::array<unsigned, 3> kOfP2A{6, 1, 2};
    constexpr unsigned kRunRegisterOfP2A = 0x2000;
    const auto place = static_cast<std::size_t>(turning);
    switch (setup.protocol) {
        case Protocol::kHuanyang:
            return message_of<4>({setup.address, kHuanyangControl, 1, kOfHuanyang[place]});
        case Protocol::kHuanyangP2A:
            return of_register(setup, kWriteRegister, kRunRegisterOfP2A, kOfP2A[place]);
        case Protocol::kPlain:
        case Protocol::kNone:
            break;
    }
    const std::array<unsigned, 3> words{setup.plain.stop, setup.plain.clockwise,
                                        setup.plain.counter_clockwise};
    return of_register(setup, kWriteRegister, setup.plain.run_register, words[place]);
}

Message speed_message(const VfdSetup& setup, std::uint16_t word) noexcept
{
    constexpr unsigned kSpeedRegisterOfP2A = 0x1000;
    const unsigned value = word;
    if (setup.protocol == Protocol::kHuanyang) {
        return message_of<5>({setup.address, kHuanyangWriteSpeed, 2, value >> 8U, value});
    }
    const unsigned place =
        setup.protocol == Protocol::kHuanyangP2A ? kSpeedRegisterOfP2A : setup.plain.speed_register;
    return of_register(setup, kWriteRegister, place, value);
}

Message read_message(const VfdSetup& setup) noexcept
{
    constexpr unsigned kOutputOfHuanyang = 1;
    constexpr unsigned kReadRegisterOfP2A = 0x700C;
    switch (setup.protocol) {
        case Protocol::kHuanyang:
            return message_of<6>({setup.address, kHuanyangReadState, 3, kOutputOfHuanyang, 0, 0});
        case Protocol::kHuanyangP2A:
            return of_register(setup, kReadRegisters, kReadRegisterOfP2A, 2);
        case Protocol::kPlain:
        case Protocol::kNone:
            break;
    }
    return of_register(setup, kReadRegisters, setup.plain.read_register, 1);
}

std::uint16_t speed_word(const VfdSetup& setup, float rpm, float scale) noexcept
{
    constexpr float kMost = 65535;
    const float word = setup.protocol == Protocol::kHuanyang ? rpm * kHundredthsOf50Hz / scale
                       : setup.protocol == Protocol::kHuanyangP2A
                           ? rpm * kWholeOfP2A / scale
                           : rpm * setup.plain.to_multiplier / setup.plain.to_divisor;
    return static_cast<std::uint16_t>(word < 0 ? 0 : word > kMost ? kMost : word + 0.5F);
}

float speed_of(const VfdSetup& setup, std::uint16_t word, float scale) noexcept
{
    const auto value = static_cast<float>(word);
    switch (setup.protocol) {
        case Protocol::kHuanyang:
            return value * scale / kHundredthsOf50Hz;
        case Protocol::kHuanyangP2A:
            return value;
        case Protocol::kPlain:
        case Protocol::kNone:
            break;
    }
    return value * setup.plain.from_multiplier / setup.plain.from_divisor;
}

std::size_t answer_size(Protocol protocol, Query query) noexcept
{
    constexpr std::size_t kControlOfHuanyang = 6;
    constexpr std::size_t kSpeedOfHuanyang = 7;
    constexpr std::size_t kOneRegister = 7;
    constexpr std::size_t kUsual = 8;
    if (protocol == Protocol::kHuanyang) {
        return query == Query::kRun     ? kControlOfHuanyang
               : query == Query::kSpeed ? kSpeedOfHuanyang
                                        : kUsual;
    }
    return protocol == Protocol::kPlain && query == Query::kRead ? kOneRegister : kUsual;
}

Answer parse_answer(Protocol protocol,
                    Query query,
                    const Message& message,
                    Span<const std::uint8_t> bytes) noexcept
{
    constexpr Answer kGarbled{AnswerKind::kGarbled, 0};
    constexpr unsigned kRefusal = 0x80;
    if (!has_checksum(bytes) || bytes[0] != message[0]) {
        return kGarbled;
    }
    if (bytes.size() == kRefusalSize && bytes[1] == (message[1] | kRefusal)) {
        return {AnswerKind::kRefused, 0};
    }
    if (bytes.size() != answer_size(protocol, query) || bytes[1] != message[1]) {
        return kGarbled;
    }
    if (query == Query::kSpeed || (query == Query::kRun && protocol != Protocol::kHuanyang)) {
        // The message itself.
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            if (bytes[i] != message[i]) {
                return kGarbled;
            }
        }
        return {AnswerKind::kGood, 0};
    }
    if (query == Query::kRun) {
        return {AnswerKind::kGood, 0};
    }
    // A P2A counts its bytes in two.
    const std::size_t place = protocol == Protocol::kPlain ? 3 : 4;
    const bool other_place = protocol == Protocol::kHuanyang && bytes[3] != message[3];
    const auto value = static_cast<std::uint16_t>(bytes[place] << 8U | bytes[place + 1]);
    return other_place ? kGarbled : Answer{AnswerKind::kGood, value};
}

}  // namespace cusp::vfd
