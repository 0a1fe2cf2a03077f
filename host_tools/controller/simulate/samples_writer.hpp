// SamplesWriter: the set points as CSV, one row a servo tick.
#pragma once

#include <cstdint>
#include <string>

#include "firmware/base/vec.hpp"
#include "host_tools/base/files/files.hpp"

namespace cusp::simulate {

// Rows `t_us,x_nm,y_nm,z_nm,line`, with `a_udeg` before the line where there are four axes: the machine position at
// t_us on the clock of the pulse trace, and the line of the program that it executes; 0 before the first. In laser
// mode `,power_ppm` follows: the duty cycle of the laser in the millisecond that ends at t_us, in parts of a million.
class SamplesWriter {
public:
    // Errors: all members throw InputError if the file cannot be written.
    SamplesWriter(const std::string& file, bool laser, unsigned axes);

    // power: 0 to kFullDuty
    void write(std::uint64_t microseconds, Position at, std::uint32_t line, std::uint16_t power);
    void close() { file_.close(); }

private:
    files::TextFile file_;
    bool laser_;
    unsigned axes_;
};

}  // namespace cusp::simulate
