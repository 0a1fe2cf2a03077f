// Binary data in a page: little-endian numbers, deflated, and encoded as text that is valid in HTML.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace cusp::view {

class Bytes {
public:
    void put_u8(std::uint64_t value) { text_.push_back(static_cast<char>(value & 0xffU)); }
    void put_u16(std::uint64_t value) { put_low(value, 2); }
    void put_u32(std::uint64_t value) { put_low(value, 4); }
    void put_f64(double value)
    {
        std::uint64_t bits{};
        static_assert(sizeof bits == sizeof value);
        std::memcpy(&bits, &value, sizeof bits);
        put_low(bits, sizeof bits);
    }
    // Seven bits in each byte, the lowest first; the highest bit is set if more bytes follow.
    void put_varint(std::uint64_t value)
    {
        constexpr std::uint64_t kMore = 0x80;
        for (; value >= kMore; value >>= 7U) {
            put_u8(value | kMore);
        }
        put_u8(value);
    }
    void put(std::string_view bytes) { text_.append(bytes); }

    const std::string& text() const { return text_; }
    std::size_t size() const { return text_.size(); }

private:
    void put_low(std::uint64_t value, unsigned bytes)
    {
        for (unsigned k = 0; k < bytes; ++k) {
            put_u8(value >> 8U * k);
        }
    }
    std::string text_;
};

// Maps numbers of small magnitude to small numbers: 0, -1, 1, -2 ... to 0, 1, 2, 3 ...
constexpr std::uint64_t zigzag(std::int64_t value)
{
    const auto bits = static_cast<std::uint64_t>(value);
    return value < 0 ? ~(bits << 1U) : bits << 1U;
}

// Raw deflate (RFC 1951), for the browser's DecompressionStream. Throws std::runtime_error if zlib
// runs out of memory.
std::string deflated(std::string_view bytes);

// Seven bits in each UTF-8 character, the highest first; 17 % longer than the bytes (base64: 33 %).
// The three values that HTML changes or may parse as markup (NUL, CR, <) are encoded as the
// characters 128 above them: a reader uses the low seven bits of each character.
std::string seven_bit_text(std::string_view bytes);

}  // namespace cusp::view
