// SamplesWriter: the set points as CSV, one row a servo tick.
#pragma once

#include <cstdint>
#include <string>

#include "firmware/base/vec.hpp"
#include "host_tools/files/files.hpp"

namespace cusp::simulate {

// Rows `t_us,x_nm,y_nm,z_nm`: where the machine is at t_us on the clock of the pulse trace.
class SamplesWriter {
public:
    // Throws InputError, as the rest.
    explicit SamplesWriter(const std::string& file);

    void write(std::uint64_t microseconds, Position at);
    void close() { file_.close(); }

private:
    files::TextFile file_;
};

}  // namespace cusp::simulate
