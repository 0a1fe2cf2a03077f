// VcdWriter: the pulse trace as a value change dump (IEEE 1364), timescale 1 us.
#pragma once

#include <cstdint>
#include <string>

#include "hal/sim/simulated_mill.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/controller/program_run/edge_listener.hpp"

namespace cusp::simulate {

// Wires step_x dir_x step_y dir_y step_z dir_z (logical levels: a step is a rising edge, dir 1 is
// plus), spindle and coolant; step_a and dir_a where there are four `axes`. Spindle and coolant change at
// the start of a servo tick.
class VcdWriter : public program_run::EdgeListener<VcdWriter> {
public:
    // Records the outputs of `mill`, which must outlive it. Throws InputError.
    //
    // start   pulse tick of virtual time that is 0 in the dump
    // levels  of the lines at that time
    VcdWriter(const std::string& file,
              const hal::SimulatedMill& mill,
              std::uint64_t start,
              PulseLines levels,
              unsigned axes);

    // Ends the dump with the time at the end of the last frame.
    void close();

    // Spindle and coolant.
    void frame_begins(std::uint64_t tick);
    void edge(std::uint64_t tick, unsigned wire, bool level);

private:
    void write_time(std::uint64_t tick);
    void write_level(bool level, unsigned wire);

    files::TextFile file_;
    const hal::SimulatedMill& mill_;
    bool spindle_{false};
    bool coolant_{false};
    std::uint64_t last_written_{0};
};

}  // namespace cusp::simulate
