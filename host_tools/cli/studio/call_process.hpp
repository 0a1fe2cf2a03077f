// A process that reads bytes and writes an answer: ended when the object is.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

namespace cusp::studio {

class CallProcess {
public:
    //   command  program and arguments
    //   input    its standard input
    //
    // Errors: std::runtime_error where it can't be started.
    CallProcess(const std::vector<std::string>& command, std::string_view input);
    ~CallProcess();
    CallProcess(const CallProcess&) = delete;
    CallProcess& operator=(const CallProcess&) = delete;

    // The bytes that it has written since, waiting at most so many milliseconds; "": nothing yet. No value after its end.
    std::optional<std::string> read(int milliseconds);

    // After its end: "" where it ended well, else how it ended.
    std::string fault();

private:
    pid_t process_{-1};
    int output_{-1};
};

}  // namespace cusp::studio
