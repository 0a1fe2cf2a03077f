// Ports by libserialport, and which of them is meant.
#include "host_tools/controller/stream/usb_ports.hpp"

#include <fmt/format.h>
#include <libserialport.h>

#include "host_tools/base/input_error/input_error.hpp"

namespace cusp::stream {
namespace {

std::string text_or_empty(const char* text) { return text != nullptr ? text : ""; }

std::string vendor_and_product(const UsbPort& port)
{
    return fmt::format("{:04x}:{:04x}", port.vendor, port.product);
}

bool is_meant(const UsbPort& port, const std::string& wanted)
{
    if (wanted.empty()) {
        return port.name.rfind("cusp ", 0) == 0;
    }
    return port.name.find(wanted) != std::string::npos || port.serial == wanted ||
           vendor_and_product(port) == wanted;
}

std::string list_of(const std::vector<UsbPort>& ports)
{
    std::string text;
    for (const UsbPort& port : ports) {
        text += fmt::format("{}{} ({}, {}, serial number {})", text.empty() ? "" : "; ",
                            port.device, port.name.empty() ? "no name" : port.name,
                            vendor_and_product(port), port.serial.empty() ? "none" : port.serial);
    }
    return text.empty() ? "none" : text;
}

}  // namespace

std::vector<UsbPort> list_usb_ports()
{
    sp_port** all = nullptr;
    if (sp_list_ports(&all) != SP_OK) {
        throw InputError{"usb: the system does not list its serial ports"};
    }
    std::vector<UsbPort> found;
    for (sp_port** next = all; *next != nullptr; ++next) {
        UsbPort port{text_or_empty(sp_get_port_name(*next)), 0, 0,
                     text_or_empty(sp_get_port_usb_product(*next)),
                     text_or_empty(sp_get_port_usb_serial(*next))};
        const bool usb = sp_get_port_transport(*next) == SP_TRANSPORT_USB;
        if (usb && sp_get_port_usb_vid_pid(*next, &port.vendor, &port.product) == SP_OK) {
            found.push_back(port);
        }
    }
    sp_free_port_list(all);
    return found;
}

std::string pick_usb_port(const std::vector<UsbPort>& ports, const std::string& wanted)
{
    std::vector<UsbPort> meant;
    for (const UsbPort& port : ports) {
        if (is_meant(port, wanted)) {
            meant.push_back(port);
        }
    }
    const std::string asked =
        wanted.empty() ? "a name that begins with \"cusp\"" : '"' + wanted + '"';
    if (meant.empty()) {
        throw InputError{fmt::format("usb:{}: no port on USB has {}; there are: {}", wanted, asked,
                                     list_of(ports))};
    }
    if (meant.size() > 1) {
        throw InputError{
            fmt::format("usb:{}: several ports on USB have {}: {}", wanted, asked, list_of(meant))};
    }
    return meant.front().device;
}

}  // namespace cusp::stream
