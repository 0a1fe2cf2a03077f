// TerminalWatcher: a transfer on a terminal, as a bar with the time left, and keys that steer it.
#pragma once

#include <optional>
#include <string>

#include "host_tools/controller/stream/keyboard.hpp"
#include "host_tools/controller/stream/progress_display.hpp"
#include "host_tools/controller/stream/streamer.hpp"
#include "host_tools/controller/stream/time_table.hpp"

namespace cusp::stream {

class TerminalWatcher : public StreamWatcher {
public:
    // program        file, whose times are reckoned when the controller is ready
    // settings_file  of the machine, for the time left; "": the controller's own
    // estimates      false: the time left is not shown
    TerminalWatcher(std::string program, std::string settings_file, bool estimates);

    void ready(const ControllerFacts& facts) override;
    void progress(const StreamProgress& progress) override;
    void notice(const std::string& text) override { display_.say(text); }
    StreamKey key() override { return keyboard_ ? keyboard_->read() : StreamKey::kNone; }

    // Ends the line of the bar.
    void finish() { display_.finish(); }

private:
    std::string program_;
    std::string settings_file_;
    bool estimates_;
    std::optional<Keyboard> keyboard_;
    ProgressDisplay display_{stdout};
    std::optional<TimeTable> times_;
};

}  // namespace cusp::stream
