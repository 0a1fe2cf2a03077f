// TransferRecord: a file beside a program during its transfer, so that an interrupted transfer can
// be resumed, even by another process.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/gcode/modal_state.hpp"

namespace cusp::stream {

// State of the controller at the start of the program.
struct TransferStart {
    Position machine;
    std::string modal;  // words of `$G`
    gcode::Parameters parameters;
    unsigned axes{kLinearAxes};       // 4 with A
    float default_tolerance{0.010F};  // $11, mm
    bool touches_off{false};          // M6 measures the tool: $341=3
};

struct TransferRecord {
    TransferStart start;
    // Number in the file of a line that the tool has certainly reached: lines before it are done.
    std::uint64_t executed_line{0};
    Position last_seen;  // of the machine
    // Number of a line up to executed_line, and the CRC-32 of the text of all lines up to it: a
    // program changed after that line can still be resumed.
    std::uint64_t checked_line{0};
    std::uint32_t crc{0};
    std::string ending;  // why the transfer ended; empty while it runs
};

// File name of a program's record: the program's name with ".resume" appended.
std::string record_file(const std::string& program);

// Writes it completely or not at all. Returns false if the file cannot be written.
bool write_record(const std::string& program, const TransferRecord& record);

// None if there is no record. Errors: InputError if it cannot be read.
std::optional<TransferRecord> read_record(const std::string& program);

// Deletes the record after a complete transfer.
void drop_record(const std::string& program);

}  // namespace cusp::stream
