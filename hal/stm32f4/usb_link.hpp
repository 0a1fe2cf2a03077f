// UsbLink: a serial port over USB OTG FS: its interrupt, on top of which is hal/usb_serial/usb_serial.hpp.
#pragma once

#include <array>
#include <cstdint>

#include "hal/stm32f4/chip.hpp"
#include "hal/stm32f4/usb_endpoints.hpp"
#include "hal/usb_serial/usb_serial.hpp"

namespace cusp::hal::stm32f4 {

// `Table::kUsb` is the board's UsbIdentity.
template <class Chip, class Table>
class UsbLink : public UsbSerial<UsbEndpoints<Chip>, Table> {
    using Serial = UsbSerial<UsbEndpoints<Chip>, Table>;

public:
    // Precondition: 48 MHz and the block's clock are on, the pins are set.
    void start(UsbSession session) noexcept { start_usb<Chip>(session); }
    // After start(), and late: a host that a boot loader has spoken to must see that it has gone.
    void connect() noexcept { connect_usb<Chip>(); }

    void on_interrupt() noexcept;

private:
    static constexpr unsigned kPacketsAtOnce = 4;  // the interrupt comes again for more

    using Endpoints = UsbEndpoints<Chip>;

    void take_packet() noexcept;
    void on_in() noexcept;
    void on_out() noexcept;

    typename Serial::SetupBytes setup_{};
    typename Serial::Packet packet_{};
    unsigned control_received_{0};
};

template <class Chip, class Table>
void UsbLink<Chip, Table>::on_interrupt() noexcept
{
    auto& core = Chip::usb();
    const std::uint32_t raised = core.gintsts.read();
    core.gintsts.write(raised & (kUsbReset | kUsbEnumerated | kUsbSuspend | kUsbWakeUp));
    if ((raised & kUsbReset) != 0) {
        this->on_reset();
    }
    if ((raised & (kUsbSuspend | kUsbWakeUp)) != 0) {
        this->on_sleep((raised & kUsbWakeUp) == 0 && Endpoints::suspended());
    }
    for (unsigned i = 0; i < kPacketsAtOnce && (core.gintsts.read() & kUsbReceived) != 0; ++i) {
        take_packet();
    }
    if ((core.gintsts.read() & kUsbInEvent) != 0) {
        on_in();
    }
    if ((core.gintsts.read() & kUsbOutEvent) != 0) {
        on_out();
    }
    this->serve();
}

template <class Chip, class Table>
void UsbLink<Chip, Table>::take_packet() noexcept
{
    const UsbReceived entry = Endpoints::pop();
    if (entry.kind == UsbReceived::kSetup) {
        Endpoints::read({setup_.data(), setup_.size()}, entry.size);
        return;
    }
    if (entry.kind != UsbReceived::kData) {
        return;
    }
    const unsigned size = Endpoints::read({packet_.data(), packet_.size()}, entry.size);
    if (entry.endpoint == 0) {
        control_received_ = size;
        return;
    }
    this->take_bulk({packet_.data(), size});
}

template <class Chip, class Table>
void UsbLink<Chip, Table>::on_in() noexcept
{
    if (Endpoints::in_done(0)) {
        this->on_control_sent();
    }
    if (Endpoints::in_done(Endpoints::kBulk)) {
        this->on_bulk_sent();
    }
    static_cast<void>(Endpoints::in_done(Endpoints::kNotify));
}

template <class Chip, class Table>
void UsbLink<Chip, Table>::on_out() noexcept
{
    const std::uint32_t control = Endpoints::out_events(0);
    if ((control & kUsbTransferDone) != 0) {
        this->on_control_data({packet_.data(), control_received_});
    }
    if ((control & kUsbSetupDone) != 0) {
        this->on_setup(setup_);
    }
    if ((Endpoints::out_events(Endpoints::kBulk) & kUsbTransferDone) != 0) {
        this->on_bulk_taken();
    }
}

}  // namespace cusp::hal::stm32f4
