// `cusp studio`: the page of the studio from a server that this machine alone reaches, and the planners
// behind it. The front door of `studio`.
//
//     StudioOptions options;
//     options.call_command = {"/usr/bin/cusp", "studio", "--call"};
//     options.ready = [](const std::string& address) { open_in_browser(address); };
//     serve(options);                               // until its last page is closed
//
// The page asks by POST /api/call/NAME (call.hpp has the format). Each call is a process of its own: closing the
// request ends it, and a call that runs out of memory takes nothing else along.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace cusp::studio {

struct StudioOptions {
    int port{0};  // 0: any that is free
    // s: how long the server waits for a page after the last one has closed.
    double linger{10.0};
    std::string version;  // for the page
    // The name of the call is appended; the process answers as answer_call() does.
    std::vector<std::string> call_command;
    // Receives the address with its token, once the server takes requests.
    std::function<void(const std::string& address)> ready;
};

// Serves the page at 127.0.0.1 until the last page has closed. A page that never comes is waited for.
//
// Errors: InputError where the port is taken, and where this build has no page.
void serve(const StudioOptions& options);

}  // namespace cusp::studio
