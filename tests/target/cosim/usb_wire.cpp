// The block's answers to the tokens of a host, and to the states of the wire (RM0090 section 34.17).
#include <cstddef>

#include "tests/target/cosim/usb_bits.hpp"
#include "tests/target/cosim/usb_model.hpp"

namespace cusp::cosim {

using namespace usb_bits;

void UsbModel::bus_reset()
{
    suspended_ = false;
    address_ = 0;
    for (unsigned i = 0; i < kEndpoints; ++i) {
        in_[i].ctl &= ~kStall;
        out_[i].ctl &= ~kStall;
        in_[i].nak = out_[i].nak = true;
        if (i > 0) {
            in_[i].ctl &= ~kActive;
            out_[i].ctl &= ~kActive;
        }
    }
    gintsts_ |= kReset | kEnumerated;
    change();
}

void UsbModel::suspend()
{
    suspended_ = true;
    gintsts_ |= kSuspend;
    change();
}

void UsbModel::resume()
{
    if (suspended_) {
        suspended_ = false;
        gintsts_ |= kWakeUp;
        change();
    }
}

bool UsbModel::answers(unsigned address) const
{
    return attached() && !suspended_ && (gintsts_ & kReset) == 0 && address_ == address;
}

Handshake UsbModel::setup(unsigned address, const std::array<std::uint8_t, 8>& bytes)
{
    Endpoint& out = out_[0];
    if (!answers(address) || !fits(3)) {
        return Handshake::kNone;
    }
    if ((out.tsiz >> 29U) == 0) {
        circuit_.violate("USB: a SETUP packet that endpoint 0 does not await");
    }
    in_[0].nak = out.nak = true;
    in_[0].ctl &= ~kStall;
    out.ctl &= ~kStall;
    in_[0].data_one = out.data_one = true;
    out.enabled = false;
    push(kSetupData, 0, {bytes.begin(), bytes.end()}, {});
    push(kSetupEnd, 0, {}, [&out] { out.intr |= kSetupDone; });
    change();
    return Handshake::kAck;
}

Handshake UsbModel::out(unsigned address,
                        unsigned endpoint,
                        const std::vector<std::uint8_t>& bytes,
                        bool data_one)
{
    Endpoint& out = out_.at(endpoint);
    const bool active = endpoint == 0 || (out.ctl & kActive) != 0;
    if (!answers(address) || !active) {
        return Handshake::kNone;
    }
    if ((out.ctl & kStall) != 0) {
        return Handshake::kStall;
    }
    if (!out.enabled || out.nak || !fits(words_of(bytes.size()) + 1)) {
        return Handshake::kNak;
    }
    if (data_one != out.data_one) {
        return Handshake::kAck;  // a repetition
    }
    if (bytes.size() > (out.tsiz & kSize)) {
        circuit_.violate("USB: a packet longer than the endpoint's transfer");
    }
    out.data_one = !out.data_one;
    push(kOutData, endpoint, bytes, {});
    push(kOutDone, endpoint, {}, [&out] { out.intr |= kDone; });
    out.tsiz &= ~(0x3FFU << 19U | kSize);
    out.enabled = false;
    out.nak = true;
    change();
    return Handshake::kAck;
}

Handshake UsbModel::in(unsigned address,
                       unsigned endpoint,
                       std::vector<std::uint8_t>& bytes,
                       bool& data_one)
{
    Endpoint& in = in_.at(endpoint);
    const bool active = endpoint == 0 || (in.ctl & kActive) != 0;
    if (!answers(address) || !active) {
        return Handshake::kNone;
    }
    if ((in.ctl & kStall) != 0) {
        return Handshake::kStall;
    }
    const std::size_t size = in.tsiz & kSize;
    if (!has_packet(endpoint)) {
        return Handshake::kNak;
    }
    if (in.fifo.size() > words_of(size)) {
        circuit_.violate("USB: more words in the FIFO than the packet has");
    }
    bytes.clear();
    for (std::size_t i = 0; i < size; ++i) {
        bytes.push_back(static_cast<std::uint8_t>(in.fifo[i / 4] >> 8U * (i % 4)));
    }
    in.fifo.erase(in.fifo.begin(), in.fifo.begin() + static_cast<std::ptrdiff_t>(words_of(size)));
    data_one = in.data_one;
    in.data_one = !in.data_one;
    in.tsiz &= ~(0x3FFU << 19U | kSize);
    in.enabled = false;
    in.nak = true;
    in.intr |= kDone;
    if (endpoint == 0) {
        address_ = dcfg_ >> 4U & 0x7FU;
    }
    change();
    return Handshake::kAck;
}

bool UsbModel::has_packet(unsigned endpoint) const
{
    const Endpoint& in = in_.at(endpoint);
    return in.enabled && !in.nak && in.fifo.size() >= words_of(in.tsiz & kSize);
}

}  // namespace cusp::cosim
