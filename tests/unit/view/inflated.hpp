// Inflates bytes, and reads little-endian numbers, as the page does.
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <zlib.h>

inline std::string inflated(std::string_view bytes)
{
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) {
        throw std::runtime_error{"no memory"};
    }
    std::string in{bytes};
    std::string out;
    std::string part(1U << 16U, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    int state = Z_OK;
    while (state == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(part.data());
        stream.avail_out = static_cast<uInt>(part.size());
        state = inflate(&stream, Z_NO_FLUSH);
        out.append(part.data(), part.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (state != Z_STREAM_END) {
        throw std::runtime_error{"no deflated bytes"};
    }
    return out;
}

class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : bytes_{bytes} {}

    std::uint64_t whole(unsigned count)
    {
        std::uint64_t value = 0;
        for (unsigned k = 0; k < count; ++k) {
            value |= std::uint64_t{static_cast<unsigned char>(bytes_[at_++])} << 8U * k;
        }
        return value;
    }
    double f64()
    {
        const std::uint64_t bits = whole(8);
        double value{};
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
    std::uint64_t varint()
    {
        std::uint64_t value = 0;
        for (unsigned shift = 0;; shift += 7) {
            const std::uint64_t byte = whole(1);
            value |= (byte & 0x7fU) << shift;
            if (byte < 0x80) {
                return value;
            }
        }
    }
    std::string_view take(std::size_t count)
    {
        at_ += count;
        return bytes_.substr(at_ - count, count);
    }
    bool done() const { return at_ == bytes_.size(); }

private:
    std::string_view bytes_;
    std::size_t at_{0};
};
