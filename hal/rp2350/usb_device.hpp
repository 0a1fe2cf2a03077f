// UsbLink: a serial port over the chip's USB: its interrupt, on top of which is hal/usb_serial/usb_serial.hpp.
#pragma once

#include <array>
#include <cstdint>

#include "hal/rp2350/rp2350.hpp"
#include "hal/rp2350/usb_buffers.hpp"
#include "hal/usb_serial/usb_serial.hpp"

namespace cusp::hal::rp2350 {

// `Table::kUsb` is the board's UsbIdentity.
template <class Chip, class Table>
class UsbLink : public UsbSerial<UsbEndpoints<Chip>, Table> {
    using Serial = UsbSerial<UsbEndpoints<Chip>, Table>;

public:
    // Precondition: 48 MHz are there, and the block is out of reset.
    void start() noexcept { start_usb<Chip>(); }
    void connect() noexcept { connect_usb<Chip>(); }

    void on_interrupt() noexcept;

private:
    using Endpoints = UsbEndpoints<Chip>;

    void on_bus(std::uint32_t raised) noexcept;
    void on_buffers() noexcept;

    typename Serial::Packet packet_{};
};

template <class Chip, class Table>
void UsbLink<Chip, Table>::on_interrupt() noexcept
{
    auto& usb = Chip::usb();
    const std::uint32_t raised = usb.ints.read();
    on_bus(raised);
    if ((raised & kUsbBufferEvent) != 0) {
        on_buffers();
    }
    if ((raised & kUsbSetupEvent) != 0) {
        usb.sie_status.write(kUsbSetupCame);
        this->on_setup(Endpoints::setup());
    }
    this->serve();
}

template <class Chip, class Table>
void UsbLink<Chip, Table>::on_bus(std::uint32_t raised) noexcept
{
    auto& status = Chip::usb().sie_status;
    if ((raised & kUsbResetEvent) != 0) {
        status.write(kUsbResetCame);
        this->on_reset();
    }
    if ((raised & kUsbSuspendEvent) != 0) {
        status.write(kUsbSuspended);
        this->on_sleep(true);
    }
    if ((raised & kUsbResumeEvent) != 0) {
        status.write(kUsbResumed);
        this->on_sleep(false);
    }
}

template <class Chip, class Table>
void UsbLink<Chip, Table>::on_buffers() noexcept
{
    auto& usb = Chip::usb();
    const std::uint32_t done = usb.buff_status.read();
    usb.buff_status.write(done);
    const auto takes = [done](unsigned place) {
        const bool is_done = (done >> place & 1U) != 0;
        if (is_done) {
            Endpoints::finish(place);
        }
        return is_done;
    };
    if (takes(Endpoints::in_place(0))) {
        this->on_control_sent();
    }
    if (takes(Endpoints::out_place(0))) {
        const unsigned size = Endpoints::read(0, {packet_.data(), packet_.size()});
        this->on_control_data({packet_.data(), size});
    }
    if (takes(Endpoints::in_place(Endpoints::kBulk))) {
        this->on_bulk_sent();
    }
    if (takes(Endpoints::out_place(Endpoints::kBulk))) {
        const unsigned size = Endpoints::read(Endpoints::kBulk, {packet_.data(), packet_.size()});
        this->take_bulk({packet_.data(), size});
        this->on_bulk_taken();
    }
    static_cast<void>(takes(Endpoints::in_place(Endpoints::kNotify)));
}

}  // namespace cusp::hal::rp2350
