// The share that is done is one of time where the times are known, else one of lines.
#include "host_tools/controller/stream/terminal_watcher.hpp"

#include <utility>

#include "host_tools/controller/simulate/settings_file.hpp"

namespace cusp::stream {

TerminalWatcher::TerminalWatcher(std::string program, std::string settings_file, bool estimates)
    : program_{std::move(program)}, settings_file_{std::move(settings_file)}, estimates_{estimates}
{
}

void TerminalWatcher::ready(const ControllerFacts& facts)
{
    if (estimates_) {
        times_.emplace(program_, settings_file_.empty()
                                     ? facts.settings()
                                     : simulate::read_settings_file(settings_file_));
    }
    keyboard_.emplace();
    if (keyboard_->is_terminal()) {
        display_.say(Keyboard::legend());
    }
}

void TerminalWatcher::progress(const StreamProgress& progress)
{
    double fraction = progress.sent_fraction;
    std::optional<double> left;
    const std::uint64_t reported = progress.status.line.value_or(0);
    const std::uint64_t line = reported != 0 ? reported : progress.line;
    if (const auto times = times_ ? times_->at_line(line) : std::nullopt) {
        fraction = times->total_s > 0.0 ? times->done_s / times->total_s : fraction;
        left = (times->total_s - times->done_s) * 100.0 / progress.feed_override;
    }
    if (progress.done) {
        fraction = 1.0;
        left = 0.0;
    }
    display_.show(progress, fraction, left);
}

}  // namespace cusp::stream
