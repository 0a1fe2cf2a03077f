// SamplesWriter: the set points as CSV, one row a servo tick.
#pragma once

#include <cstdint>
#include <string>

#include "firmware/base/vec.hpp"
#include "host_tools/base/files/files.hpp"

namespace cusp::simulate {

// Rows `t_us,x_nm,y_nm,z_nm,line`: the machine position at t_us on the clock of the pulse trace,
// and the line of the program that it executes; 0 before the first.
class SamplesWriter {
public:
    // Errors: all members throw InputError if the file cannot be written.
    explicit SamplesWriter(const std::string& file);

    void write(std::uint64_t microseconds, Position at, std::uint32_t line);
    void close() { file_.close(); }

private:
    files::TextFile file_;
};

}  // namespace cusp::simulate
