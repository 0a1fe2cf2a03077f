// Plugs, sleeps, and control transfers, from words.
#include "tests/target/cosim/usb_console.hpp"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>

namespace cusp::cosim {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& hex)
{
    std::vector<std::uint8_t> bytes;
    for (std::size_t at = 0; at + 1 < hex.size(); at += 2) {
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(at, 2), nullptr, 16)));
    }
    return bytes;
}

void tell(const UsbHost::Result& result)
{
    std::cout << "stage " << result.stage << " " << std::flush;
    for (const std::uint8_t byte : result.data) {
        std::printf("%02x", unsigned{byte});
    }
    std::fflush(stdout);
    std::cout << "\n";
}

UsbHost::Request request_of(std::istream& words)
{
    std::string setup;
    std::string data;
    words >> setup >> data;
    const std::vector<std::uint8_t> bytes = bytes_of(setup);
    UsbHost::Request request{{}, bytes_of(data)};
    if (bytes.size() != request.setup.size()) {
        throw std::runtime_error{"a SETUP packet has eight bytes: " + setup};
    }
    std::copy(bytes.begin(), bytes.end(), request.setup.begin());
    return request;
}

}  // namespace

void command_usb(ChipUnderTest& chip, std::istream& words)
{
    UsbHost& host = chip.usb();
    std::string what;
    words >> what;
    if (what == "plug") {
        host.plug();
    } else if (what == "unplug") {
        host.unplug();
    } else if (what == "suspend") {
        host.suspend();
    } else if (what == "resume") {
        host.resume();
    } else if (what == "open" || what == "close") {
        host.open(what == "open");
    } else if (what == "address") {
        unsigned address = 0;
        words >> address;
        host.set_address(address);
    } else if (what == "begin") {
        host.begin_only(request_of(words));
    } else if (what == "control") {
        tell(host.control(request_of(words), [&chip](Picoseconds time) { chip.run(time); }));
    } else if (what == "give" || what == "fetch") {
        unsigned endpoint = 0;
        std::string data;
        words >> endpoint >> data;
        tell(what == "fetch" ? host.fetch(endpoint)
                             : UsbHost::Result{host.give(endpoint, bytes_of(data)), {}});
    } else {
        throw std::runtime_error{"no such command: usb " + what};
    }
}

}  // namespace cusp::cosim
