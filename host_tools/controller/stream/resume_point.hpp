// ResumePoint: where an interrupted program can be resumed, and the modal state there.
//
// The program is interpreted from its start by the firmware's own interpreter, so that the modal
// state is that of the controller. A line inside a NURBS or a drilling cycle cannot be the first,
// nor one that relies on the G2 or G3 of an earlier line. The resume point is the last possible
// line before the one that was executing. Anything cut twice is cut at the same place.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/gcode/modal_state.hpp"
#include "host_tools/controller/stream/transfer_record.hpp"

namespace cusp::stream {

struct ResumePoint {
    std::uint64_t line{0};  // of the file, the first to be sent
    // Before that line:
    gcode::ModalState modal;
    gcode::Parameters parameters;
    unsigned axes{kLinearAxes};    // 4 with A
    Position position;             // machine
    std::int64_t highest_z_nm{0};  // the tool's highest since the start of the program, machine
    // Feed of the last feed move straight down, mm/min; none if there was none.
    std::optional<float> plunge_feed;
};

// Errors: InputError if the state is unknown (a probe or a moving $ command precedes the line), if
// the program is not that of the record, or if it has no such line.
ResumePoint find_resume_point(const std::string& program, const TransferRecord& record);

}  // namespace cusp::stream
