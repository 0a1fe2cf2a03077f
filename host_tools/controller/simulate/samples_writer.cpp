// Rows of the samples file.
#include "host_tools/controller/simulate/samples_writer.hpp"

#include "firmware/base/axis.hpp"
#include "firmware/base/panel.hpp"

namespace cusp::simulate {

SamplesWriter::SamplesWriter(const std::string& file, bool laser) : file_{file}, laser_{laser}
{
    file_.write(laser ? "t_us,x_nm,y_nm,z_nm,line,power_ppm\n" : "t_us,x_nm,y_nm,z_nm,line\n");
}

void SamplesWriter::write(std::uint64_t microseconds,
                          Position at,
                          std::uint32_t line,
                          std::uint16_t power)
{
    file_.write_number(static_cast<std::int64_t>(microseconds));
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        file_.write(',');
        file_.write_number(at[axis]);
    }
    file_.write(',');
    file_.write_number(line);
    if (laser_) {
        constexpr std::int64_t kMillionths = 1000000 / kFullDuty;
        file_.write(',');
        file_.write_number(power * kMillionths);
    }
    file_.write('\n');
}

}  // namespace cusp::simulate
