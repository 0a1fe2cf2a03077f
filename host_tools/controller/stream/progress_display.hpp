// ProgressDisplay: progress of a transfer, as a bar on a terminal and as plain lines elsewhere.
#pragma once

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>

#include "host_tools/controller/stream/streamer.hpp"

namespace cusp::stream {

// "0:07", "12:34", "1:02:03".
std::string clock_text(double seconds);

// One line of at most `width` columns: bar, percent, line, time left, state, position, feed.
std::string progress_line(const StreamProgress& progress,
                          double fraction,
                          std::optional<double> seconds_left,
                          unsigned width);

class ProgressDisplay {
public:
    explicit ProgressDisplay(std::FILE* out);

    // fraction      of the program's time if known, else of its lines; 0 to 1
    // seconds_left  if known
    void show(const StreamProgress& progress, double fraction, std::optional<double> seconds_left);

    // Prints a line above the bar.
    void say(const std::string& text);

    // Ends the line of the bar, so that its last state stays visible.
    void finish();

private:
    std::FILE* out_;
    bool is_terminal_;
    std::string shown_;
    std::chrono::steady_clock::time_point last_plain_;
    double last_plain_fraction_{-1.0};
};

}  // namespace cusp::stream
