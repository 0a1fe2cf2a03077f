// Messages by their pauses, millisecond by millisecond.
#include "tests/target/cosim/spindle_model.hpp"

namespace cusp::cosim {

SpindleModel::SpindleModel(Circuit& circuit,
                           UsartModel& usart,
                           PortModel& port,
                           unsigned pin,
                           vfd::Protocol protocol,
                           std::uint32_t baud)
    : Model{circuit}, usart_{usart}, port_{port}, pin_{pin}, baud_{baud}, slave_{protocol}
{
    usart_.set_receiver([this](char byte) { hear(byte); });
    set_baud(baud);
    due_ = circuit_.now + kMillisecond;
}

void SpindleModel::set_baud(std::uint32_t baud)
{
    baud_ = baud;
    usart_.set_sender_baud(baud);
}

void SpindleModel::hear(char byte)
{
    if (!port_.high(pin_)) {
        return;  // the transceiver was off before its end: nobody hears it
    }
    message_.push_back(static_cast<std::uint8_t>(byte));
    last_ = circuit_.now;
}

void SpindleModel::happen()
{
    constexpr Picoseconds kBitsOfPause = 35;
    due_ = circuit_.now + kMillisecond;
    circuit_.next_event = 0;
    slave_.pass(1);
    if (!message_.empty() && circuit_.now - last_ >= kSecond / baud_ * kBitsOfPause) {
        slave_.send(message_);
        message_.clear();
        answered_ = false;
    }
    if (!answered_ && !slave_.heard().empty()) {
        answered_ = true;
        if (port_.high(pin_)) {
            circuit_.violate("the spindle's line is driven from both ends");
        }
        usart_.send({slave_.heard().begin(), slave_.heard().end()});
    }
}

}  // namespace cusp::cosim
