// Chapter 5 of the data sheet: sections 5.4 (functions) and 5.9 (blocks of an image).
#include "tests/target/cosim/rp2350/boot_rom.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace cusp::cosim::rp2350 {
namespace {

constexpr std::uint32_t kFirstFunction = 0x200;
constexpr std::uint32_t kFunctionBytes = 0x40;
constexpr std::uint32_t kForSecureCode = 4;  // of the mask of a look-up
enum Function : unsigned {
    kLookUp,
    kConnect,
    kExitXip,
    kErase,
    kProgram,
    kFlush,
    kEnterXip,
    kReboot,
    kFunctions
};
constexpr const char* kCodes[kFunctions] = {"", "IF", "EX", "RE", "RP", "FC", "CX", "RB"};

std::uint32_t address_of(unsigned function)
{
    return (kFirstFunction + function * kFunctionBytes) | 1U;
}

}  // namespace

BootRom::BootRom(Circuit& circuit, std::uint32_t flash_bytes, Wiring wiring)
    : circuit_{circuit},
      wiring_{std::move(wiring)},
      gate_{circuit,
            [this](std::uint32_t offset) {
                if (offset == 20) {
                    // A look at the flash's state takes a while.
                    const bool busy = circuit_.now < busy_until_;
                    circuit_.now += busy ? std::min(kMicrosecond, busy_until_ - circuit_.now) : 0;
                    return busy ? 1U : 0U;
                }
                return result_;
            },
            [this](std::uint32_t offset, std::uint32_t value) {
                if (offset < 16) {
                    arguments_[offset / 4] = value;
                } else {
                    result_ = call(value);
                }
            },
            [] {
            }},
      flash_(flash_bytes, 0xFF),
      view_(flash_bytes, 0xFF)
{
}

// Each function hands its arguments over and waits until the model has done with them.
std::vector<std::uint8_t> BootRom::code()
{
    std::vector<std::uint8_t> bytes(kRomBytes, 0);
    const auto put = [&bytes](std::uint32_t at, std::uint32_t value, unsigned size) {
        std::memcpy(&bytes[at], &value, size);
    };
    put(0x10, 0x0002754D, 4);
    put(0x16, address_of(kLookUp), 2);
    // push {r4, lr}; ldr r4, gate; four stores; ldr r0, number; str; loop: ldr, cmp, bne; ldr r0; pop {r4, pc}
    constexpr std::uint16_t kCode[] = {0xB510, 0x4C06, 0x6020, 0x6061, 0x60A2, 0x60E3, 0x4804,
                                       0x6120, 0x6960, 0x2800, 0xD1FC, 0x69A0, 0xBD10, 0xBF00};
    for (unsigned function = 0; function < kFunctions; ++function) {
        const std::uint32_t at = kFirstFunction + function * kFunctionBytes;
        std::memcpy(&bytes[at], kCode, sizeof kCode);
        put(at + sizeof kCode, kGate, 4);
        put(at + sizeof kCode + 4, function, 4);
    }
    return bytes;
}

void BootRom::load(const std::vector<std::uint8_t>& image)
{
    if (image.size() > flash_.size()) {
        throw std::runtime_error{"the image is larger than the flash"};
    }
    std::copy(image.begin(), image.end(), flash_.begin());
    show();
}

// The first block within 4 KB: an executable for this chip's Arm cores, secure; its loop of blocks closes.
std::uint32_t BootRom::vectors() const
{
    constexpr std::uint32_t kBegin = 0xFFFFDED3;
    constexpr std::uint32_t kEnd = 0xAB123579;
    const auto word = [this](std::uint32_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, &flash_.at(at), 4);
        return value;
    };
    for (std::uint32_t at = 0; at + 4 <= kSector; at += 4) {
        if (word(at) != kBegin) {
            continue;
        }
        std::uint32_t vectors = kFlashStart;
        bool executable = false;
        std::uint32_t item = at + 4;
        while ((word(item) & 0x7FU) != 0x7F && item < at + 640) {
            const std::uint32_t head = word(item);
            const std::uint32_t words =
                (head & 0x80U) != 0 ? head >> 8U & 0xFFFFU : head >> 8U & 0xFFU;
            executable = executable || ((head & 0xFFU) == 0x42 && head >> 16U == 0x1021);
            vectors = (head & 0xFFU) == 0x03 ? word(item + 4) : vectors;
            item += 4 * std::max(1U, words);
        }
        const std::uint32_t words = (item - at) / 4 - 1;
        const bool sized = (word(item) >> 8U & 0xFFFFU) == words;
        const bool closed = word(item + 8) == kEnd;
        if (!executable || !sized || !closed || word(item + 4) != 0) {
            throw std::runtime_error{"the boot ROM refuses the block at " +
                                     hexadecimal(kFlashStart + at)};
        }
        return vectors;
    }
    throw std::runtime_error{"no block that tells the boot ROM what the image is"};
}

