// `cusp settings`: prints the default settings.
#include <cstdio>
#include <string>

#include "host_tools/cli/cli.hpp"
#include "host_tools/controller/simulate/settings_file.hpp"

namespace cusp::cli {

void add_settings_command(CLI::App& app, Work& work)
{
    CLI::App* command = app.add_subcommand("settings", "print the default settings");
    command->footer(
        "In the format of `$$`. Redirect the lines to a file, edit it, and pass it to\n"
        "`cusp sim --settings FILE`.");
    command->callback([&work] {
        work = [] {
            const std::string text = simulate::settings_text(machine::Settings{});
            std::fputs(text.c_str(), stdout);
            return static_cast<int>(kDone);
        };
    });
}

}  // namespace cusp::cli
