// posix_spawn, with a file in memory as input and a pipe as output.
#include "host_tools/cli/studio/call_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cusp::studio {

namespace {

[[noreturn]] void refuse(const std::string& what, int error)
{
    throw std::runtime_error{what + ": " + std::strerror(error)};
}

// A file that is nowhere but in memory, at its start; a pipe would have to be filled while the answer is read.
int file_of(std::string_view bytes)
{
    const int file = memfd_create("call", MFD_CLOEXEC);
    while (file >= 0 && !bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written <= 0) {
            const int error = errno;
            close(file);
            refuse("a call's files can't be handed over", error);
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (file < 0) {
        refuse("a call's files can't be handed over", errno);
    }
    lseek(file, 0, SEEK_SET);
    return file;
}

}  // namespace

CallProcess::CallProcess(const std::vector<std::string>& command, std::string_view input)
{
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
        refuse("a call has no pipe", errno);
    }
    output_ = ends[0];
    const int file = file_of(input);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, file, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::vector<char*> arguments;
    for (const std::string& argument : command) {
        arguments.push_back(const_cast<char*>(argument.c_str()));
    }
    arguments.push_back(nullptr);
    const int error =
        posix_spawn(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(file);
    close(ends[1]);
    if (error != 0) {
        close(output_);
        refuse(command.front(), error);
    }
}

CallProcess::~CallProcess()
{
    if (process_ > 0) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    close(output_);
}

std::optional<std::string> CallProcess::read(int milliseconds)
{
    pollfd ready{output_, POLLIN, 0};
    if (poll(&ready, 1, milliseconds) <= 0) {
        return "";
    }
    constexpr std::size_t kPiece = 1U << 16U;
    std::string piece(kPiece, '\0');
    const ssize_t got = ::read(output_, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) {
        return "";
    }
    if (got <= 0) {
        return std::nullopt;
    }
    piece.resize(static_cast<std::size_t>(got));
    return piece;
}

std::string CallProcess::fault()
{
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    if (WIFSIGNALED(status)) {
        return "the call was ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
               strsignal(WTERMSIG(status)) + ")";
    }
    const int code = WEXITSTATUS(status);
    return code == 0 ? "" : "the call ended with status " + std::to_string(code);
}

}  // namespace cusp::studio
