// Ranges and limits, in the units of the settings.
#include "firmware/machine/setting_messages.hpp"

#include "firmware/protocol/system_command.hpp"

namespace cusp::machine {

void tell_range(std::uint32_t number, float value, protocol::ReplyQueue& out) noexcept
{
    constexpr std::uint32_t kFirst = 810;
    constexpr unsigned kDecimals = 3;
    for (std::size_t i = 0; i < kSettingCount; ++i) {
        const SettingEntry& entry = setting_entry(i);
        if (entry.number == number && number >= kFirst) {
            const auto write = [&out](float x) {
                (void)out.decimal(protocol::scaled(x, kDecimals), kDecimals);
            };
            (void)out.text("[MSG:$").number(number).text(" is ");
            write(value);
            (void)out.text(", range ");
            write(entry.least);
            (void)out.text(" to ");
            write(entry.most);
            (void)out.text("]").end_line();
        }
    }
}

void tell_fault(const SettingFault& fault, protocol::ReplyQueue& out) noexcept
{
    if (fault.first == 0) {
        return;
    }
    if (fault.second == 0) {
        (void)out.text("[MSG:$").number(fault.first);
        (void)out.text(": this board has no pin for it]").end_line();
        return;
    }
    if (fault.of_board) {
        (void)out.text("[MSG:$").number(fault.first).text(" x $").number(fault.second);
        (void)out.text(" asks for ").number(static_cast<std::uint32_t>(fault.amount + 0.5F));
        (void)out.text(" steps/s, this board plays ");
        (void)out.number(static_cast<std::uint32_t>(fault.limit)).text("]").end_line();
        return;
    }
    const bool rate = fault.error == Error::kMaxStepRateExceeded;
    constexpr unsigned kDecimals = 3;
    constexpr float kMillisecondsPerSecond = 1000.0F;
    const float unit = rate ? 1.0F : kMillisecondsPerSecond;
    (void)out.text("[MSG:$").number(fault.first).text(rate ? " x $" : " / $");
    (void)out.number(fault.second).text(rate ? " needs steps " : " asks for a filter of ");
    (void)out.decimal(protocol::scaled(fault.amount * unit, kDecimals), kDecimals);
    (void)out.text(rate ? " us apart, least 2 x $0 = " : " ms, most ");
    (void)out.decimal(protocol::scaled(fault.limit * unit, kDecimals), kDecimals);
    (void)out.text(rate ? " us]" : " ms]").end_line();
}

}  // namespace cusp::machine
