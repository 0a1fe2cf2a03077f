// TimeTable: start times of the lines of a program, from a simulation in parallel to the transfer.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "firmware/machine/settings.hpp"

namespace cusp::stream {

// Times are those of the firmware's own planner. Memory is bounded: of a long program only some
// lines are recorded.
class TimeTable {
public:
    // Starts at once, in its own thread; a program that cannot be simulated has no times.
    TimeTable(const std::string& program_file, const machine::Settings& settings);
    TimeTable(const TimeTable&) = delete;
    TimeTable& operator=(const TimeTable&) = delete;
    ~TimeTable();

    struct Times {
        double done_s;   // up to the line
        double total_s;  // of the program
    };
    // None until the whole program is simulated.
    std::optional<Times> at_line(std::uint64_t line) const;

private:
    void note(std::uint32_t line, double seconds);

    static constexpr std::size_t kMostNotes = 100'000;

    struct Note {
        std::uint32_t line;
        double seconds;
    };
    mutable std::mutex mutex_;
    std::vector<Note> notes_;
    std::uint64_t stride_{1};
    std::uint64_t skipped_{0};
    std::optional<double> total_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace cusp::stream
