// Opening pseudo-terminals and sockets.
#include "hal/posix/endpoints.hpp"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <system_error>
#include <termios.h>
#include <unistd.h>

namespace cusp::hal {
namespace {

[[noreturn]] void fail(const std::string& what, int error = errno)
{
    throw std::system_error{error, std::generic_category(), what};
}

void make_raw(int descriptor, const std::string& name)
{
    termios settings{};
    if (::tcgetattr(descriptor, &settings) != 0) {
        fail(name);
    }
    ::cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL;
    ::tcsetattr(descriptor, TCSANOW, &settings);
}

std::shared_ptr<addrinfo> resolve(const TcpAddress& address, int flags)
{
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = flags;
    addrinfo* found = nullptr;
    const char* host = address.host.empty() ? nullptr : address.host.c_str();
    const int error = ::getaddrinfo(host, address.port.c_str(), &hints, &found);
    if (error != 0) {
        throw std::system_error{EINVAL, std::generic_category(),
                                address.host + ":" + address.port + ": " + ::gai_strerror(error)};
    }
    return {found, ::freeaddrinfo};
}

Descriptor new_socket(const addrinfo& place)
{
    return Descriptor{::socket(place.ai_family, place.ai_socktype | SOCK_CLOEXEC, 0)};
}

// Short lines and answers must not wait for each other.
void send_at_once(int socket)
{
    const int on = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

}  // namespace

PseudoTerminal::PseudoTerminal(const std::string& link)
    : master_{::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)}, link_{link}
{
    if (!master_.is_open() || ::grantpt(master_.number()) != 0 ||
        ::unlockpt(master_.number()) != 0) {
        fail("pseudo-terminal");
    }
    name_ = ::ptsname(master_.number());
    // Opened and closed once, the other end reads as hung up until a sender comes.
    const Descriptor other{::open(name_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)};
    if (!other.is_open()) {
        fail(name_);
    }
    make_raw(other.number(), name_);
    std::error_code failed;
    if (std::filesystem::is_symlink(link_, failed)) {
        std::filesystem::remove(link_, failed);
    }
    if (::symlink(name_.c_str(), link_.c_str()) != 0) {
        const int error = errno;
        const std::string place = link_;
        link_.clear();
        fail(place, error);
    }
}

PseudoTerminal::~PseudoTerminal()
{
    std::error_code failed;
    if (!link_.empty() && std::filesystem::read_symlink(link_, failed) == name_) {
        std::filesystem::remove(link_, failed);
    }
}

Descriptor PseudoTerminal::open_controller_end() const
{
    return Descriptor{::fcntl(master_.number(), F_DUPFD_CLOEXEC, 0)};
}

bool PseudoTerminal::has_peer() const noexcept
{
    pollfd state{master_.number(), 0, 0};
    return ::poll(&state, 1, 0) == 0 || (state.revents & POLLHUP) == 0;
}

std::optional<TcpAddress> parse_tcp_address(std::string_view text)
{
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos || colon + 1 == text.size()) {
        return std::nullopt;
    }
    std::string_view host = text.substr(0, colon);
    const std::string_view port = text.substr(colon + 1);
    if (port.size() > 5 || port.find_first_not_of("0123456789") != std::string_view::npos ||
        std::atoi(std::string{port}.c_str()) > 65535) {
        return std::nullopt;
    }
    if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
        host = host.substr(1, host.size() - 2);
    } else if (host.find(':') != std::string_view::npos) {
        return std::nullopt;
    }
    return TcpAddress{std::string{host}, std::string{port}};
}

TcpListener::TcpListener(const TcpAddress& address)
{
    const auto place = resolve(address, AI_PASSIVE);
    socket_ = new_socket(*place);
    const int on = 1;
    ::setsockopt(socket_.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (!socket_.is_open() || ::bind(socket_.number(), place->ai_addr, place->ai_addrlen) != 0 ||
        ::listen(socket_.number(), 1) != 0) {
        fail(address.host + ":" + address.port);
    }
    ::fcntl(socket_.number(), F_SETFL, O_NONBLOCK);
}

Descriptor TcpListener::accept_waiting() const
{
    Descriptor sender{::accept4(socket_.number(), nullptr, nullptr, SOCK_CLOEXEC)};
    if (sender.is_open()) {
        send_at_once(sender.number());
    }
    return sender;
}

std::uint16_t TcpListener::port() const
{
    sockaddr_storage storage{};
    socklen_t size = sizeof storage;
    // NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): how the sockets API is made.
    ::getsockname(socket_.number(), reinterpret_cast<sockaddr*>(&storage), &size);
    const in_port_t port = storage.ss_family == AF_INET6
                               ? reinterpret_cast<const sockaddr_in6*>(&storage)->sin6_port
                               : reinterpret_cast<const sockaddr_in*>(&storage)->sin_port;
    // NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
    return ntohs(port);
}

Descriptor connect_tcp(const TcpAddress& address)
{
    const auto places = resolve(address, 0);
    int error = ECONNREFUSED;
    for (const addrinfo* place = places.get(); place != nullptr; place = place->ai_next) {
        Descriptor socket = new_socket(*place);
        if (::connect(socket.number(), place->ai_addr, place->ai_addrlen) == 0) {
            send_at_once(socket.number());
            return socket;
        }
        error = errno;
    }
    fail(address.host + ":" + address.port, error);
}

namespace {

// A pseudo-terminal keeps TIOCEXCL after its close, as long as its other end is open: only root
// could open it a second time.
bool is_pseudo_terminal(int terminal)
{
    constexpr unsigned kFirstMajor = 136;
    constexpr unsigned kLastMajor = 143;
    struct stat status {};
    if (::fstat(terminal, &status) != 0) {
        return false;
    }
    const unsigned kind = major(status.st_rdev);
    return kind >= kFirstMajor && kind <= kLastMajor;
}

}  // namespace

Descriptor open_terminal(const std::string& name)
{
    Descriptor terminal{::open(name.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK)};
    if (!terminal.is_open()) {
        fail(name);
    }
    if (::flock(terminal.number(), LOCK_EX | LOCK_NB) != 0) {
        fail(name, EBUSY);
    }
    if (::isatty(terminal.number()) != 0) {
        make_raw(terminal.number(), name);
        if (!is_pseudo_terminal(terminal.number())) {
            ::ioctl(terminal.number(), TIOCEXCL);
        }
    }
    return terminal;
}

}  // namespace cusp::hal
