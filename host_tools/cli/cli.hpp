// The commands of `cusp`. Each adds a subcommand whose callback sets the work to do.
//
//     CLI::App app{"cusp"};
//     Work work;
//     add_plan_command(app, work);
//     app.parse(argc, argv);  // the command that was called sets `work`
//     return work();
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "host_tools/base/files/files.hpp"

#include "CLI/App.hpp"

namespace cusp::cli {

// Exit statuses, the same for every command.
enum ExitStatus : int {
    kDone = 0,
    kFoundWrong = 1,  // the result is bad: a limit exceeded, an alarm, a gouge
    kCannotUse = 2,   // the input or the command line is invalid
};

// Runs the selected command. Returns the exit status; throws InputError (status 2).
using Work = std::function<int()>;

// Sets `work` to run(*options) where `command` is the one that is called.
template <class Options, class Run>
void run_when_called(CLI::App& command, Work& work, std::shared_ptr<Options> options, Run run)
{
    command.callback([&work, options, run] {
        work = [options, run] {
            return run(*options);
        };
    });
}

// Writes what `text_of` gives; nothing without the name of a file.
template <class TextOf>
void write_wanted(const std::string& file, const TextOf& text_of)
{
    if (!file.empty()) {
        files::write_text(file, text_of());
    }
}

// Adds one subcommand to `app`; its callback sets `work`. A new command is one file
// <name>_command.cpp with such a function, one line here and one in main.cpp.
using AddCommand = void (*)(CLI::App& app, Work& work);

void add_demo_command(CLI::App& app, Work& work);
void add_fit_command(CLI::App& app, Work& work);
void add_info_command(CLI::App& app, Work& work);
void add_plan_command(CLI::App& app, Work& work);
void add_view_command(CLI::App& app, Work& work);
void add_verify_command(CLI::App& app, Work& work);
void add_sim_command(CLI::App& app, Work& work);
void add_stream_command(CLI::App& app, Work& work);
void add_studio_command(CLI::App& app, Work& work);
void add_settings_command(CLI::App& app, Work& work);

}  // namespace cusp::cli
