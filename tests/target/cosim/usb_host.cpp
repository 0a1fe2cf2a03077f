// A host's part of USB 2.0: section 8.5 for transfers, section 7.1.7 for plugs and sleep.
#include "tests/target/cosim/usb_host.hpp"

#include <algorithm>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr Picoseconds kIdleUntilSuspend = 3 * kMillisecond;
constexpr Picoseconds kPatience = 50 * kMillisecond;
constexpr Picoseconds kTry = 20 * kMicrosecond;

std::string name_of(Handshake handshake)
{
    switch (handshake) {
        case Handshake::kAck:
            return "ack";
        case Handshake::kStall:
            return "stall";
        case Handshake::kNak:
            return "late";
        case Handshake::kNone:
            break;
    }
    return "none";
}

}  // namespace

UsbHost::UsbHost(Circuit& circuit, UsbDevice& device) : Model{circuit}, device_{device}
{
    device_.set_listener([this] {
        refused_ = false;
        plan();
    });
}

void UsbHost::plug()
{
    buffer_.clear();
    plugged_ = true;
    asleep_ = false;
    suspend_at_ = kNever;
    address_ = 0;
    device_.bus_reset();
    plan();
}

void UsbHost::unplug()
{
    plugged_ = false;
    open_ = false;
    outgoing_.clear();
    suspend_at_ = circuit_.now + kIdleUntilSuspend;
    plan();
}

void UsbHost::suspend()
{
    asleep_ = true;
    suspend_at_ = circuit_.now + kIdleUntilSuspend;
    plan();
}

void UsbHost::resume()
{
    asleep_ = false;
    suspend_at_ = kNever;
    device_.resume();
    plan();
}

void UsbHost::open(bool on)
{
    open_ = on;
    plan();
}

void UsbHost::set_mute(bool on)
{
    mute_ = on;
    refused_ = false;
    plan();
}

void UsbHost::send(const std::string& bytes)
{
    outgoing_.insert(outgoing_.end(), bytes.begin(), bytes.end());
    refused_ = false;
    plan();
}

void UsbHost::plan()
{
    if (working_) {
        return;
    }
    const bool moves = plugged_ && open_ && !asleep_ && !refused_ &&
                       (!outgoing_.empty() || (!mute_ && device_.has_packet(kBulk)));
    due_ = std::min(suspend_at_, moves ? std::max(circuit_.now, last_ + slot_) : kNever);
    circuit_.next_event = 0;
}

void UsbHost::happen()
{
    working_ = true;
    if (suspend_at_ <= circuit_.now) {
        suspend_at_ = kNever;
        device_.suspend();
    } else {
        last_ = circuit_.now;
        const bool sent = send_packet();
        const bool fetched = fetch_packet();
        refused_ = !sent && !fetched;
    }
    working_ = false;
    plan();
}

std::string UsbHost::give(unsigned endpoint, const std::vector<std::uint8_t>& packet)
{
    bool& data_one = out_one_.at(endpoint);
    const Handshake answer = device_.out(address_, endpoint, packet, data_one);
    data_one = data_one != (answer == Handshake::kAck);
    return name_of(answer);
}

auto UsbHost::fetch(unsigned endpoint) -> Result
{
    Result result;
    bool data_one = false;
    const Handshake answer = device_.in(address_, endpoint, result.data, data_one);
    result.stage = name_of(answer);
    if (answer == Handshake::kAck) {
        bool& expected = in_one_.at(endpoint);
        if (data_one != expected) {
            circuit_.violate("USB: a packet with the wrong toggle");
        }
        expected = !data_one;
    }
    return result;
}

bool UsbHost::send_packet()
{
    if (outgoing_.empty()) {
        return false;
    }
    const auto size = static_cast<std::ptrdiff_t>(std::min(kPacket, outgoing_.size()));
    const std::vector<std::uint8_t> packet{outgoing_.begin(), outgoing_.begin() + size};
    if (give(kBulk, packet) != "ack") {
        return false;
    }
    outgoing_.erase(outgoing_.begin(), outgoing_.begin() + size);
    return true;
}

