// Reports: the status reports and the listings that the sender asks for.
#pragma once

#include <cstdint>

#include "firmware/machine/cycle_control.hpp"
#include "firmware/machine/machine_core.hpp"

namespace cusp::machine {

// Context: main loop.
class Reports {
public:
    // Both must outlive this; nothing is in the planner yet.
    Reports(MachineCore& core, const CycleControl& cycle) noexcept
        : core_{core}, cycle_{cycle}, planner_blocks_{core.motion.free_blocks()}
    {
    }

    // The answer to '?'.
    void write_status() noexcept;
    // True if a report is due by itself. $481: at the begin of each interval, at least 100 ms, as in grblHAL.
    bool due() const noexcept;

    // A listing begins.
    void begin(Listing listing) noexcept
    {
        listing_ = listing;
        listing_index_ = 0;
    }
    // Writes its next line. False, and nothing written, behind the last.
    bool write_line() noexcept;

private:
    MachineCore& core_;
    const CycleControl& cycle_;
    const std::uint32_t planner_blocks_;
    std::uint32_t reported_at_{0};  // tick
    Listing listing_{Listing::kSettings};
    unsigned listing_index_{0};
};

}  // namespace cusp::machine
