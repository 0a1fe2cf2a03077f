// Listings: the answers of several lines to `$$`, `$#`, `$N`, `$I` and `$E`, one line at a time.
#pragma once

#include <cstdint>

#include "firmware/gcode/interpreter.hpp"
#include "firmware/machine/accessories.hpp"
#include "firmware/machine/stored_state.hpp"
#include "firmware/protocol/reply_queue.hpp"

namespace cusp::machine {

enum class Listing : std::uint8_t {
    kSettings,
    kParameters,
    kStartupLines,
    kBuild,
    kSettingDescriptions,
    kSettingGroups,
    kErrorCodes,
    kAlarmCodes,
};

// The last probe, for `$#` and `[PRB:...]`.
struct ProbeResult {
    Position at;
    bool found{false};
};

struct ListingSource {
    const StoredState& stored;
    const gcode::Parameters& parameters;
    ProbeResult probe;
    std::uint32_t planner_blocks{0};
    std::uint32_t receive_bytes{0};
    std::uint32_t glitches{0};
};

// Writes line `index` of the listing: nothing for a tool that was not entered. Returns false, and
// writes nothing, behind the last.
bool write_listing_line(Listing listing,
                        unsigned index,
                        const ListingSource& source,
                        protocol::ReplyQueue& out) noexcept;

void write_probe(const ProbeResult& probe,
                 protocol::PlaceForm form,
                 protocol::ReplyQueue& out) noexcept;

// `$G`: [GC:G0 G54 ...].
void write_modal_state(const gcode::ModalState& modal,
                       const Settings& settings,
                       protocol::ReplyQueue& out) noexcept;

}  // namespace cusp::machine