bool UsbHost::fetch_packet()
{
    const Result packet = mute_ ? Result{} : fetch(kBulk);
    if (packet.stage != "ack") {
        return false;
    }
    buffer_.insert(buffer_.end(), packet.data.begin(), packet.data.end());
    if (packet.data.size() == kPacket && buffer_.size() < kBuffer) {
        return true;
    }
    for (const std::uint8_t byte : buffer_) {
        if (receiver_) {
            receiver_(static_cast<char>(byte));
        }
    }
    buffer_.clear();
    return true;
}

Handshake UsbHost::wait(const std::function<Handshake()>& token,
                        const std::function<void(Picoseconds)>& run)
{
    Handshake answer = token();
    for (Picoseconds waited = 0; answer == Handshake::kNak && waited < kPatience; waited += kTry) {
        run(kTry);
        answer = token();
    }
    return answer;
}

void UsbHost::begin_only(const Request& request)
{
    static_cast<void>(device_.setup(address_, request.setup));
}

auto UsbHost::read_data(unsigned length, const std::function<void(Picoseconds)>& run) -> Result
{
    Result result{"ack", {}};
    bool expected = true;
    while (result.data.size() < length) {
        std::vector<std::uint8_t> packet;
        bool data_one = false;
        const Handshake answer =
            wait([&] { return device_.in(address_, 0, packet, data_one); }, run);
        if (answer != Handshake::kAck) {
            return {name_of(answer), {}};
        }
        if (data_one != expected) {
            circuit_.violate("USB: a packet with the wrong toggle on endpoint 0");
        }
        expected = !expected;
        result.data.insert(result.data.end(), packet.begin(), packet.end());
        if (packet.size() < kPacket) {
            break;
        }
    }
    if (result.data.size() > length) {
        circuit_.violate("USB: an answer longer than what was asked for");
    }
    return result;
}

auto UsbHost::control(const Request& request, const std::function<void(Picoseconds)>& run) -> Result
{
    const unsigned length = request.setup[6] | unsigned{request.setup[7]} << 8U;
    const bool to_host = (request.setup[0] & 0x80U) != 0 && length > 0;
    if (device_.setup(address_, request.setup) != Handshake::kAck) {
        return {"none", {}};
    }
    run(kTry);
    Result result{"ack", {}};
    if (to_host) {
        result = read_data(length, run);
    }
    bool data_one = true;
    for (std::size_t at = 0; at < request.data.size() && result.stage == "ack"; at += kPacket) {
        const std::size_t end = std::min(at + kPacket, request.data.size());
        const std::vector<std::uint8_t> packet(
            request.data.begin() + static_cast<std::ptrdiff_t>(at),
            request.data.begin() + static_cast<std::ptrdiff_t>(end));
        result.stage =
            name_of(wait([&] { return device_.out(address_, 0, packet, data_one); }, run));
        data_one = !data_one;
    }
    if (result.stage != "ack") {
        return {result.stage, {}};
    }
    std::vector<std::uint8_t> none;
    bool toggle = false;
    const Handshake end = wait(
        [&] {
            return to_host ? device_.out(address_, 0, {}, true)
                           : device_.in(address_, 0, none, toggle);
        },
        run);
    if (!to_host && end == Handshake::kAck && (!none.empty() || !toggle)) {
        circuit_.violate("USB: a status that is no empty DATA1");
    }
    run(kTry);
    constexpr std::uint8_t kSetConfiguration = 9;
    constexpr std::uint8_t kClearFeature = 1;
    if (request.setup[0] == 0 && request.setup[1] == kSetConfiguration) {
        out_one_ = in_one_ = {};
    } else if (request.setup[0] == 2 && request.setup[1] == kClearFeature) {
        const unsigned endpoint = request.setup[4];
        ((endpoint & 0x80U) != 0 ? in_one_ : out_one_).at(endpoint & 3U) = false;
    }
    return {name_of(end), result.data};
}

}  // namespace cusp::cosim
