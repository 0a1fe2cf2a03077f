// Descriptors of a serial port over USB: class CDC, subclass ACM (USB 2.0 section 9.6, CDC 1.2 and PSTN 1.2).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace cusp::hal::usb_serial {

// How the board is called on the bus. `name` and `maker`: ASCII, at most kUsbLongestText characters.
struct UsbIdentity {
    // The pair that pid.codes gives away for tests: whoever sells a board takes one of his own.
    std::uint16_t vendor{0x1209};
    std::uint16_t product{0x0001};
    std::string_view name;
    std::string_view maker{"cusp"};
};

inline constexpr unsigned kUsbPacket = 64;  // bytes, of control and bulk endpoints at full speed
inline constexpr unsigned kUsbLongestText = 31;
inline constexpr std::uint8_t kUsbBulkIn = 0x81;
inline constexpr std::uint8_t kUsbBulkOut = 0x01;
inline constexpr std::uint8_t kUsbNotify = 0x82;

// Kinds of descriptors.
inline constexpr std::uint8_t kDeviceDescriptor = 1;
inline constexpr std::uint8_t kConfigurationDescriptor = 2;
inline constexpr std::uint8_t kTextDescriptor = 3;

enum class UsbText : std::uint8_t { kLanguages = 0, kMaker = 1, kName = 2, kSerial = 3 };

constexpr std::array<std::uint8_t, 18> device_descriptor(const UsbIdentity& identity) noexcept
{
    const auto low = [](std::uint16_t value) {
        return static_cast<std::uint8_t>(value & 0xFFU);
    };
    const auto high = [](std::uint16_t value) {
        return static_cast<std::uint8_t>(value >> 8U);
    };
    // USB 2.0; functions are grouped by an association descriptor.
    return {18,
            kDeviceDescriptor,
            0x00,
            0x02,
            0xEF,
            0x02,
            0x01,
            kUsbPacket,
            low(identity.vendor),
            high(identity.vendor),
            low(identity.product),
            high(identity.product),
            0x00,
            0x01,  // release 1.00
            static_cast<std::uint8_t>(UsbText::kMaker),
            static_cast<std::uint8_t>(UsbText::kName),
            static_cast<std::uint8_t>(UsbText::kSerial),
            1};
}

// clang-format off
inline constexpr std::array<std::uint8_t, 75> kUsbConfiguration{
    9, kConfigurationDescriptor, 75, 0, 2, 1, 0, 0xC0, 50,  // two interfaces, a supply of its own
    8, 11, 0, 2, 0x02, 0x02, 0x00, 0,                       // both are one ACM function
    9, 4, 0, 0, 1, 0x02, 0x02, 0x00, 0,                     // interface 0: control, no AT commands
    5, 0x24, 0x00, 0x20, 0x01,                              // CDC 1.20
    5, 0x24, 0x01, 0x00, 1,                                 // no call management
    4, 0x24, 0x02, 0x02,                                    // line coding and control line state
    5, 0x24, 0x06, 0, 1,                                    // interface 0 controls interface 1
    7, 5, kUsbNotify, 3, 8, 0, 16,                          // interrupt, each 16 ms
    9, 4, 1, 0, 2, 0x0A, 0x00, 0x00, 0,                     // interface 1: data
    7, 5, kUsbBulkOut, 2, kUsbPacket, 0, 0,
    7, 5, kUsbBulkIn, 2, kUsbPacket, 0, 0,
};
// clang-format on

// A text as a descriptor, in UTF-16; the rest of a longer one is left out.
class UsbTextDescriptor {
public:
    constexpr void clear() noexcept { bytes_ = {2, kTextDescriptor}; }
    constexpr void add(char character) noexcept
    {
        if (bytes_[0] + 2U <= bytes_.size()) {
            bytes_[bytes_[0]] = static_cast<std::uint8_t>(character);
            bytes_[bytes_[0] + 1U] = 0;
            bytes_[0] = static_cast<std::uint8_t>(bytes_[0] + 2U);
        }
    }
    const std::uint8_t* data() const noexcept { return bytes_.data(); }
    unsigned size() const noexcept { return bytes_[0]; }

private:
    std::array<std::uint8_t, 2 + 2 * kUsbLongestText> bytes_{2, kTextDescriptor};
};

}  // namespace cusp::hal::usb_serial
