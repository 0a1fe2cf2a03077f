// Compresses with zlib.
#include "host_tools/judge/view/byte_text.hpp"

#include <stdexcept>
#include <zlib.h>

namespace cusp::view {

std::string deflated(std::string_view bytes)
{
    constexpr int kLevel = 6;
    constexpr int kMemory = 9;
    z_stream stream{};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, -MAX_WBITS, kMemory, Z_DEFAULT_STRATEGY) !=
        Z_OK) {
        throw std::runtime_error{"no memory to compress the page"};
    }
    std::string out(deflateBound(&stream, bytes.size()), '\0');
    std::string in{bytes};
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    const int state = deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    if (state != Z_STREAM_END) {
        throw std::runtime_error{"the page could not be compressed"};
    }
    return out;
}

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
