// Reference CRC-32, bit by bit, and the bytes of an edge: the oracle of EdgeChecksum.
#pragma once

#include <cstdint>

namespace cusp::test {

class PlainCrc32 {
public:
    void add(std::uint8_t byte)
    {
        remainder_ ^= byte;
        for (int bit = 0; bit < 8; ++bit) {
            const bool odd = remainder_ % 2 == 1;
            remainder_ /= 2;
            remainder_ ^= odd ? 0xEDB88320U : 0U;
        }
    }

    //   wire  0 step_x, 1 dir_x, 2 step_y ... 5 dir_z
    void add_edge(std::uint64_t tick, unsigned wire, bool level)
    {
        for (unsigned byte = 0; byte < 8; ++byte) {
            add(static_cast<std::uint8_t>(tick >> (8 * byte) & 255U));
        }
        add(static_cast<std::uint8_t>(wire));
        add(level ? 1 : 0);
    }

    std::uint32_t value() const { return ~remainder_; }

private:
    std::uint32_t remainder_{0xFFFFFFFFU};
};

}  // namespace cusp::test
