// Requests of endpoint 0: those of USB 2.0 section 9.4 and of PSTN 1.2 section 6.3.
#include "hal/usb_serial/usb_control.hpp"

namespace cusp::hal::usb_serial {
namespace {

// bmRequestType: direction, kind, recipient.
constexpr std::uint8_t kToHost = 0x80;
constexpr std::uint8_t kStandardKind = 0x00;
constexpr std::uint8_t kClassOfInterface = 0x21;

constexpr std::uint8_t kGetStatus = 0;
constexpr std::uint8_t kClearFeature = 1;
constexpr std::uint8_t kSetFeature = 3;
constexpr std::uint8_t kSetAddress = 5;
constexpr std::uint8_t kGetDescriptor = 6;
constexpr std::uint8_t kGetConfiguration = 8;
constexpr std::uint8_t kSetConfiguration = 9;
constexpr std::uint8_t kGetInterface = 10;
constexpr std::uint8_t kSetInterface = 11;
constexpr std::uint8_t kSetLineCoding = 0x20;
constexpr std::uint8_t kGetLineCoding = 0x21;
constexpr std::uint8_t kSetControlLineState = 0x22;

constexpr unsigned kInterfaces = 2;
constexpr std::array<std::uint8_t, 3> kEndpoints{kUsbBulkIn, kUsbBulkOut, kUsbNotify};

// The bit of an endpoint in halted_; 0 where there is none.
std::uint8_t endpoint_bit(std::uint16_t endpoint) noexcept
{
    for (unsigned i = 0; i < kEndpoints.size(); ++i) {
        if (kEndpoints[i] == endpoint) {
            return static_cast<std::uint8_t>(1U << i);
        }
    }
    return 0;
}

// A request without data, with these values.
bool is_plain(const UsbSetup& setup, unsigned most_value, unsigned index) noexcept
{
    return setup.value <= most_value && setup.index == index && setup.length == 0;
}

}  // namespace

UsbSetup read_setup(const std::array<std::uint8_t, 8>& bytes) noexcept
{
    const auto word = [&bytes](unsigned at) {
        return static_cast<std::uint16_t>(bytes[at] | unsigned{bytes[at + 1]} << 8U);
    };
    return {bytes[0], bytes[1], word(2), word(4), word(6)};
}

void UsbControl::reset() noexcept
{
    address_ = 0;
    configuration_ = 0;
    halted_ = 0;
    lines_ = 0;
    coding_comes_ = false;
    size_ = 0;
}

bool UsbControl::halted(std::uint8_t endpoint) const noexcept
{
    return (halted_ & endpoint_bit(endpoint)) != 0;
}

UsbStage UsbControl::answer(const std::uint8_t* data, unsigned size, const UsbSetup& setup) noexcept
{
    data_ = data;
    size_ = size < setup.length ? size : setup.length;
    short_ = size < setup.length;
    // Without a data stage the status goes to the host.
    return setup.length == 0 ? UsbStage::kStatus : UsbStage::kDataIn;
}

UsbStage UsbControl::begin(const UsbSetup& setup) noexcept
{
    size_ = 0;
    short_ = false;
    resumed_ = 0;
    begins_anew_ = false;
    coding_comes_ = false;
    switch (setup.type & 0x7FU) {
        case kStandardKind | 0U:
            return device_request(setup);
        case kStandardKind | 1U:
            return interface_request(setup);
        case kStandardKind | 2U:
            return endpoint_request(setup);
        case kClassOfInterface:
            return class_request(setup);
        default:
            return UsbStage::kStall;
    }
}

UsbStage UsbControl::device_request(const UsbSetup& setup) noexcept
{
    const bool to_host = (setup.type & kToHost) != 0;
    if (to_host && setup.request == kGetDescriptor) {
        return descriptor(setup);
    }
    if (to_host && setup.request == kGetStatus && setup.value == 0 && setup.index == 0) {
        short_answer_ = {1, 0};  // a supply of its own; it does not wake the host
        return answer(short_answer_.data(), 2, setup);
    }
    if (to_host && setup.request == kGetConfiguration && setup.value == 0 && setup.index == 0) {
        short_answer_ = {configuration_, 0};
        return answer(short_answer_.data(), 1, setup);
    }
    if (!to_host && setup.request == kSetAddress && is_plain(setup, 127, 0) && !configured()) {
        address_ = static_cast<std::uint8_t>(setup.value);
        return UsbStage::kStatus;
    }
    if (!to_host && setup.request == kSetConfiguration && is_plain(setup, 1, 0) && address_ != 0) {
        return set_configuration(setup);
    }
    return UsbStage::kStall;
}

UsbStage UsbControl::set_configuration(const UsbSetup& setup) noexcept
{
    configuration_ = static_cast<std::uint8_t>(setup.value);
    halted_ = 0;
    lines_ = 0;
    begins_anew_ = true;
    return UsbStage::kStatus;
}

UsbStage UsbControl::interface_request(const UsbSetup& setup) noexcept
{
    const bool to_host = (setup.type & kToHost) != 0;
    if (!configured() || setup.index >= kInterfaces || setup.value != 0) {
        return UsbStage::kStall;
    }
    short_answer_ = {0, 0};
    if (to_host && setup.request == kGetStatus) {
        return answer(short_answer_.data(), 2, setup);
    }
    if (to_host && setup.request == kGetInterface) {
        return answer(short_answer_.data(), 1, setup);
    }
    if (!to_host && setup.request == kSetInterface && setup.length == 0) {
        begins_anew_ = setup.index == 1;  // the interface of both bulk endpoints
        halted_ = begins_anew_ ? std::uint8_t{0} : halted_;
        return UsbStage::kStatus;
    }
    return UsbStage::kStall;
}

UsbStage UsbControl::endpoint_request(const UsbSetup& setup) noexcept
{
    const bool to_host = (setup.type & kToHost) != 0;
    const bool control = setup.index == 0 || setup.index == kToHost;
    const std::uint8_t bit = configured() ? endpoint_bit(setup.index) : std::uint8_t{0};
    // The only feature is the halt, which is 0.
    if (setup.value != 0 || (bit == 0 && !control)) {
        return UsbStage::kStall;
    }
    if (to_host && setup.request == kGetStatus) {
        short_answer_ = {static_cast<std::uint8_t>((halted_ & bit) != 0 ? 1U : 0U), 0};
        return answer(short_answer_.data(), 2, setup);
    }
    if (to_host || setup.length != 0) {
        return UsbStage::kStall;
    }
    if (setup.request == kClearFeature) {
        halted_ = static_cast<std::uint8_t>(halted_ & ~unsigned{bit});
        resumed_ = bit == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(setup.index);
        return UsbStage::kStatus;
    }
    if (setup.request == kSetFeature && bit != 0) {
        halted_ = static_cast<std::uint8_t>(halted_ | bit);
        return UsbStage::kStatus;
    }
    return UsbStage::kStall;
}

UsbStage UsbControl::class_request(const UsbSetup& setup) noexcept
{
    const bool to_host = (setup.type & kToHost) != 0;
    if (!configured() || setup.index != 0) {
        return UsbStage::kStall;
    }
    if (to_host && setup.request == kGetLineCoding && setup.value == 0) {
        return answer(coding_.data(), static_cast<unsigned>(coding_.size()), setup);
    }
    if (!to_host && setup.request == kSetLineCoding && setup.value == 0 &&
        setup.length == coding_.size()) {
        coding_comes_ = true;
        return UsbStage::kDataOut;
    }
    if (!to_host && setup.request == kSetControlLineState && is_plain(setup, 0xFFFF, 0)) {
        lines_ = static_cast<std::uint8_t>(setup.value & 3U);
        return UsbStage::kStatus;
    }
    return UsbStage::kStall;
}

bool UsbControl::take(Span<const std::uint8_t> bytes) noexcept
{
    const bool good = coding_comes_ && bytes.size() == coding_.size();
    coding_comes_ = false;
    for (unsigned i = 0; good && i < coding_.size(); ++i) {
        coding_[i] = bytes[i];
    }
    return good;
}

UsbStage UsbControl::descriptor(const UsbSetup& setup) noexcept
{
    const unsigned kind = setup.value >> 8U;
    const unsigned number = setup.value & 0xFFU;
    if (kind == kTextDescriptor) {
        return text(setup);
    }
    if (number != 0 || setup.index != 0) {
        return UsbStage::kStall;
    }
    if (kind == kDeviceDescriptor) {
        return answer(device_.data(), static_cast<unsigned>(device_.size()), setup);
    }
    if (kind == kConfigurationDescriptor) {
        return answer(kUsbConfiguration.data(), static_cast<unsigned>(kUsbConfiguration.size()),
                      setup);
    }
    return UsbStage::kStall;
}

// In whatever language is asked for: there is one.
UsbStage UsbControl::text(const UsbSetup& setup) noexcept
{
    static constexpr std::array<std::uint8_t, 4> kEnglish{4, kTextDescriptor, 0x09, 0x04};
    text_.clear();
    switch (static_cast<UsbText>(setup.value & 0xFFU)) {
        case UsbText::kLanguages:
            return answer(kEnglish.data(), static_cast<unsigned>(kEnglish.size()), setup);
        case UsbText::kMaker:
        case UsbText::kName: {
            const bool maker = (setup.value & 0xFFU) == static_cast<unsigned>(UsbText::kMaker);
            for (const char character : maker ? identity_.maker : identity_.name) {
                text_.add(character);
            }
            break;
        }
        case UsbText::kSerial:
            for (const std::uint32_t word : unique_) {
                for (unsigned place = 32; place > 0; place -= 4) {
                    text_.add("0123456789ABCDEF"[word >> (place - 4) & 15U]);
                }
            }
            break;
        default:
            return UsbStage::kStall;
    }
    return answer(text_.data(), text_.size(), setup);
}

}  // namespace cusp::hal::usb_serial
