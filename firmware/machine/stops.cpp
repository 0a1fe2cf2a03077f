// Inputs and bytes that stop the machine.
#include "firmware/machine/stops.hpp"

#include "firmware/protocol/realtime_command.hpp"

namespace cusp::machine {

using protocol::RealtimeCommand;

void Stops::take_byte(std::uint8_t byte, bool checked) noexcept
{
    switch (protocol::byte_kind(byte)) {
        case protocol::ByteKind::kDropped:
            return;
        case protocol::ByteKind::kText:
            filter_.text();
            return;
        case protocol::ByteKind::kRealtime:
            break;
    }
    if (checked && !filter_.accept(byte)) {
        return;
    }
    const auto command = static_cast<RealtimeCommand>(byte);
    const bool cuts = command == RealtimeCommand::kReset || command == RealtimeCommand::kSafetyDoor;
    if (cuts || command == RealtimeCommand::kFeedHold) {
        const std::uint32_t count = bytes_.load(std::memory_order_relaxed) + 1;
        cutting_byte_ = cuts ? count : cutting_byte_;
        reset_byte_ = command == RealtimeCommand::kReset ? count : reset_byte_;
        bytes_.store(count, std::memory_order_relaxed);
    }
}

void Stops::take_inputs(std::uint16_t raw, std::uint16_t steady) noexcept
{
    const unsigned risen = unsigned{steady} & ~unsigned{before_} & kAll & ~unsigned{pending()};
    before_ = steady;
    came_.store(static_cast<std::uint16_t>(came_.load(std::memory_order_relaxed) ^ risen),
                std::memory_order_relaxed);
    begins_ = (unsigned{raw} & ~unsigned{steady} & kBraking) != 0;
}

void Stops::confirm() noexcept
{
    handled_.store(
        static_cast<std::uint16_t>(unsigned{handled_.load(std::memory_order_relaxed)} ^ acted_),
        std::memory_order_release);
    acted_ = 0;
    bytes_handled_.store(read_, std::memory_order_release);
}

}  // namespace cusp::machine
