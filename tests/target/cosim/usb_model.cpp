// RM0090 section 34.16: core, device and endpoint registers, FIFOs, interrupts.
#include "tests/target/cosim/usb_model.hpp"

#include <utility>

#include "tests/target/cosim/usb_bits.hpp"

namespace cusp::cosim {
using namespace usb_bits;

UsbModel::UsbModel(Circuit& circuit, Wiring wiring) : Model{circuit}, wiring_{std::move(wiring)}
{
    UsbModel::reset();
}

void UsbModel::reset()
{
    gotgctl_ = gahbcfg_ = gintsts_ = gintmsk_ = gccfg_ = pcgcctl_ = 0;
    gusbcfg_ = 0xA00;
    grxfsiz_ = 0x80;
    dcfg_ = 0x02200000;
    dctl_ = 0;  // the pull-up waits for the transceiver
    diepmsk_ = doepmsk_ = daintmsk_ = 0;
    txf_ = {};
    in_ = {};
    out_ = {};
    received_.clear();
    words_.clear();
    word_ = 0;
    popped_ = {};
    suspended_ = false;
    address_ = 0;
    change();
}

bool UsbModel::attached() const
{
    const bool powered = (gccfg_ >> 16U & 1U) != 0;
    const bool unsensed = (gccfg_ >> 21U & 1U) != 0;
    const bool session =
        wiring_.overrides_session ? !unsensed && (gotgctl_ >> 6U & 3U) == 3 : unsensed;
    const bool device = (gusbcfg_ >> 30U & 1U) != 0 && (dcfg_ & 3U) == 3;
    return powered && session && device && (dctl_ & 2U) == 0 && (pcgcctl_ & 1U) == 0 &&
           wiring_.pins_ready() && wiring_.clock_hz() == 48000000;
}

std::uint32_t UsbModel::all_endpoints() const
{
    std::uint32_t raised = 0;
    for (unsigned i = 0; i < kEndpoints; ++i) {
        raised |= (in_[i].intr & diepmsk_) != 0 ? 1U << i : 0U;
        raised |= (out_[i].intr & doepmsk_) != 0 ? 1U << (i + 16) : 0U;
    }
    return raised;
}

std::uint32_t UsbModel::status() const
{
    const std::uint32_t raised = all_endpoints() & daintmsk_;
    return gintsts_ | (received_.empty() ? 0U : kReceived) |
           ((raised & 0xFFFFU) != 0 ? kInEvent : 0U) | ((raised >> 16U) != 0 ? kOutEvent : 0U);
}

void UsbModel::change()
{
    circuit_.set_line(wiring_.interrupt, (gahbcfg_ & 1U) != 0 && (status() & gintmsk_) != 0);
    answers_otherwise();
}

std::uint32_t UsbModel::fifo_words(unsigned number) const { return txf_[number] >> 16U; }

// The FIFO of what was received: an entry of status and words each.
bool UsbModel::fits(std::size_t words) const
{
    std::size_t used = words_.size() - word_;
    for (const Received& entry : received_) {
        used += 1 + entry.words.size();
    }
    return used + words + 2 <= (grxfsiz_ & 0xFFFFU);
}

void UsbModel::push(unsigned kind,
                    unsigned endpoint,
                    const std::vector<std::uint8_t>& bytes,
                    std::function<void()> popped)
{
    Received entry{endpoint | static_cast<std::uint32_t>(bytes.size()) << 4U | kind << 17U,
                   {},
                   std::move(popped)};
    entry.words.resize(words_of(bytes.size()));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        entry.words[i / 4] |= std::uint32_t{bytes[i]} << 8U * (i % 4);
    }
    received_.push_back(std::move(entry));
}

std::uint32_t UsbModel::pop_status()
{
    if (received_.empty()) {
        circuit_.violate("USB: the FIFO is popped and empty");
        return 0;
    }
    if (word_ < words_.size()) {
        circuit_.violate("USB: words of a packet were left in the FIFO");
    }
    const Received entry = std::move(received_.front());
    received_.pop_front();
    words_ = entry.words;
    word_ = 0;
    if (entry.popped) {
        entry.popped();
    }
    change();
    return entry.status;
}

