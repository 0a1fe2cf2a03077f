// Keys and their meaning.
#include "host_tools/controller/stream/keyboard.hpp"

#include <poll.h>
#include <unistd.h>

namespace cusp::stream {
namespace {

StreamKey meaning(char key)
{
    switch (key) {
        case 'h':
        case '!':
        case ' ':
            return StreamKey::kHold;
        case 'r':
        case '~':
            return StreamKey::kResume;
        case '+':
            return StreamKey::kFeedUpTen;
        case '-':
            return StreamKey::kFeedDownTen;
        case '>':
            return StreamKey::kFeedUpOne;
        case '<':
            return StreamKey::kFeedDownOne;
        case '=':
            return StreamKey::kFeedNormal;
        case 'q':
            return StreamKey::kAbort;
        default:
            return StreamKey::kNone;
    }
}

}  // namespace

Keyboard::Keyboard() : is_terminal_{::isatty(STDIN_FILENO) != 0}
{
    // A job in the background must not touch the terminal: that would stop it.
    if (is_terminal_ && ::tcgetpgrp(STDIN_FILENO) != ::getpgrp()) {
        is_terminal_ = false;
        ended_ = true;
    }
    if (!is_terminal_) {
        return;
    }
    ::tcgetattr(STDIN_FILENO, &before_);
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

Keyboard::~Keyboard()
{
    if (is_terminal_) {
        ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    }
}

StreamKey Keyboard::read()
{
    pollfd state{STDIN_FILENO, POLLIN, 0};
    if (ended_ || ::poll(&state, 1, 0) <= 0) {
        return StreamKey::kNone;
    }
    char key = 0;
    if (::read(STDIN_FILENO, &key, 1) <= 0) {
        ended_ = true;
        return StreamKey::kNone;
    }
    return meaning(key);
}

const char* Keyboard::legend()
{
    return "keys: h hold, r resume, + - feed by 10 %, > < by 1 %, = 100 %, q stop";
}

}  // namespace cusp::stream
