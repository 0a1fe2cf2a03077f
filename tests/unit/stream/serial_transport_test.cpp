// The transport of libserialport, over a pseudo-terminal.
//
// libserialport refuses those: it looks for /sys/class/tty/pts/N, and wants modem lines (TIOCMGET)
// that they do not have. The three calls that fail are interposed here: the library finds the
// program's own functions before those of libc. Everything else is the kernel's.
#include "host_tools/controller/stream/serial_transport.hpp"

#include <cerrno>
#include <chrono>
#include <cstdarg>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "CppUTest/TestHarness.h"

#include "hal/posix/endpoints.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/simulate/virtual_controller.hpp"
#include "host_tools/controller/stream/streamer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

constexpr const char* kClass = "/sys/class/tty/pts/";
int modem_lines = 0;

}  // namespace

extern "C" int __lxstat(int /*version*/, const char* path, struct stat* result)
{
    if (std::strncmp(path, kClass, std::strlen(kClass)) == 0) {
        *result = {};
        result->st_mode = S_IFLNK;
        return 0;
    }
    return ::fstatat(AT_FDCWD, path, result, AT_SYMLINK_NOFOLLOW);
}

extern "C" ssize_t readlink(const char* path, char* result, size_t size) noexcept
{
    if (std::strncmp(path, kClass, std::strlen(kClass)) == 0) {
        constexpr const char* kDevice = "../../devices/virtual/tty/pts";
        std::strncpy(result, kDevice, size);
        return static_cast<ssize_t>(std::strlen(kDevice));
    }
    return ::readlinkat(AT_FDCWD, path, result, size);
}

// NOLINTNEXTLINE(cert-dcl50-cpp): as libc has it.
extern "C" int ioctl(int descriptor, unsigned long request, ...) noexcept
{
    va_list words;
    va_start(words, request);
    void* argument = va_arg(words, void*);
    va_end(words);
    switch (request) {
        case TIOCMGET:
            *static_cast<int*>(argument) = modem_lines;
            return 0;
        case TIOCMSET:
            modem_lines = *static_cast<int*>(argument);
            return 0;
        case TIOCMBIS:
            modem_lines |= *static_cast<int*>(argument);
            return 0;
        case TIOCMBIC:
            modem_lines &= ~*static_cast<int*>(argument);
            return 0;
        default:
            return static_cast<int>(::syscall(SYS_ioctl, descriptor, request, argument));
    }
}

using namespace cusp;
using std::chrono::milliseconds;

TEST_GROUP(SerialTransport)
{
    test::TemporaryFolder folder;
    std::optional<hal::PseudoTerminal> terminal;
    hal::Descriptor controller;
    std::string device;

    void setup() override
    {
        terminal.emplace(folder.file("port"));
        controller = terminal->open_controller_end();
        device = std::filesystem::canonical(folder.file("port")).string();
    }
    std::string heard()
    {
        char bytes[64];
        const ssize_t count = ::read(controller.number(), bytes, sizeof bytes);
        return count > 0 ? std::string(bytes, static_cast<std::size_t>(count)) : std::string{};
    }
};

TEST(SerialTransport, CarriesBytesBothWaysAtTheRateAskedFor)
{
    stream::SerialTransport transport{device, 115200};
    LONGS_EQUAL(3, transport.write("G21"));
    STRCMP_EQUAL("G21", heard().c_str());
    LONGS_EQUAL(4, ::write(controller.number(), "ok\r\n", 4));
    STRCMP_EQUAL("ok\r\n", transport.read(milliseconds{500}).c_str());
    termios settings{};
    ::tcgetattr(controller.number(), &settings);
    LONGS_EQUAL(B115200, ::cfgetospeed(&settings));
    CHECK((modem_lines & TIOCM_DTR) != 0);
}

TEST(SerialTransport, TakesAMegabaud) { stream::SerialTransport transport{device, 1'000'000}; }

TEST(SerialTransport, WaitsForAByteUpToItsTimeout)
{
    stream::SerialTransport transport{device, 115200};
    const auto start = std::chrono::steady_clock::now();
    STRCMP_EQUAL("", transport.read(milliseconds{50}).c_str());
    const auto waited = std::chrono::steady_clock::now() - start;
    CHECK(waited >= milliseconds{45});
    CHECK(waited < milliseconds{500});
}

TEST(SerialTransport, IsForOneProgramAlone)
{
    stream::SerialTransport transport{device, 115200};
    CHECK_THROWS(InputError, stream::SerialTransport(device, 115200));
}

TEST(SerialTransport, TellsWhenTheOtherEndIsGone)
{
    stream::SerialTransport transport{device, 115200};
    controller = {};
    terminal.reset();
    bool lost = false;
    const auto start = std::chrono::steady_clock::now();
    while (!lost && std::chrono::steady_clock::now() - start < milliseconds{2000}) {
        try {
            transport.read(milliseconds{20});
        } catch (const stream::LinkLost&) {
            lost = true;
        }
    }
    CHECK(lost);
}

TEST(SerialTransport, RefusesWhatIsNoSerialPort)
{
    CHECK_THROWS(InputError, stream::SerialTransport("/dev/null", 115200));
    CHECK_THROWS(InputError, stream::SerialTransport("/dev/no-such-port", 115200));
}

TEST(SerialTransport, TakesAProgramToTheVirtualController)
{
    struct Quiet : stream::StreamWatcher {
        void ready(const stream::ControllerFacts&) override {}
        void progress(const stream::StreamProgress&) override {}
        void notice(const std::string&) override {}
        stream::StreamKey key() override { return stream::StreamKey::kNone; }
    };
    simulate::ServeOptions options;
    options.pty_link = folder.file("mill");
    std::atomic<int> stop{0};
    std::thread server{[&] {
        simulate::serve(options, stop);
    }};
    while (!std::filesystem::exists(options.pty_link)) {
        std::this_thread::sleep_for(milliseconds{1});
    }
    stream::StreamReport report;
    {
        stream::SerialTransport transport{std::filesystem::canonical(options.pty_link).string(),
                                          115200};
        Quiet watcher;
        dialect::ProgramLines program{folder.with("part.ngc", "G21 G90\nG1 X1 F6000\nG1 X0.5\n")};
        report = stream::Streamer{transport, watcher, {}}.run(program, stop);
    }
    stop = 1;
    server.join();
    STRCMP_EQUAL("", report.text.c_str());
    DOUBLES_EQUAL(0.5, report.progress.status.machine_position->x, 1e-9);
}