std::uint32_t UsbModel::pop_word()
{
    if (word_ >= words_.size()) {
        circuit_.violate("USB: a word is read that no packet has");
        return 0;
    }
    return words_[word_++];
}

void UsbModel::flush(std::uint32_t value)
{
    if ((value & 1U) != 0) {
        const std::uint32_t kept = gusbcfg_;
        reset();
        gusbcfg_ = kept;
        return;
    }
    const std::uint32_t number = value >> 6U & 31U;
    for (unsigned i = 0; i < kEndpoints; ++i) {
        if ((value >> 5U & 1U) != 0 && (number == 16 || number == i)) {
            if (in_[i].enabled && !in_[i].nak) {
                circuit_.violate("USB: the FIFO of an endpoint that sends is flushed");
            }
            in_[i].fifo.clear();
        }
    }
    if ((value >> 4U & 1U) != 0) {
        received_.clear();
    }
    change();
}

std::uint32_t UsbModel::read(std::uint32_t offset)
{
    if (offset >= kFifoSpace) {
        return pop_word();
    }
    if (offset >= 0x800) {
        return device_read(offset);
    }
    switch (offset) {
        case 0x00:
            return gotgctl_;
        case 0x08:
            return gahbcfg_;
        case 0x0C:
            return gusbcfg_;
        case 0x10:
            return 1U << 31U;  // idle; resets and flushes take no time
        case 0x14:
            return status();
        case 0x18:
            return gintmsk_;
        case 0x20:
            return pop_status();
        case 0x24:
            return grxfsiz_;
        case 0x38:
            return gccfg_;
        default:
            circuit_.violate("USB: read of a register that is not modelled, " +
                             hexadecimal(offset));
            return 0;
    }
}

std::uint32_t UsbModel::device_read(std::uint32_t offset) const
{
    if (offset >= 0x900 && offset < 0x900 + kEndpoints * 0x20) {
        const Endpoint& in = in_[(offset - 0x900) / 0x20];
        const std::uint32_t ctl = in.ctl | (in.enabled ? kEnable : 0U) | (in.nak ? kNakStatus : 0U);
        return offset % 0x20 == 0 ? ctl : offset % 0x20 == 8 ? in.intr : in.tsiz;
    }
    if (offset >= 0xB00 && offset < 0xB00 + kEndpoints * 0x20) {
        const Endpoint& out = out_[(offset - 0xB00) / 0x20];
        const std::uint32_t ctl =
            out.ctl | (out.enabled ? kEnable : 0U) | (out.nak ? kNakStatus : 0U);
        return offset % 0x20 == 0 ? ctl : offset % 0x20 == 8 ? out.intr : out.tsiz;
    }
    switch (offset) {
        case 0x800:
            return dcfg_;
        case 0x804:
            return dctl_;
        case 0x808:
            return 6U | (suspended_ ? 1U : 0U);  // full speed
        case 0x818:
            return all_endpoints();
        case 0x81C:
            return daintmsk_;
        default:
            circuit_.violate("USB: read of a register that is not modelled, " +
                             hexadecimal(offset));
            return 0;
    }
}

void UsbModel::write(std::uint32_t offset, std::uint32_t value)
{
    if (wiring_.clock_hz() != 48000000) {
        circuit_.violate("USB: its clock is " + std::to_string(wiring_.clock_hz()) + " Hz");
    }
    if (offset >= kFifoSpace) {
        write_fifo((offset - kFifoSpace) / kFifoSpace, value);
    } else if (offset >= 0x800) {
        device_write(offset, value);
    } else if (offset >= 0x104 && offset < 0x104 + 4 * (kEndpoints - 1)) {
        txf_[(offset - 0x104) / 4 + 1] = value;
    } else {
        switch (offset) {
            case 0x00:
                gotgctl_ = value;
                break;
            case 0x08:
                gahbcfg_ = value;
                break;
            case 0x0C:
                gusbcfg_ = value;
                break;
            case 0x10:
                flush(value);
                break;
            case 0x14:
                gintsts_ &= ~value;
                break;
            case 0x18:
                gintmsk_ = value;
                break;
            case 0x24:
                grxfsiz_ = value;
                break;
            case 0x28:
                txf_[0] = value;
                break;
            case 0x38:
                gccfg_ = value;
                break;
            default:
                circuit_.violate("USB: write to a register that is not modelled, " +
                                 hexadecimal(offset));
        }
    }
    change();
}

