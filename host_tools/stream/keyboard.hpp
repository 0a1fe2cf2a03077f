// Keyboard: single keys from the terminal, without waiting for Return.
#pragma once

#include <termios.h>

#include "host_tools/stream/streamer.hpp"

namespace cusp::stream {

// Reads standard input. A terminal gives keys at once, and is put back as it was; a pipe or file
// gives its characters as keys as well.
class Keyboard {
public:
    Keyboard();
    Keyboard(const Keyboard&) = delete;
    Keyboard& operator=(const Keyboard&) = delete;
    ~Keyboard();

    // kNone where no known key was pressed.
    StreamKey read();

    bool is_terminal() const { return is_terminal_; }

    // What the keys do, for a person.
    static const char* legend();

private:
    termios before_{};
    bool is_terminal_{false};
    bool ended_{false};
};

}  // namespace cusp::stream
