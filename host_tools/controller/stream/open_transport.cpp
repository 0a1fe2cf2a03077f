// Selects the transport by the name of the port.
#include <filesystem>
#include <system_error>

#include "hal/posix/endpoints.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/stream/descriptor_transport.hpp"
#include "host_tools/controller/stream/serial_transport.hpp"
#include "host_tools/controller/stream/transport.hpp"
#include "host_tools/controller/stream/usb_ports.hpp"

namespace cusp::stream {
namespace {

constexpr std::string_view kTcp = "tcp:";
constexpr std::string_view kUsb = "usb:";

bool is_pseudo_terminal(const std::string& port)
{
    std::error_code failed;
    const auto place = std::filesystem::canonical(port, failed);
    return !failed && place.string().rfind("/dev/pts/", 0) == 0;
}

hal::Descriptor open_tcp(const std::string& port)
{
    const auto address = hal::parse_tcp_address(port.substr(kTcp.size()));
    if (!address) {
        throw InputError{port + ": is not tcp:HOST:PORT with a port of 1 to 65535"};
    }
    return hal::connect_tcp(*address);
}

}  // namespace

std::unique_ptr<Transport> open_transport(const std::string& port, int baud)
{
    try {
        if (port.rfind(kTcp, 0) == 0) {
            return std::make_unique<DescriptorTransport>(open_tcp(port));
        }
        if (port.rfind(kUsb, 0) == 0) {
            return std::make_unique<SerialTransport>(
                pick_usb_port(list_usb_ports(), port.substr(kUsb.size())), baud);
        }
        std::error_code failed;
        if (!std::filesystem::exists(port, failed)) {
            throw InputError{port + ": no such port"};
        }
        if (is_pseudo_terminal(port)) {
            return std::make_unique<DescriptorTransport>(hal::open_terminal(port));
        }
        return std::make_unique<SerialTransport>(port, baud);
    } catch (const std::system_error& error) {
        if (error.code() == std::errc::device_or_resource_busy) {
            throw InputError{port + ": another program uses it"};
        }
        throw InputError{"can't open " + std::string{error.what()}};
    }
}

}  // namespace cusp::stream