void UsbModel::device_write(std::uint32_t offset, std::uint32_t value)
{
    const bool in = offset >= 0x900 && offset < 0x900 + kEndpoints * 0x20;
    const bool out = offset >= 0xB00 && offset < 0xB00 + kEndpoints * 0x20;
    if (in || out) {
        const unsigned number = (offset - (in ? 0x900U : 0xB00U)) / 0x20;
        Endpoint& endpoint = in ? in_[number] : out_[number];
        if (offset % 0x20 == 0) {
            write_control(endpoint, number, in, value);
        } else if (offset % 0x20 == 8) {
            endpoint.intr &= ~value;
        } else {
            if (in && endpoint.enabled) {
                circuit_.violate("USB: the transfer of an endpoint that sends is changed");
            }
            endpoint.tsiz = value;
        }
        return;
    }
    switch (offset) {
        case 0x800:
            dcfg_ = value;
            break;
        case 0x804:
            dctl_ = value;
            break;
        case 0x810:
            diepmsk_ = value;
            break;
        case 0x814:
            doepmsk_ = value;
            break;
        case 0x81C:
            daintmsk_ = value;
            break;
        case 0xE00:
            pcgcctl_ = value;
            break;
        default:
            circuit_.violate("USB: write to a register that is not modelled, " +
                             hexadecimal(offset));
    }
}

void UsbModel::write_control(Endpoint& endpoint, unsigned number, bool in, std::uint32_t value)
{
    // The SETUP packet ends the stall of endpoint 0, no write does.
    const std::uint32_t stall = number == 0 ? endpoint.ctl & kStall : 0U;
    endpoint.ctl = (value & (0x7FFU | kActive | 3U << 18U | kStall | 15U << 22U)) | stall;
    if (in && (value >> 22U & 15U) != number) {
        if ((value & kActive) != 0) {
            circuit_.violate("USB: endpoint " + std::to_string(number) + " with another's FIFO");
        }
    }
    if (number != 0 && (value & kDataZero) != 0) {
        endpoint.data_one = false;
    }
    if (number != 0 && (value & kDataOne) != 0) {
        endpoint.data_one = true;
    }
    if ((value & kSetNak) != 0) {
        endpoint.nak = true;
    }
    if ((value & kClearNak) != 0) {
        endpoint.nak = false;
    }
    if ((value & kEnable) != 0) {
        endpoint.enabled = true;
        if ((endpoint.tsiz >> 19U & 0x3FFU) == 0 && (endpoint.tsiz >> 19U & 3U) == 0) {
            circuit_.violate("USB: a transfer of no packets");
        }
    }
    if ((value & kDisable) != 0) {
        if (!endpoint.nak || !in) {
            circuit_.violate("USB: an endpoint is disabled without its NAK");
        }
        endpoint.enabled = false;
        endpoint.intr |= kDisabled;
    }
}

void UsbModel::write_fifo(unsigned number, std::uint32_t word)
{
    if (number >= kEndpoints) {
        circuit_.violate("USB: a FIFO that is not there is written");
        return;
    }
    Endpoint& in = in_[number];
    std::uint32_t words = grxfsiz_ & 0xFFFFU;
    for (unsigned i = 0; i < kEndpoints; ++i) {
        words += fifo_words(i);
    }
    if (words > kFifoWords) {
        circuit_.violate("USB: FIFOs of " + std::to_string(words) + " words");
    }
    if (!in.enabled || in.fifo.size() >= fifo_words(number)) {
        circuit_.violate("USB: a word for an endpoint that has no room, or is off");
    }
    in.fifo.push_back(word);
}

}  // namespace cusp::cosim
