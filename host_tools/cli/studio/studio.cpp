// The server's life: it begins with an address and ends with the last page.
#include "host_tools/cli/studio/studio.hpp"

#include <chrono>
#include <thread>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cli/studio/loopback_server.hpp"
#include "host_tools/cli/studio/open_pages.hpp"
#include "host_tools/judge/view/page_text.hpp"

#include "fmt/format.h"

namespace cusp::studio {

using view::Page;
using view::page_text;

void serve(const StudioOptions& options)
{
    const std::string_view page = page_text(Page::kStudio);
    if (page.empty()) {
        throw InputError{"cusp studio: this build has no page"};
    }
    OpenPages pages;
    LoopbackServer server{page, options.version, options.call_command, pages};
    const int port = server.bind(options.port);
    if (port <= 0) {
        throw InputError{
            fmt::format("cusp studio: port {} of 127.0.0.1 can't be used", options.port)};
    }
    std::thread watch{[&] {
        pages.wait_for_the_last(std::chrono::duration<double>{options.linger});
        server.stop();
    }};
    if (options.ready) {
        options.ready(server.address());
    }
    server.listen();
    pages.end();
    watch.join();
}

}  // namespace cusp::studio
