// The server of the studio's page: 127.0.0.1 alone, and only for who knows its token. The one file pair that knows cpp-httplib.
//
// A request whose Host or Origin is another than the server's address is refused (403): no page of the web can ask
// through the browser, not even by a name that it lets point here. A request to /api/ without the token is refused (401).
// The token stands in the fragment of the address, which browsers do not send.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host_tools/cli/studio/open_pages.hpp"

namespace cusp::studio {

class LoopbackServer {
public:
    //   page          HTML
    //   call_command  as in StudioOptions
    //   pages         told of pages that open and close; outlives the server
    LoopbackServer(std::string_view page,
                   const std::string& version,
                   std::vector<std::string> call_command,
                   OpenPages& pages);
    ~LoopbackServer();

    // Takes the port, 0 for any. Returns the port, or -1 where it is taken.
    int bind(int port);
    // "http://127.0.0.1:PORT/#TOKEN", after bind().
    std::string address() const;
    // Serves until stop(), which any thread may call.
    void listen();
    void stop();

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace cusp::studio
