// Rows of the samples file.
#include "host_tools/controller/simulate/samples_writer.hpp"

#include "firmware/base/axis.hpp"

namespace cusp::simulate {

SamplesWriter::SamplesWriter(const std::string& file) : file_{file}
{
    file_.write("t_us,x_nm,y_nm,z_nm,line\n");
}

void SamplesWriter::write(std::uint64_t microseconds, Position at, std::uint32_t line)
{
    file_.write_number(static_cast<std::int64_t>(microseconds));
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        file_.write(',');
        file_.write_number(at[axis]);
    }
    file_.write(',');
    file_.write_number(line);
    file_.write('\n');
}

}  // namespace cusp::simulate
