// The parts that all blocks of the chip share.
#include "tests/target/cosim/model.hpp"

#include <algorithm>
#include <cstdio>

namespace cusp::cosim {

void Violations::add(Picoseconds now, const std::string& what)
{
    ++count_;
    if (std::find(kinds_.begin(), kinds_.end(), what) != kinds_.end()) {
        return;
    }
    kinds_.push_back(what);
    list_.push_back(std::to_string(now / kMicrosecond) + " us: " + what);
}

std::uint8_t* Circuit::dma_memory(std::uint32_t address, std::uint32_t size)
{
    for (MemoryArea& area : memories) {
        const bool inside = address >= area.start && address - area.start < area.bytes.size() &&
                            area.bytes.size() - (address - area.start) >= size;
        if (inside) {
            return area.dma ? &area.bytes[address - area.start] : nullptr;
        }
    }
    return nullptr;
}

std::string hexadecimal(std::uint32_t value)
{
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "0x%08x", value);
    return text.data();
}

}  // namespace cusp::cosim
