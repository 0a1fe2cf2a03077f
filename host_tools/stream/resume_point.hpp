// ResumePoint: where an interrupted program can be resumed, and the modal state there.
//
// The program is read from its start by the firmware's own interpreter, so that the modal state is
// that of the controller. Not every line can be the first: none inside a NURBS or a drilling cycle,
// none that relies on the G2 or G3 of an earlier line. The resume point is the last possible line
// before the one that was executing. What is cut twice is cut at the same place.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/gcode/modal_state.hpp"
#include "host_tools/stream/transfer_record.hpp"

namespace cusp::stream {

struct ResumePoint {
    std::uint64_t line{0};  // of the file, the first to be sent
    // Before that line:
    gcode::ModalState modal;
    gcode::Parameters parameters;
    Position position;             // machine
    std::int64_t highest_z_nm{0};  // that the tool was at since the program began, machine
    // Of the last feed move straight down, mm/min; none: there was none.
    std::optional<float> plunge_feed;
};

// Throws InputError where the state can't be known: a probe or a $ command that moves stands before
// the line; where the program is not the one of the record; or where it has no such line.
ResumePoint find_resume_point(const std::string& program, const TransferRecord& record);

}  // namespace cusp::stream
