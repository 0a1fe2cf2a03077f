// UsbControl: answers the requests that a host makes on endpoint 0, without a register in sight.
//
// It knows the requests of USB 2.0 chapter 9 and of the class that a serial port needs; every other
// one stalls, and no answer is longer than the host asked for.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/span.hpp"
#include "hal/usb_serial/usb_descriptors.hpp"

namespace cusp::hal::usb_serial {

// The eight bytes of a SETUP packet (USB 2.0 section 9.3).
struct UsbSetup {
    std::uint8_t type;
    std::uint8_t request;
    std::uint16_t value;
    std::uint16_t index;
    std::uint16_t length;
};
UsbSetup read_setup(const std::array<std::uint8_t, 8>& bytes) noexcept;

// The stage that follows a SETUP packet on endpoint 0.
enum class UsbStage : std::uint8_t {
    kStall,    // the request is refused
    kStatus,   // an empty packet to the host
    kDataIn,   // data() to the host, which acknowledges
    kDataOut,  // `length` bytes from the host, for take()
};

// Context: the interrupt of USB.
class UsbControl {
public:
    // `unique`: the chip's number, from which the serial number is made.
    UsbControl(const UsbIdentity& identity, const std::array<std::uint32_t, 3>& unique) noexcept
        : identity_{identity}, unique_{unique}, device_{device_descriptor(identity)}
    {
    }

    // The bus was reset: neither address nor configuration.
    void reset() noexcept;
    UsbStage begin(const UsbSetup& setup) noexcept;
    // The bytes of the data stage that begin() asked for. Returns whether they are accepted.
    bool take(Span<const std::uint8_t> bytes) noexcept;

    Span<const std::uint8_t> data() const noexcept { return {data_, size_}; }
    // True if data() is shorter than what was asked for: an empty packet ends one of whole packets.
    bool data_is_short() const noexcept { return short_; }

    unsigned address() const noexcept { return address_; }
    bool configured() const noexcept { return configuration_ != 0; }
    // SET_CONFIGURATION or SET_INTERFACE: endpoints begin anew, with DATA0.
    bool begins_anew() const noexcept { return begins_anew_; }
    // The endpoint whose halt was cleared, so that it begins with DATA0; 0: none.
    std::uint8_t resumed() const noexcept { return resumed_; }
    bool halted(std::uint8_t endpoint) const noexcept;
    // DTR: a program holds the port open.
    bool terminal_ready() const noexcept { return (lines_ & 1U) != 0; }
    // Bytes per second have no meaning here: kept for whoever asks.
    const std::array<std::uint8_t, 7>& line_coding() const noexcept { return coding_; }

private:
    UsbStage answer(const std::uint8_t* data, unsigned size, const UsbSetup& setup) noexcept;
    UsbStage device_request(const UsbSetup& setup) noexcept;
    UsbStage interface_request(const UsbSetup& setup) noexcept;
    UsbStage endpoint_request(const UsbSetup& setup) noexcept;
    UsbStage class_request(const UsbSetup& setup) noexcept;
    UsbStage descriptor(const UsbSetup& setup) noexcept;
    UsbStage text(const UsbSetup& setup) noexcept;
    UsbStage set_configuration(const UsbSetup& setup) noexcept;

    const UsbIdentity identity_;
    const std::array<std::uint32_t, 3> unique_;
    const std::array<std::uint8_t, 18> device_;
    UsbTextDescriptor text_;
    std::array<std::uint8_t, 2> short_answer_{};
    const std::uint8_t* data_{nullptr};
    unsigned size_{0};
    bool short_{false};
    std::uint8_t address_{0};
    std::uint8_t configuration_{0};
    std::uint8_t halted_{0};  // bits of kEndpoints
    std::uint8_t resumed_{0};
    bool begins_anew_{false};
    bool coding_comes_{false};
    std::uint8_t lines_{0};
    std::array<std::uint8_t, 7> coding_{0x00, 0xC2, 0x01, 0x00, 0, 0, 8};  // 115200, 8N1
};

}  // namespace cusp::hal::usb_serial
