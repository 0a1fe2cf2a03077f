// Routes and checks of the studio's server.
#include "host_tools/cli/studio/loopback_server.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <httplib.h>
#include <stdexcept>
#include <sys/random.h>
#include <thread>

#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/cli/studio/call.hpp"
#include "host_tools/cli/studio/call_process.hpp"

#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::studio {

using httplib::DataSink;
using httplib::Request;
using httplib::Response;
using Handled = httplib::Server::HandlerResponse;

namespace {

constexpr int kForbidden = 403;
constexpr int kNoToken = 401;
constexpr std::size_t kLargestRequest = std::size_t{1} << 30U;  // bytes
// Pages and calls that are served at once: each holds a thread, nearly always asleep.
constexpr std::size_t kThreads = 32;
constexpr const char* kLines = "application/x-ndjson";

// 128 random bits, hexadecimal.
std::string new_token()
{
    std::array<std::uint8_t, 16> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
        throw std::runtime_error{"cusp studio: the system gives no random bytes for a token"};
    }
    std::string token;
    for (const std::uint8_t byte : bytes) {
        token += fmt::format("{:02x}", byte);
    }
    return token;
}

// In a time that does not tell how much is right.
bool equal(const std::string& a, const std::string& b)
{
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
        difference |= static_cast<unsigned>(static_cast<unsigned char>(a[k]) ^
                                            static_cast<unsigned char>(b[k]));
    }
    return difference == 0;
}

}  // namespace

class LoopbackServer::Implementation {
public:
    Implementation(std::string_view page,
                   const std::string& version,
                   std::vector<std::string> call_command,
                   OpenPages& pages)
        : page_{page}, version_{version}, call_command_{std::move(call_command)}, pages_{pages}
    {
        server_.new_task_queue = [] {
            return new httplib::ThreadPool(kThreads);
        };
        // cpp-httplib's own options would let another program listen at the same port
        server_.set_socket_options([](socket_t) {});
        server_.set_payload_max_length(kLargestRequest);
        server_.set_default_headers({{"Cross-Origin-Opener-Policy", "same-origin"},
                                     {"Cross-Origin-Embedder-Policy", "require-corp"},
                                     {"Cross-Origin-Resource-Policy", "same-origin"},
                                     {"Content-Security-Policy", "frame-ancestors 'none'"},
                                     {"Referrer-Policy", "no-referrer"},
                                     {"X-Content-Type-Options", "nosniff"},
                                     {"Cache-Control", "no-store"}});
        server_.set_pre_routing_handler(
            [this](const Request& request, Response& answer) { return admit(request, answer); });
        add_routes();
    }

    int bind(int port)
    {
        const bool any = port == 0;
        port_ = any ? server_.bind_to_any_port("127.0.0.1")
                    : (server_.bind_to_port("127.0.0.1", port) ? port : -1);
        return port_;
    }
    std::string address() const { return "http://" + host() + "/#" + token_; }
    void listen() { server_.listen_after_bind(); }
    void stop() { server_.stop(); }

private:
    std::string host() const { return fmt::format("127.0.0.1:{}", port_); }

    Handled admit(const Request& request, Response& answer) const
    {
        const bool own_host = request.get_header_value_count("Host") == 1 &&
                              request.get_header_value("Host") == host();
        const bool own_origin = !request.has_header("Origin") ||
                                request.get_header_value("Origin") == "http://" + host();
        if (!own_host || !own_origin) {
            return refuse(answer, kForbidden, "this server answers its own page alone\n");
        }
        if (request.path != "/" && request.path != "/favicon.ico" &&
            !equal(request.get_header_value("X-Cusp-Token"), token_)) {
            return refuse(answer, kNoToken, "the token is missing or wrong\n");
        }
        return Handled::Unhandled;
    }

    static Handled refuse(Response& answer, int status, const char* why)
    {
        answer.status = status;
        answer.set_content(why, "text/plain");
        return Handled::Handled;
    }

    void add_routes()
    {
        server_.Get("/", [this](const Request&, Response& answer) {
            answer.set_content(page_.data(), page_.size(), "text/html; charset=utf-8");
        });
        server_.Get("/favicon.ico", [](const Request&, Response& answer) {
            constexpr int kNothing = 204;
            answer.status = kNothing;
        });
        server_.Get("/api/facts", [this](const Request&, Response& answer) {
            const nlohmann::ordered_json facts{{"kind", "native"},
                                               {"threads", std::thread::hardware_concurrency()},
                                               {"version", version_}};
            answer.set_content(json_text::written(facts), "application/json");
        });
        server_.Get("/api/open", [this](const Request&, Response& answer) { follow_page(answer); });
        server_.Post(R"(/api/call/([a-z_]{1,40}))",
                     [this](const Request& request, Response& answer) { call(request, answer); });
    }

    // A request that lasts as long as its page.
    void follow_page(Response& answer)
    {
        pages_.opened();
        answer.set_chunked_content_provider(
            kLines,
            [](std::size_t, DataSink& sink) {
                constexpr std::chrono::milliseconds kBeat{250};
                std::this_thread::sleep_for(kBeat);
                return sink.is_writable() && sink.write("\n", 1);
            },
            [this](bool) { pages_.closed(); });
    }

    void call(const Request& request, Response& answer)
    {
        std::vector<std::string> command = call_command_;
        command.push_back(request.matches[1]);
        std::shared_ptr<CallProcess> process;
        try {
            process = std::make_shared<CallProcess>(command, request.body);
        } catch (const std::exception& fault) {
            answer.set_content(failure_bytes(fault.what()), kLines);
            return;
        }
        answer.set_chunked_content_provider(kLines, [process](std::size_t, DataSink& sink) {
            constexpr int kWait = 100;  // ms: how soon a closed request ends the call
            const std::optional<std::string> piece = process->read(kWait);
            if (!sink.is_writable()) {
                return false;
            }
            if (piece) {
                return piece->empty() || sink.write(piece->data(), piece->size());
            }
            if (const std::string why = process->fault(); !why.empty()) {
                const std::string line = failure_bytes(why);
                sink.write(line.data(), line.size());
            }
            sink.done();
            return true;
        });
    }

    std::string_view page_;
    std::string version_;
    std::vector<std::string> call_command_;
    OpenPages& pages_;
    std::string token_{new_token()};
    int port_{-1};
    httplib::Server server_;
};

LoopbackServer::LoopbackServer(std::string_view page,
                               const std::string& version,
                               std::vector<std::string> call_command,
                               OpenPages& pages)
    : implementation_{
          std::make_unique<Implementation>(page, version, std::move(call_command), pages)}
{
}

LoopbackServer::~LoopbackServer() = default;

int LoopbackServer::bind(int port) { return implementation_->bind(port); }
std::string LoopbackServer::address() const { return implementation_->address(); }
void LoopbackServer::listen() { implementation_->listen(); }
void LoopbackServer::stop() { implementation_->stop(); }

}  // namespace cusp::studio
