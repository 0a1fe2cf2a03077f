// By xdg-open, whose own words nobody needs.
#include "host_tools/cli/studio/open_in_browser.hpp"

#include <spawn.h>
#include <unistd.h>

namespace cusp::studio {

void open_in_browser(const std::string& address)
{
    std::string program = "xdg-open";
    std::string argument = address;
    char* const command[] = {program.data(), argument.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", 1, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", 1, 0);
    pid_t process{};
    posix_spawnp(&process, command[0], &actions, nullptr, command, environ);
    posix_spawn_file_actions_destroy(&actions);
}

}  // namespace cusp::studio
