// EdgeChecksum: one number for all edges of a run, by which two machines compare their pulses.
#pragma once

#include "host_tools/program_run/edge_listener.hpp"

namespace cusp::program_run {

// CRC-32 (IEEE 802.3) of all edges in the order of the pulse trace. An edge is 10 bytes: its pulse tick
// in us as 8 bytes, little endian, its wire, and its level, 0 or 1.
class EdgeChecksum : public EdgeListener {
public:
    using EdgeListener::EdgeListener;

    std::uint32_t value() const { return ~remainder_; }

protected:
    void edge(std::uint64_t tick, unsigned wire, bool level) override;

private:
    std::uint32_t remainder_{0xFFFFFFFFU};
};

}  // namespace cusp::program_run
