// UsbSerial: a serial port over USB, with the interface of a UART's link, over the endpoints of any chip.
//
//   using Link = UsbSerial<Endpoints, Table>;      // Table::kUsb is the board's UsbIdentity
//
// The chip's link (hal/stm32f4/usb_link.hpp) is one, and has the interrupt: it says what its registers told, then
// serve(). That interrupt alone touches the registers; the main loop pends it to have bytes sent or taken. It is
// the least urgent of all: a flood of packets delays neither pulses nor the servo tick. A host that
// sends more than is read is answered NAK by the hardware; for one that does not read, or none, nothing
// waits: bytes for a port that no program holds open are dropped.
//
// usb_control.hpp answers the requests, usb_descriptors.hpp describes the port.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "hal/contract/board.hpp"
#include "hal/contract/received_bytes.hpp"
#include "hal/usb_serial/usb_control.hpp"

namespace cusp::hal::usb_serial {

// `Endpoints` has the static functions of hal/stm32f4/usb_endpoints.hpp: chip_number(), ask_for_service(); of
// endpoint 0 begin_control(), set_address(), await_setup(), receive_control(), stall_control(), cancel_in(0); of both
// kinds send(); of bulk begin_bulk(), receive_bulk(), halt(), and its number kBulk.
template <class Endpoints, class Table>
class UsbSerial {
public:
    // See hal/contract/board.hpp. Bytes are never lost.
    bool try_read(std::uint8_t& byte) noexcept;
    bool try_scan(std::uint8_t& byte) noexcept { return received_.try_scan(byte); }
    bool overrun() noexcept { return false; }
    std::uint32_t write_room() const noexcept;
    void write(Span<const std::uint8_t> bytes) noexcept;

    // A program holds the port open, and the host is awake.
    bool open() const noexcept { return open_.load(std::memory_order_acquire); }
    // Everything received was read.
    bool empty() const noexcept { return received_.empty(); }
    // True if open() has ended since the last call: unplugged, closed, or the host sleeps.
    bool sender_left() noexcept { return left_.exchange(false, std::memory_order_relaxed); }

protected:
    using SetupBytes = std::array<std::uint8_t, 8>;
    using Packet = std::array<std::uint8_t, kUsbPacket>;

    // The chip's interrupt tells these.
    void on_reset() noexcept;
    void on_sleep(bool suspended) noexcept
    {
        suspended_ = suspended;
        update_open();
    }
    void on_setup(const SetupBytes& setup) noexcept;
    // The packet that endpoint 0 has received last.
    void on_control_data(Span<const std::uint8_t> bytes) noexcept;
    void on_control_sent() noexcept
    {
        if (control_waits_) {
            send_control();
        }
    }
    void on_bulk_sent() noexcept { sending_ = false; }
    // A packet of the bulk endpoint, and that it is armed no more.
    void take_bulk(Span<const std::uint8_t> bytes) noexcept;
    void on_bulk_taken() noexcept { armed_ = false; }
    // Last, in each interrupt.
    void serve() noexcept
    {
        if (control_.configured()) {
            send_bulk();
            arm_bulk();
        }
    }

private:
    static constexpr std::uint32_t kReceiveSize = 512;
    static constexpr std::uint32_t kSendSize = 512;
    void send_control() noexcept;
    void apply_request() noexcept;
    void update_open() noexcept;
    void send_bulk() noexcept;
    void arm_bulk() noexcept;

    UsbControl control_{Table::kUsb, Endpoints::chip_number()};
    unsigned control_sent_{0};
    bool control_waits_{false};  // more of the answer follows this packet
    bool data_comes_{false};     // the host sends the data of a request
    bool suspended_{false};
    bool heard_{false};  // bytes came: some programs do not say that they hold the port open
    bool armed_{false};
    bool sending_{false};
    bool full_packet_{false};  // the last one: an empty one ends it where nothing follows

