// Simulates the program to estimate the remaining time.
#include "host_tools/controller/stream/time_table.hpp"

#include <algorithm>
#include <exception>

#include "host_tools/controller/simulate/simulate.hpp"

namespace cusp::stream {

using simulate::SimulationOptions;
using simulate::SimulationResult;

TimeTable::TimeTable(const std::string& program_file, const machine::Settings& settings)
{
    thread_ = std::thread{[this, program_file, settings] {
        SimulationOptions options;
        options.settings = settings;
        options.stop = [this] {
            return stop_.load();
        };
        options.line_started = [this](std::uint32_t line, double seconds) {
            note(line, seconds);
        };
        try {
            const SimulationResult result = simulate::simulate(program_file, options);
            const std::lock_guard lock{mutex_};
            if (result.good()) {
                total_ = result.total_s;
            }
        } catch (const std::exception&) {
            // Without times the bar shows the share of lines.
        }
    }};
}

TimeTable::~TimeTable()
{
    stop_ = true;
    thread_.join();
}

void TimeTable::note(std::uint32_t line, double seconds)
{
    if (++skipped_ < stride_) {
        return;
    }
    skipped_ = 0;
    const std::lock_guard lock{mutex_};
    notes_.push_back({line, seconds});
    if (notes_.size() == kMostNotes) {
        for (std::size_t i = 0; i < kMostNotes / 2; ++i) {
            notes_[i] = notes_[2 * i];
        }
        notes_.resize(kMostNotes / 2);
        stride_ *= 2;
    }
}

std::optional<TimeTable::Times> TimeTable::at_line(std::uint64_t line) const
{
    const std::lock_guard lock{mutex_};
    if (!total_) {
        return std::nullopt;
    }
    const auto after =
        std::upper_bound(notes_.begin(), notes_.end(), line,
                         [](std::uint64_t wanted, const Note& note) { return wanted < note.line; });
    return Times{after == notes_.begin() ? 0.0 : std::prev(after)->seconds, *total_};
}

}  // namespace cusp::stream
