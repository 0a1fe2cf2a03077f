// EdgeChecksum: one number for all edges of a run, to compare the pulses of two machines.
#pragma once

#include "host_tools/program_run/edge_listener.hpp"

namespace cusp::program_run {

// CRC-32 (IEEE 802.3) of all edges in the order of the pulse trace. An edge is 10 bytes: its pulse tick
// in us as 8 bytes, little endian, its wire, and its level, 0 or 1.
class EdgeChecksum : public EdgeListener<EdgeChecksum> {
public:
    using EdgeListener::EdgeListener;

    std::uint32_t value() const { return ~remainder_; }

    void edge(std::uint64_t tick, unsigned wire, bool level);

private:
    std::uint32_t remainder_{0xFFFFFFFFU};
    // The remainder of the upper half of the tick, which changes every 71 minutes.
    std::uint32_t high_{0};
    std::uint32_t after_high_{0};
};

}  // namespace cusp::program_run