void BootRom::reset()
{
    readable_ = true;
    connected_ = stale_ = false;
    busy_until_ = 0;
    show();
}

void BootRom::show()
{
    if (readable_) {
        view_ = flash_;
    } else {
        std::fill(view_.begin(), view_.end(), std::uint8_t{0xEE});
    }
}

std::uint32_t BootRom::look_up(std::uint32_t code, std::uint32_t mask) const
{
    for (unsigned function = 1; function < kFunctions; ++function) {
        const char* const name = kCodes[function];
        const std::uint32_t wanted =
            static_cast<std::uint32_t>(name[0]) | static_cast<std::uint32_t>(name[1]) << 8U;
        if (code == wanted && (mask & kForSecureCode) != 0) {
            return address_of(function);
        }
    }
    circuit_.violate("boot ROM: no function " + hexadecimal(code) + ", mask " + hexadecimal(mask));
    return 0;
}

std::uint32_t BootRom::call(unsigned function)
{
    switch (function) {
        case kLookUp:
            return look_up(arguments_[0], arguments_[1]);
        case kConnect:
            connected_ = true;
            break;
        case kExitXip:
            if (!connected_) {
                circuit_.violate("boot ROM: the flash is left before it is connected");
            }
            readable_ = false;
            show();
            break;
        case kErase:
            erase();
            break;
        case kProgram:
            program();
            break;
        case kFlush:
            stale_ = false;
            break;
        case kEnterXip:
            if (stale_) {
                circuit_.violate("boot ROM: the flash is read through a cache that is stale");
            }
            readable_ = true;
            show();
            break;
        case kReboot:
            wiring_.reboot();
            break;
        default:
            break;
    }
    return 0;
}

bool BootRom::may_write(std::uint32_t place, std::uint32_t size, std::uint32_t unit)
{
    if (readable_) {
        circuit_.violate("boot ROM: the flash is written while it is read");
    }
    if (place % unit != 0 || size % unit != 0 || size == 0 || place > flash_.size() ||
        size > flash_.size() - place) {
        circuit_.violate("boot ROM: " + std::to_string(size) + " bytes from " + hexadecimal(place) +
                         " can't be written");
        return false;
    }
    if (place < flash_.size() - 2 * kSector) {
        circuit_.violate("boot ROM: " + hexadecimal(place) + " is written, which is no settings'");
    }
    return true;
}

void BootRom::erase()
{
    const std::uint32_t place = arguments_[0];
    const std::uint32_t size = arguments_[1];
    if (!may_write(place, size, kSector)) {
        return;
    }
    stale_ = true;
    const auto begin = flash_.begin() + place;
    if (!wiring_.has_power_for_write()) {
        // Amid the erase: some bytes are erased, some bits of others.
        std::fill(begin, begin + size / 2, std::uint8_t{0xFF});
        for (std::uint32_t i = size / 2; i < size / 4 * 3; ++i) {
            flash_[place + i] |= 0x35;
        }
        return;
    }
    std::fill(begin, begin + size, std::uint8_t{0xFF});
    busy_until_ = circuit_.now + erase_time_ * static_cast<Picoseconds>(size / kSector);
    ++erases_;
}

void BootRom::program()
{
    constexpr std::uint32_t kPage = 256;
    const std::uint32_t place = arguments_[0];
    const std::uint32_t size = arguments_[2];
    const std::uint8_t* const from = wiring_.memory(arguments_[1], size);
    if (!may_write(place, size, kPage)) {
        return;
    }
    if (from == nullptr) {
        circuit_.violate("boot ROM: a page comes from " + hexadecimal(arguments_[1]));
        return;
    }
    stale_ = true;
    for (std::uint32_t i = 0; i < size; ++i) {
        std::uint8_t& byte = flash_[place + i];
        // Words of ones change nothing: it is as if they were not written.
        constexpr std::array<std::uint8_t, 4> kOnes{0xFF, 0xFF, 0xFF, 0xFF};
        const bool writes = i % 4 == 0 && !std::equal(kOnes.begin(), kOnes.end(), from + i);
        if (writes && !wiring_.has_power_for_write()) {
            byte &= from[i] | 0x35U;
            return;
        }
        if (byte != 0xFF && from[i] != 0xFF) {
            circuit_.violate("boot ROM: a byte is programmed twice");
        }
        byte &= from[i];
        words_ += writes ? 1 : 0;
    }
    busy_until_ = circuit_.now + word_time_ * static_cast<Picoseconds>(size / 4);
}

}  // namespace cusp::cosim::rp2350
