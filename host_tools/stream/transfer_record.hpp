// TransferRecord: a file beside a program while it is sent, so that an interrupted transfer can be
// resumed, also by another process.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/gcode/modal_state.hpp"

namespace cusp::stream {

// State of the controller when the program began.
struct TransferStart {
    Position machine;
    std::string modal;  // words of `$G`
    gcode::Parameters parameters;
    float default_tolerance{0.010F};  // $11, mm
    bool touches_off{false};          // M6 measures the tool: $341=3
};

struct TransferRecord {
    TransferStart start;
    // Number in the file of a line that the tool had certainly reached: lines before it are done.
    std::uint64_t executed_line{0};
    Position last_seen;  // of the machine
    // Number of a line up to executed_line, and the CRC-32 of the bare text of all lines up to it:
    // a program that was changed behind that line may still be resumed.
    std::uint64_t checked_line{0};
    std::uint32_t crc{0};
    std::string ending;  // why the transfer ended; empty while it runs
};

// Where the record of a program is kept: its name with ".resume" behind it.
std::string record_file(const std::string& program);

// Writes it whole or not at all. Returns false where the place can't be written.
bool write_record(const std::string& program, const TransferRecord& record);

// No value where there is no record. Throws InputError where it can't be read.
std::optional<TransferRecord> read_record(const std::string& program);

// The transfer went to its end.
void drop_record(const std::string& program);

}  // namespace cusp::stream
