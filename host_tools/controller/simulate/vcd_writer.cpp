// Text of the value change dump.
#include "host_tools/controller/simulate/vcd_writer.hpp"

#include <array>
#include <string_view>

#include "firmware/base/axis.hpp"

namespace cusp::simulate {
namespace {

// Order of declaration. Identifiers are '!' and up.
constexpr std::array<std::string_view, 10> kWires{"step_x", "dir_x", "step_y",  "dir_y",
                                                  "step_z", "dir_z", "spindle", "coolant",
                                                  "step_a", "dir_a"};
constexpr unsigned kSpindleWire = 6;
constexpr unsigned kCoolantWire = 7;

// The wire of a line of an axis: those of A come last.
constexpr unsigned declared(unsigned wire) { return wire < kSpindleWire ? wire : wire + 2; }

constexpr char identifier(unsigned wire) { return static_cast<char>('!' + wire); }

}  // namespace

VcdWriter::VcdWriter(const std::string& file,
                     const hal::SimulatedMill& mill,
                     std::uint64_t start,
                     PulseLines levels,
                     unsigned axes)
    : EdgeListener{start, levels, axes}, file_{file}, mill_{mill}
{
    file_.write("$version cusp sim $end\n$timescale 1 us $end\n$scope module mill $end\n");
    for (unsigned wire = 0; wire < 2 * axes + 2; ++wire) {
        file_.write("$var wire 1 ");
        file_.write(identifier(wire));
        file_.write(' ');
        file_.write(kWires[wire]);
        file_.write(" $end\n");
    }
    file_.write("$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n");
    for (unsigned axis = 0; axis < axes; ++axis) {
        write_level((levels & step_line(axis)) != 0, declared(2 * axis));
        write_level((levels & direction_line(axis)) != 0, declared(2 * axis + 1));
    }
    write_level(false, kSpindleWire);
    write_level(false, kCoolantWire);
    file_.write("$end\n");
}

void VcdWriter::edge(std::uint64_t tick, unsigned wire, bool level)
{
    write_time(tick);
    write_level(level, declared(wire));
}

void VcdWriter::close()
{
    write_time(end());
    file_.close();
}

void VcdWriter::write_time(std::uint64_t tick)
{
    if (tick == last_written_) {
        return;
    }
    last_written_ = tick;
    file_.write('#');
    file_.write_number(static_cast<std::int64_t>(tick));
    file_.write('\n');
}

void VcdWriter::write_level(bool level, unsigned wire)
{
    const std::array<char, 3> text{level ? '1' : '0', identifier(wire), '\n'};
    file_.write(std::string_view{text.data(), text.size()});
}

void VcdWriter::frame_begins(std::uint64_t tick)
{
    const hal::OutputLevels& outputs = mill_.outputs();
    const bool coolant = outputs.flood || outputs.mist;
    if (outputs.spindle_on != spindle_) {
        spindle_ = outputs.spindle_on;
        write_time(tick);
        write_level(spindle_, kSpindleWire);
    }
    if (coolant != coolant_) {
        coolant_ = coolant;
        write_time(tick);
        write_level(coolant_, kCoolantWire);
    }
}

}  // namespace cusp::simulate
