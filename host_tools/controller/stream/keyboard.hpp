// Keyboard: single keys from the terminal, without waiting for Return.
#pragma once

#include <termios.h>

#include "host_tools/controller/stream/streamer.hpp"

namespace cusp::stream {

// Reads standard input. A terminal delivers keys at once, and its mode is restored at the end;
// characters of a pipe or file count as keys too.
class Keyboard {
public:
    Keyboard();
    Keyboard(const Keyboard&) = delete;
    Keyboard& operator=(const Keyboard&) = delete;
    ~Keyboard();

    // kNone if no known key was pressed.
    StreamKey read();

    bool is_terminal() const { return is_terminal_; }

    // Description of the keys.
    static const char* legend();

private:
    termios before_{};
    bool is_terminal_{false};
    bool ended_{false};
};

}  // namespace cusp::stream
