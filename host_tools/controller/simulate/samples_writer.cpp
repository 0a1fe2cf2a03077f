// Rows of the samples file.
#include "host_tools/controller/simulate/samples_writer.hpp"

#include "firmware/base/axis.hpp"
#include "firmware/base/panel.hpp"

namespace cusp::simulate {

SamplesWriter::SamplesWriter(const std::string& file, bool laser, unsigned axes)
    : file_{file}, laser_{laser}, axes_{axes}
{
    file_.write("t_us,x_nm,y_nm,z_nm");
    file_.write(axes > kLinearAxes ? ",a_udeg,line" : ",line");
    file_.write(laser ? ",power_ppm\n" : "\n");
}

void SamplesWriter::write(std::uint64_t microseconds,
                          Position at,
                          std::uint32_t line,
                          std::uint16_t power)
{
    file_.write_number(static_cast<std::int64_t>(microseconds));
    for (unsigned axis = 0; axis < axes_; ++axis) {
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
