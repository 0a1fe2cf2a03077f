// Seven bits a character.
#include "host_tools/judge/view/byte_text.hpp"

namespace cusp::view {

std::string seven_bit_text(std::string_view bytes)
{
    std::string out;
    out.reserve(bytes.size() * 6 / 5 + 2);
    unsigned held = 0;
    unsigned bits = 0;
    const auto put = [&](unsigned value) {
        if (value == 0 || value == '\r' || value == '<') {
            out.push_back('\xc2');
            value |= 0x80U;
        }
        out.push_back(static_cast<char>(value));
    };
    for (const char byte : bytes) {
        held = held << 8U | static_cast<unsigned char>(byte);
        bits += 8;
        while (bits >= 7) {
            bits -= 7;
            put(held >> bits & 0x7fU);
        }
        held &= 0x7fU;
    }
    if (bits > 0) {
        put(held << (7 - bits) & 0x7fU);
    }
    return out;
}

}  // namespace cusp::view