    ReceivedBytes<kReceiveSize> received_;
    std::atomic<bool> wants_room_{false};  // the host is held back
    std::array<std::uint8_t, kSendSize> sent_{};
    // Both count bytes and wrap at 2^32.
    std::atomic<std::uint32_t> send_head_{0};  // by the main loop
    std::atomic<std::uint32_t> send_tail_{0};  // by the interrupt
    std::atomic<bool> open_{false};
    std::atomic<bool> left_{false};
};

template <class Endpoints, class Table>
bool UsbSerial<Endpoints, Table>::try_read(std::uint8_t& byte) noexcept
{
    const bool there = received_.try_read(byte);
    if (there && wants_room_.load(std::memory_order_relaxed)) {
        Endpoints::ask_for_service();
    }
    return there;
}

template <class Endpoints, class Table>
std::uint32_t UsbSerial<Endpoints, Table>::write_room() const noexcept
{
    return open() ? kSendSize - (send_head_.load(std::memory_order_relaxed) -
                                 send_tail_.load(std::memory_order_acquire))
                  : kSendSize;
}

template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::write(Span<const std::uint8_t> bytes) noexcept
{
    std::uint32_t head = send_head_.load(std::memory_order_relaxed);
    for (const std::uint8_t byte : bytes) {
        // If the port was opened or closed since write_room(), some may find no room.
        if (!open() || head - send_tail_.load(std::memory_order_acquire) == kSendSize) {
            break;
        }
        sent_[head % kSendSize] = byte;
        ++head;
    }
    send_head_.store(head, std::memory_order_release);
    Endpoints::ask_for_service();
}

template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::on_reset() noexcept
{
    control_.reset();
    suspended_ = false;
    heard_ = false;
    control_waits_ = false;
    data_comes_ = false;
    armed_ = false;
    sending_ = false;
    Endpoints::begin_control();
    update_open();
}

template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::take_bulk(Span<const std::uint8_t> bytes) noexcept
{
    // There is room: arm_bulk() waits for it.
    received_.put(bytes);
    heard_ = heard_ || !bytes.empty();
    update_open();
}

template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::on_setup(const SetupBytes& setup) noexcept
{
    Endpoints::cancel_in(0);
    control_waits_ = false;
    const UsbStage stage = control_.begin(read_setup(setup));
    data_comes_ = stage == UsbStage::kDataOut;
    apply_request();
    switch (stage) {
        case UsbStage::kStall:
            Endpoints::stall_control();
            return;
        case UsbStage::kStatus:
            Endpoints::await_setup();
            Endpoints::send(0, {});
            return;
        case UsbStage::kDataIn:
            control_sent_ = 0;
            send_control();
            break;
        case UsbStage::kDataOut:
            break;
    }
    // For the data of the request, or for the acknowledgement, which may come early.
    Endpoints::receive_control();
}

template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::on_control_data(Span<const std::uint8_t> bytes) noexcept
{
    if (!data_comes_) {
        return;
    }
    data_comes_ = false;
    if (control_.take(bytes)) {
        Endpoints::send(0, {});
    } else {
        Endpoints::stall_control();
    }
}

template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::send_control() noexcept
{
    const Span<const std::uint8_t> all = control_.data();
    const std::size_t left = all.size() - control_sent_;
    const std::size_t size = left < kUsbPacket ? left : kUsbPacket;
    Endpoints::send(0, {all.data() + control_sent_, size});
    control_sent_ += static_cast<unsigned>(size);
    control_waits_ = size == kUsbPacket && (control_sent_ < all.size() || control_.data_is_short());
}

// Does what a request asks for beside its answer.
template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::apply_request() noexcept
{
    Endpoints::set_address(control_.address());
    if (control_.begins_anew()) {
        Endpoints::begin_bulk(control_.configured());
        armed_ = false;
        sending_ = false;
        full_packet_ = false;
    } else if (control_.configured()) {
        Endpoints::halt(control_.halted(kUsbBulkIn), control_.halted(kUsbBulkOut),
                        control_.halted(kUsbNotify), control_.resumed());
    }
    heard_ = heard_ && control_.terminal_ready();
    update_open();
}

template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::update_open() noexcept
{
    const bool open = control_.configured() && !suspended_ && (control_.terminal_ready() || heard_);
    if (open == open_.load(std::memory_order_relaxed)) {
        return;
    }
    if (open) {
        // Answers to a sender before are none of this one's.
        Endpoints::cancel_in(Endpoints::kBulk);
        sending_ = false;
        full_packet_ = false;
        send_tail_.store(send_head_.load(std::memory_order_relaxed), std::memory_order_release);
    } else {
        left_.store(true, std::memory_order_relaxed);
    }
    open_.store(open, std::memory_order_release);
}

template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::send_bulk() noexcept
{
    const std::uint32_t tail = send_tail_.load(std::memory_order_relaxed);
    const std::uint32_t waiting = send_head_.load(std::memory_order_acquire) - tail;
    const std::uint32_t to_end = kSendSize - tail % kSendSize;
    std::uint32_t size = waiting < to_end ? waiting : to_end;
    size = size < kUsbPacket ? size : kUsbPacket;
    if (sending_ || !open() || (size == 0 && !full_packet_) || control_.halted(kUsbBulkIn)) {
        return;
    }
    Endpoints::send(Endpoints::kBulk, {&sent_[tail % kSendSize], size});
    sending_ = true;
    full_packet_ = size == kUsbPacket;
    send_tail_.store(tail + size, std::memory_order_release);
}

template <class Endpoints, class Table>
void UsbSerial<Endpoints, Table>::arm_bulk() noexcept
{
    if (armed_ || control_.halted(kUsbBulkOut)) {
        return;
    }
    const bool room = received_.room() >= kUsbPacket;
    wants_room_.store(!room, std::memory_order_relaxed);
    if (room) {
        Endpoints::receive_bulk();
        armed_ = true;
    }
}

}  // namespace cusp::hal::usb_serial
