// Section 12.7 of the data sheet.
#include "tests/target/cosim/rp2350/usb_controller.hpp"

#include <algorithm>
#include <cstring>

namespace cusp::cosim::rp2350 {
namespace {

// Of a buffer's control word.
constexpr std::uint32_t kFull = 1U << 15U;
constexpr std::uint32_t kDataOne = 1U << 13U;
constexpr std::uint32_t kStall = 1U << 11U;
constexpr std::uint32_t kAvailable = 1U << 10U;
constexpr std::uint32_t kLength = 0x3FF;
// Of an endpoint's.
constexpr std::uint32_t kEndpointOn = 1U << 31U;
constexpr std::uint32_t kDoubleBuffered = 1U << 30U;
constexpr std::uint32_t kInterruptPerBuffer = 1U << 29U;
// Of SIE_STATUS; written ones clear them.
constexpr std::uint32_t kSequenceError = 1U << 31U;
constexpr std::uint32_t kBusReset = 1U << 19U;
constexpr std::uint32_t kTransactionComplete = 1U << 18U;
constexpr std::uint32_t kSetupReceived = 1U << 17U;
constexpr std::uint32_t kConnected = 1U << 16U;
constexpr std::uint32_t kResume = 1U << 11U;
constexpr std::uint32_t kSuspended = 1U << 4U;

constexpr std::uint32_t kFirstBuffers = 0x80;
constexpr std::uint32_t kEndOfBuffers = 0x100;
constexpr std::uint32_t kFirstData = 0x100;
constexpr unsigned kMostPacket = 64;

}  // namespace

UsbController::UsbController(Circuit& circuit, Wiring wiring)
    : Model{circuit}, wiring_{std::move(wiring)}
{
}

void UsbController::reset()
{
    address_ = sie_status_ = buff_status_ = abort_ = abort_done_ = stall_arm_ = power_ = 0;
    enabled_ = forced_ = 0;
    main_ = 4;
    sie_ctrl_ = 0x8000;
    muxing_ = 1;
    suspended_ = false;
    memory_.fill(0x5A);  // it is not cleared by a reset
    change();
}

std::uint32_t UsbController::word(std::uint32_t offset) const
{
    std::uint32_t value = 0;
    std::memcpy(&value, &memory_[offset], 4);
    return value;
}

void UsbController::set_word(std::uint32_t offset, std::uint32_t value)
{
    std::memcpy(&memory_[offset], &value, 4);
}

std::uint32_t UsbController::read_memory(std::uint32_t offset, unsigned size)
{
    std::uint32_t value = 0;
    std::memcpy(&value, &memory_[offset % kMemory], size);
    return value;
}

void UsbController::write_memory(std::uint32_t offset, unsigned size, std::uint32_t value)
{
    const std::uint32_t place = offset % kMemory & ~3U;
    const std::uint32_t before = word(place);
    std::memcpy(&memory_[offset % kMemory], &value, size);
    if (place >= kFirstBuffers && place < kEndOfBuffers) {
        check_control(place, before, word(place));
        change();
    }
}

// The controller reads a control word by another clock: AVAILABLE follows the rest in a write of its own, and
// what is available is the controller's.
void UsbController::check_control(std::uint32_t offset, std::uint32_t before, std::uint32_t after)
{
    const unsigned endpoint = (offset - kFirstBuffers) / 8;
    const bool in = offset % 8 == 0;
    const std::string name = "USB: the buffer of endpoint " + std::to_string(endpoint);
    constexpr std::uint32_t kRest = 0xFFFF & ~kAvailable;
    const bool aborted = (abort_ & bit_of(endpoint, in)) != 0;
    if ((~before & after & kAvailable) != 0 && ((before ^ after) & kRest) != 0) {
        circuit_.violate(name + " is made available in the write of its other bits");
    }
    const bool stays = (before & after & kAvailable) != 0;
    if ((before & kAvailable) != 0 && !aborted && before != after && (stays || attached())) {
        circuit_.violate(name + " is changed while it is the controller's");
    }
}

bool UsbController::attached() const
{
    constexpr std::uint32_t kToPhy = 9;         // and SOFTCON
    constexpr std::uint32_t kForcedPower = 12;  // VBUS_DETECT and its override
    return (main_ & 7U) == 1 && (sie_ctrl_ >> 16U & 1U) != 0 && (muxing_ & kToPhy) == kToPhy &&
           (power_ & kForcedPower) == kForcedPower && wiring_.clock_hz() == 48000000;
}

bool UsbController::answers(unsigned address) const
{
    return attached() && !suspended_ && (sie_status_ & kBusReset) == 0 &&
           (address_ & 127U) == address;
}

std::uint32_t UsbController::data_of(unsigned endpoint, bool in) const
{
    return endpoint == 0 ? kFirstData : word(control_of(endpoint, in)) & 0xFC0U;
}

bool UsbController::enabled(unsigned endpoint, bool in) const
{
    return endpoint == 0 || (word(control_of(endpoint, in)) & kEndpointOn) != 0;
}

bool UsbController::stalls(unsigned endpoint, bool in) const
{
    const bool armed = endpoint != 0 || (stall_arm_ & bit_of(0, in)) != 0;
    return armed && (word(buffer_of(endpoint, in)) & kStall) != 0;
}

bool UsbController::available(unsigned endpoint, bool in) const
{
    return (word(buffer_of(endpoint, in)) & kAvailable) != 0 &&
           (abort_ & bit_of(endpoint, in)) == 0;
}

void UsbController::bus_reset()
{
    suspended_ = false;
    sie_status_ = (sie_status_ & ~kSuspended) | kBusReset | kConnected;
    change();
}

void UsbController::suspend()
{
    suspended_ = true;
    sie_status_ |= kSuspended;
    change();
}

void UsbController::resume()
{
    if (suspended_) {
        suspended_ = false;
        sie_status_ |= kResume;
        change();
    }
}

Handshake UsbController::setup(unsigned address, const std::array<std::uint8_t, 8>& bytes)
{
    if (!answers(address)) {
        return Handshake::kNone;
    }
    std::copy(bytes.begin(), bytes.end(), memory_.begin());
    stall_arm_ = 0;
    sie_status_ |= kSetupReceived;
    change();
    return Handshake::kAck;
}

void UsbController::complete(unsigned endpoint, bool in, std::uint32_t control)
{
    set_word(buffer_of(endpoint, in), control);
    const bool tells = endpoint == 0 ? (sie_ctrl_ >> 29U & 1U) != 0
                                     : (word(control_of(endpoint, in)) & kInterruptPerBuffer) != 0;
    buff_status_ |= tells ? bit_of(endpoint, in) : 0U;
    sie_status_ |= kTransactionComplete;
    change();
}

Handshake UsbController::out(unsigned address,
                             unsigned endpoint,
                             const std::vector<std::uint8_t>& bytes,
                             bool data_one)
{
    if (!answers(address) || !enabled(endpoint, false)) {
        return Handshake::kNone;
    }
    if (stalls(endpoint, false)) {
        return Handshake::kStall;
    }
    std::uint32_t control = word(buffer_of(endpoint, false));
    if (!available(endpoint, false)) {
        return Handshake::kNak;
    }
    if ((control & kFull) != 0) {
        circuit_.violate("USB: a buffer to be received is full");
    }
    if (((control & kDataOne) != 0) != data_one) {
        sie_status_ |= kSequenceError;
        return Handshake::kAck;  // a repetition
    }
    if (bytes.size() > (control & kLength)) {
        circuit_.violate("USB: a packet longer than its buffer");
    }
    const std::uint32_t to = data_of(endpoint, false);
    std::copy(bytes.begin(), bytes.end(), memory_.begin() + to);
    control =
        (control & ~(kAvailable | kLength)) | kFull | static_cast<std::uint32_t>(bytes.size());
    complete(endpoint, false, control);
    return Handshake::kAck;
}

Handshake UsbController::in(unsigned address,
                            unsigned endpoint,
                            std::vector<std::uint8_t>& bytes,
                            bool& data_one)
{
    if (!answers(address) || !enabled(endpoint, true)) {
        return Handshake::kNone;
    }
    if (stalls(endpoint, true)) {
        return Handshake::kStall;
    }
    if (!has_packet(endpoint)) {
        return Handshake::kNak;
    }
    const std::uint32_t control = word(buffer_of(endpoint, true));
    const std::uint32_t size = control & kLength;
    if (size > kMostPacket) {
        circuit_.violate("USB: a packet of " + std::to_string(size) + " bytes");
    }
    const std::uint32_t from = data_of(endpoint, true);
    bytes.assign(memory_.begin() + from, memory_.begin() + from + size);
    data_one = (control & kDataOne) != 0;
    complete(endpoint, true, control & ~(kAvailable | kFull));
    return Handshake::kAck;
}

bool UsbController::has_packet(unsigned endpoint) const
{
    return enabled(endpoint, true) && available(endpoint, true) &&
           (word(buffer_of(endpoint, true)) & kFull) != 0;
}

std::uint32_t UsbController::raw() const
{
    return ((sie_status_ & kTransactionComplete) != 0 ? 1U << 3U : 0U) |
           (buff_status_ != 0 ? 1U << 4U : 0U) |
           ((sie_status_ & kSequenceError) != 0 ? 1U << 5U : 0U) |
           ((sie_status_ & kBusReset) != 0 ? 1U << 12U : 0U) |
           ((sie_status_ & kConnected) != 0 ? 1U << 13U : 0U) |
           ((sie_status_ & kSuspended) != 0 ? 1U << 14U : 0U) |
           ((sie_status_ & kResume) != 0 ? 1U << 15U : 0U) |
           ((sie_status_ & kSetupReceived) != 0 ? 1U << 16U : 0U) |
           (abort_done_ != 0 ? 1U << 18U : 0U);
}

void UsbController::change()
{
    circuit_.set_line(wiring_.interrupt, ((raw() & enabled_) | forced_) != 0);
    answers_otherwise();
}

std::uint32_t UsbController::read(std::uint32_t offset)
{
    switch (offset) {
        case 0x00:
            return address_;
        case 0x40:
            return main_;
        case 0x48:
            return static_cast<std::uint32_t>(circuit_.now / kMillisecond) & 0x7FFU;
        case 0x4C:
            return sie_ctrl_;
        case 0x50:
            return sie_status_;
        case 0x58:
            return buff_status_;
        case 0x5C:
            return 0;
        case 0x60:
            return abort_;
        case 0x64:
            return abort_done_;
        case 0x68:
            return stall_arm_;
        case 0x70:
            return 0;
        case 0x74:
            return muxing_;
        case 0x78:
            return power_;
        case 0x8C:
            return raw();
        case 0x90:
            return enabled_;
        case 0x94:
            return forced_;
        case 0x98:
            return (raw() & enabled_) | forced_;
        default:
            circuit_.violate("USB: a register is read that is not modelled, " +
                             hexadecimal(offset));
            return 0;
    }
}

void UsbController::write(std::uint32_t offset, std::uint32_t value)
{
    switch (offset) {
        case 0x00:
            address_ = value;
            break;
        case 0x40:
            main_ = value;
            break;
        case 0x4C:
            sie_ctrl_ = value;
            break;
        case 0x50:
            sie_status_ &= ~value;
            break;
        case 0x58:
            buff_status_ &= ~value;
            break;
        case 0x60:
            // No packet is under way between two events: the abort is done at once.
            abort_done_ |= value & ~abort_;
            abort_ = value;
            break;
        case 0x64:
            abort_done_ &= ~value;
            break;
        case 0x68:
            stall_arm_ = value;
            break;
        case 0x74:
            muxing_ = value;
            break;
        case 0x78:
            power_ = value;
            break;
        case 0x90:
            enabled_ = value;
            break;
        case 0x94:
            forced_ = value;
            break;
        default:
            circuit_.violate("USB: a register is written that is not modelled, " +
                             hexadecimal(offset));
    }
    for (unsigned endpoint = 1; endpoint < 16; ++endpoint) {
        for (const bool in : {true, false}) {
            const std::uint32_t control = word(control_of(endpoint, in));
            constexpr std::uint32_t kOnAndDouble = kEndpointOn | kDoubleBuffered;
            if (attached() && (control & kOnAndDouble) == kOnAndDouble) {
                circuit_.violate("USB: two buffers for an endpoint, which is not modelled");
            }
        }
    }
    change();
}

}  // namespace cusp::cosim::rp2350
