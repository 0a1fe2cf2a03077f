// Bytes to text of seven bits and back.
#include "host_tools/judge/view/byte_text.hpp"

#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/unit/view/inflated.hpp"

using namespace cusp::view;

namespace {

// As the page does: the low seven bits of each character of UTF-8.
std::string bytes_of(const std::string& text)
{
    std::string out;
    unsigned held = 0;
    unsigned bits = 0;
    for (std::size_t k = 0; k < text.size(); ++k) {
        auto value = static_cast<unsigned char>(text[k]);
        if (value == 0xc2) {
            value = static_cast<unsigned char>(text[++k]);
        }
        held = (held << 7U | (value & 0x7fU)) & 0x3fffU;
        bits += 7;
        if (bits >= 8) {
            bits -= 8;
            out.push_back(static_cast<char>(held >> bits & 0xffU));
        }
    }
    return out;
}

std::string all_pairs()
{
    std::string out;
    for (unsigned a = 0; a < 256; ++a) {
        for (unsigned b = 0; b < 256; ++b) {
            out += {static_cast<char>(a), static_cast<char>(b)};
        }
    }
    return out;
}

}  // namespace

TEST_GROUP(ByteText){};

TEST(ByteText, ComesBackFromTextOfAnyBytes)
{
    const std::string bytes = all_pairs();
    CHECK(bytes_of(seven_bit_text(bytes)) == bytes);
    for (std::size_t size = 0; size < 20; ++size) {
        const std::string some = bytes.substr(1000, size);
        CHECK(bytes_of(seven_bit_text(some)) == some);
    }
}

TEST(ByteText, HoldsNothingThatHtmlReads)
{
    const std::string text = seven_bit_text(all_pairs());
    for (const char c : {'<', '\r', '\0'}) {
        CHECK(text.find(c) == std::string::npos);
    }
}

TEST(ByteText, IsASixthLongerThanItsBytes)
{
    const std::string bytes = all_pairs();
    CHECK(seven_bit_text(bytes).size() < bytes.size() * 118 / 100);
}

TEST(ByteText, ComesBackFromDeflate)
{
    const std::string bytes = all_pairs();
    CHECK(inflated(deflated(bytes)) == bytes);
    CHECK(inflated(deflated("")).empty());
}

TEST(ByteText, NumbersAreLittleEndianAndVarintsShort)
{
    Bytes bytes;
    bytes.put_u16(0x1234);
    bytes.put_u32(0xdeadbeef);
    bytes.put_f64(-0.1);
    bytes.put_varint(127);
    bytes.put_varint(128);
    bytes.put_varint(~std::uint64_t{0});
    ByteReader reader{bytes.text()};
    UNSIGNED_LONGS_EQUAL(0x1234, reader.whole(2));
    UNSIGNED_LONGS_EQUAL(0xdeadbeef, reader.whole(4));
    CHECK(reader.f64() == -0.1);
    UNSIGNED_LONGS_EQUAL(127, reader.varint());
    UNSIGNED_LONGS_EQUAL(128, reader.varint());
    CHECK(reader.varint() == ~std::uint64_t{0});
    CHECK(reader.done());
    UNSIGNED_LONGS_EQUAL(2 + 4 + 8 + 1 + 2 + 10, bytes.size());
    UNSIGNED_LONGS_EQUAL(3, zigzag(-2));
    UNSIGNED_LONGS_EQUAL(4, zigzag(2));
}
