// The answer to '?': where the machine is and what it does.
#pragma once

#include <cstdint>

#include "firmware/base/vec.hpp"
#include "firmware/machine/accessories.hpp"
#include "firmware/machine/machine_state.hpp"
#include "firmware/machine/overrides.hpp"
#include "firmware/protocol/reply_queue.hpp"

namespace cusp::machine {

struct StatusFields {
    State state{State::kIdle};
    std::uint8_t substate{0};  // of Hold and Door
    Position position;         // machine
    Position work_offset;      // machine minus program coordinates
    std::uint32_t free_blocks{0};
    std::uint32_t free_bytes{0};
    std::uint32_t line{0};    // executing; 0: none to tell
    float feed{0};            // mm/min
    float spindle{0};         // rpm
    std::uint16_t inputs{0};  // on = 1
    Overrides overrides;
    Accessories accessories;
};

class StatusReporter {
public:
    // Longest report, bytes.
    static constexpr std::uint32_t kLongest = 220;

    // Writes one report, without line end. WCO comes with the first and Ov with the second after a change; then each
    // tenth report at rest, each thirtieth (Ov: twentieth) in motion.
    void write(const StatusFields& status,
               const Settings& settings,
               protocol::ReplyQueue& out) noexcept;

    void work_offset_changed() noexcept { until_work_offset_ = 0; }
    void overrides_changed() noexcept { until_overrides_ = 0; }

private:
    std::uint32_t until_work_offset_{0};
    std::uint32_t until_overrides_{0};
};

}  // namespace cusp::machine
