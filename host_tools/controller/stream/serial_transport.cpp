// libserialport 0.1.1, with locking and detection of hang-ups, which it lacks.
#include "host_tools/controller/stream/serial_transport.hpp"

#include <array>
#include <libserialport.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <thread>

#include "host_tools/base/input_error/input_error.hpp"

namespace cusp::stream {
namespace {

std::string last_error(const std::string& otherwise)
{
    char* text = sp_last_error_message();
    const std::string message = text != nullptr && *text != '\0' ? text : otherwise;
    sp_free_error_message(text);
    return message;
}

void demand(sp_return result, const std::string& device, const std::string& what)
{
    if (result == SP_ERR_ARG) {
        throw InputError{device + ": " + what + ": is no serial port"};
    }
    if (result != SP_OK) {
        throw InputError{device + ": " + what + ": " + last_error("not supported")};
    }
}

// sp_open() does not lock the device.
void lock(sp_port* port, const std::string& device)
{
    int descriptor = -1;
    demand(sp_get_port_handle(port, &descriptor), device, "its handle");
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
        throw InputError{device + ": another program uses it"};
    }
    ::ioctl(descriptor, TIOCEXCL);
}

}  // namespace

void SerialTransport::Closer::operator()(sp_port* port) const
{
    sp_close(port);
    sp_free_port(port);
}

SerialTransport::SerialTransport(const std::string& device, int baud) : device_{device}
{
    sp_port* port = nullptr;
    demand(sp_get_port_by_name(device.c_str(), &port), device, "can't be found");
    port_.reset(port);
    demand(sp_open(port, SP_MODE_READ_WRITE), device, "can't be opened");
    lock(port, device);
    demand(sp_set_baudrate(port, baud), device, "baud rate " + std::to_string(baud));
    demand(sp_set_bits(port, 8), device, "eight bits");
    demand(sp_set_parity(port, SP_PARITY_NONE), device, "no parity");
    demand(sp_set_stopbits(port, 1), device, "one stop bit");
    demand(sp_set_flowcontrol(port, SP_FLOWCONTROL_NONE), device, "no flow control");
    // Boards with native USB send nothing until DTR is on; boards without DTR ignore it.
    sp_set_dtr(port, SP_DTR_ON);
}

std::size_t SerialTransport::write(std::string_view bytes)
{
    const int sent = sp_nonblocking_write(port_.get(), bytes.data(), bytes.size());
    if (sent < 0) {
        throw LinkLost{"the line failed: " + last_error("write error")};
    }
    return static_cast<std::size_t>(sent);
}

std::string SerialTransport::read(std::chrono::milliseconds timeout)
{
    std::array<char, 4096> bytes{};
    const auto start = std::chrono::steady_clock::now();
    const int count = sp_blocking_read_next(port_.get(), bytes.data(), bytes.size(),
                                            static_cast<unsigned>(timeout.count()) + 1U);
    if (count < 0) {
        throw LinkLost{"the line failed: " + last_error("read error")};
    }
    if (count > 0) {
        return {bytes.data(), static_cast<std::size_t>(count)};
    }
    // Reads of a disconnected port return nothing at once; the query of waiting bytes fails.
    if (sp_input_waiting(port_.get()) < 0) {
        throw LinkLost{"the device is gone: " + last_error("no answer from the port")};
    }
    std::this_thread::sleep_until(start + timeout);
    return {};
}

}  // namespace cusp::stream
