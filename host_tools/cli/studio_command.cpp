// cusp studio: the whole program as a page, from a server on this machine.
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <sys/prctl.h>

#include "host_tools/cli/cli.hpp"
#include "host_tools/cli/studio/call.hpp"
#include "host_tools/cli/studio/open_in_browser.hpp"
#include "host_tools/cli/studio/studio.hpp"
#include "host_tools/cli/version_text.hpp"

#include "CLI/CLI.hpp"
#include "fmt/format.h"

namespace cusp::cli {

namespace {

struct StudioArguments {
    int port{0};
    double linger{10.0};
    bool no_browser{false};
    std::string call;
};

// The process of one call: it ends with its server.
int run_call(const std::string& name)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    studio::answer_call(name, stdin, stdout);
    return kDone;
}

int run_studio(const StudioArguments& arguments)
{
    if (!arguments.call.empty()) {
        return run_call(arguments.call);
    }
    // a request that is closed while it is answered
    std::signal(SIGPIPE, SIG_IGN);
    studio::StudioOptions options;
    options.port = arguments.port;
    options.linger = arguments.linger;
    options.version = version_text().substr(0, version_text().find('\n'));
    options.call_command = {"/proc/self/exe", "studio", "--call"};
    options.ready = [&arguments](const std::string& address) {
        fmt::print("{}\nEnds when its last page is closed, or with Ctrl-C.\n", address);
        std::fflush(stdout);
        if (!arguments.no_browser) {
            studio::open_in_browser(address);
        }
    };
    studio::serve(options);
    return kDone;
}

}  // namespace

void add_studio_command(CLI::App& app, Work& work)
{
    CLI::App* command =
        app.add_subcommand("studio", "plan, check and run in a browser, from a part to G-code");
    command->footer(
        "Serves a page at 127.0.0.1, for this machine alone, and opens it in a browser. The page\n"
        "plans with all cores, and never moves a machine without a click.");
    auto arguments = std::make_shared<StudioArguments>();
    command->add_option("--port", arguments->port, "port of the page; 0: any that is free")
        ->check(CLI::Range(0, 65535));
    command
        ->add_option("--linger", arguments->linger,
                     "seconds that it waits after its last page has closed (10)")
        ->check(CLI::Range(0.0, 1e6));
    command->add_flag("--no-browser", arguments->no_browser, "print the address alone");
    command->add_option("--call", arguments->call, "answer one call of the page, from its input")
        ->group("");
    run_when_called(*command, work, arguments, run_studio);
}

}  // namespace cusp::cli
