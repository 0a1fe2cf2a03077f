// The machine that a job is cut on: limits that bound what is written for it. A file of its own has them.
//
//     const MachineTool mill = import::read_machine("mill.toml", folder_of_the_job);
//     if (const auto most = mill.most_feed(); most && feed > most->value) { most->place; }
#pragma once

#include <array>
#include <optional>
#include <string>

namespace cusp::job {

struct MachineLimit {
    double value;
    std::string place;  // for messages: "mill.toml:4: max_rate"
};

// Limits of x, y and z; no value: unknown.
using AxisValues = std::array<std::optional<MachineLimit>, 3>;

struct MachineTool {
    std::string file;  // "": the job names none, and there are no limits
    std::string name;
    AxisValues travel{};                          // mm
    AxisValues max_rate{};                        // mm/min
    AxisValues acceleration{};                    // mm/s^2
    std::optional<MachineLimit> least_spindle{};  // rpm
    std::optional<MachineLimit> most_spindle{};   // rpm
    std::string post{};                           // a name, or the path of a file; "": none

    // The feed that x and y both reach.
    std::optional<MachineLimit> most_feed() const;
    // Likewise of z.
    std::optional<MachineLimit> most_plunge_feed() const { return max_rate[2]; }
};

inline std::optional<MachineLimit> MachineTool::most_feed() const
{
    const auto& [x, y, z] = max_rate;
    return !x || (y && y->value < x->value) ? y : x;
}

}  // namespace cusp::job
