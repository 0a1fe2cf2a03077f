// Text of the bar.
#include "host_tools/controller/stream/progress_display.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace cusp::stream {

using dialect::ControllerStatus;

namespace {

constexpr std::chrono::seconds kPlainInterval{10};

unsigned columns(std::FILE* out)
{
    winsize size{};
    if (::ioctl(::fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
        return size.ws_col;
    }
    return 80;
}

Vec3d position_of(const StreamProgress& progress)
{
    const ControllerStatus& status = progress.status;
    if (status.work_position) {
        return xyz(*status.work_position);
    }
    return xyz(status.machine_position.value_or(AxisVecd{}) - progress.work_offset);
}

std::string bar(double fraction, unsigned cells)
{
    const auto filled = static_cast<unsigned>(std::clamp(fraction, 0.0, 1.0) * cells);
    return "[" + std::string(filled, '#') + std::string(cells - filled, '.') + "]";
}

std::string facts_of(const StreamProgress& progress,
                     double fraction,
                     std::optional<double> seconds_left)
{
    const Vec3d at = position_of(progress);
    const ControllerStatus& status = progress.status;
    return fmt::format("{:5.1f} %  line {}  {} left  {}  X{:.3f} Y{:.3f} Z{:.3f}  F{:.0f} {} %",
                       100.0 * std::clamp(fraction, 0.0, 1.0),
                       status.line.value_or(static_cast<std::uint32_t>(progress.line)),
                       seconds_left ? clock_text(*seconds_left) : "?",
                       status.state.empty() ? "-" : status.state, at.x, at.y, at.z,
                       status.feed.value_or(0.0), progress.feed_override);
}

}  // namespace

std::string clock_text(double seconds)
{
    const auto whole = static_cast<long>(std::max(0.0, std::round(seconds)));
    if (whole >= 3600) {
        return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    }
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string progress_line(const StreamProgress& progress,
                          double fraction,
                          std::optional<double> seconds_left,
                          unsigned width)
{
    const std::string facts = facts_of(progress, fraction, seconds_left);
    constexpr unsigned kLeastBar = 12;
    if (facts.size() + kLeastBar + 1 > width) {
        return facts.substr(0, width);
    }
    const unsigned cells = std::min(40U, width - static_cast<unsigned>(facts.size()) - 3U);
    return bar(fraction, cells) + " " + facts;
}

ProgressDisplay::ProgressDisplay(std::FILE* out)
    : out_{out}, is_terminal_{::isatty(::fileno(out)) != 0}
{
}

void ProgressDisplay::show(const StreamProgress& progress,
                           double fraction,
                           std::optional<double> seconds_left)
{
    if (is_terminal_) {
        const std::string line = progress_line(progress, fraction, seconds_left, columns(out_) - 1);
        if (line != shown_) {
            shown_ = line;
            fmt::print(out_, "\r\x1b[K{}", line);
            std::fflush(out_);
        }
        return;
    }
    const auto now = std::chrono::steady_clock::now();
    if (last_plain_fraction_ >= 0.0 && now - last_plain_ < kPlainInterval) {
        return;
    }
    last_plain_ = now;
    last_plain_fraction_ = fraction;
    fmt::print(out_, "{}\n", facts_of(progress, fraction, seconds_left));
    std::fflush(out_);
}

void ProgressDisplay::say(const std::string& text)
{
    if (is_terminal_ && !shown_.empty()) {
        fmt::print(out_, "\r\x1b[K{}\n{}", text, shown_);
    } else {
        fmt::print(out_, "{}\n", text);
    }
    std::fflush(out_);
}

void ProgressDisplay::finish()
{
    if (is_terminal_ && !shown_.empty()) {
        fmt::print(out_, "\n");
        shown_.clear();
    }
    std::fflush(out_);
}

}  // namespace cusp::stream
