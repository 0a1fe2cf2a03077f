// Stores the first line of each tool; each tick names the line that is executed.
#include "host_tools/controller/program_run/tool_times.hpp"

#include <algorithm>

namespace cusp::program_run {

void ToolTimes::read_line(std::uint64_t line, int tool)
{
    if (tool == named_) {
        return;
    }
    if (named_ == 0) {
        times_.front().number = tool;
    } else {
        starts_.push_back({line, place_of(tool)});
        ++changes_;
    }
    named_ = tool;
}

void ToolTimes::add_tick(std::uint32_t executing_line)
{
    while (current_ + 1 < starts_.size() && executing_line >= starts_[current_ + 1].line) {
        ++current_;
    }
    ++times_[starts_[current_].tool].ticks;
}

std::size_t ToolTimes::place_of(int tool)
{
    const auto found = std::find_if(times_.begin(), times_.end(),
                                    [&](const ToolTime& time) { return time.number == tool; });
    if (found == times_.end()) {
        times_.push_back({tool, 0});
        return times_.size() - 1;
    }
    return static_cast<std::size_t>(found - times_.begin());
}

}  // namespace cusp::program_run
