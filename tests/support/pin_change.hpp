// A change of the levels of a chip's pins, as its model notes it.
#pragma once

#include <cstdint>

namespace cusp::test {

struct PinChange {
    std::uint64_t microsecond;
    std::uint32_t levels;
    friend bool operator==(const PinChange& a, const PinChange& b)
    {
        return a.microsecond == b.microsecond && a.levels == b.levels;
    }
};

}  // namespace cusp::test
