// Lines over pseudo-terminals and sockets.
#include "hal/posix/endpoints.hpp"

#include <filesystem>
#include <system_error>
#include <thread>

#include "CppUTest/TestHarness.h"

#include "hal/posix/descriptor_link.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace cusp::hal;

void say(DescriptorLink& link, const std::string& text)
{
    for (const char character : text) {
        const std::uint8_t byte[] = {static_cast<std::uint8_t>(character)};
        link.write(byte);
    }
}

// Bytes that arrive within half a second, up to `size`.
std::string hear(DescriptorLink& link, std::size_t size)
{
    std::string text;
    for (int wait = 0; wait < 500 && text.size() < size; ++wait) {
        std::uint8_t byte = 0;
        while (link.try_read(byte)) {
            text.push_back(static_cast<char>(byte));
        }
        std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    return text;
}

}  // namespace

TEST_GROUP(Endpoints) { cusp::test::TemporaryFolder folder; };

TEST(Endpoints, CarryEveryByteValueOverAPseudoTerminal)
{
    const PseudoTerminal terminal{folder.file("port")};
    DescriptorLink controller{terminal.open_controller_end()};
    controller.survive_hang_up(true);
    DescriptorLink sender{open_terminal(folder.file("port"))};
    std::string all;
    for (int byte = 0; byte < 256; ++byte) {
        all.push_back(static_cast<char>(byte));
    }
    say(sender, all);
    CHECK(hear(controller, 256) == all);
    say(controller, all);
    CHECK(hear(sender, 256) == all);
}

TEST(Endpoints, KnowWhetherSomebodyHoldsTheOtherEndOfAPseudoTerminal)
{
    const PseudoTerminal terminal{folder.file("port")};
    CHECK_FALSE(terminal.has_peer());
    {
        const Descriptor sender = open_terminal(folder.file("port"));
        CHECK(terminal.has_peer());
    }
    CHECK_FALSE(terminal.has_peer());
    const Descriptor again = open_terminal(folder.file("port"));
    CHECK(terminal.has_peer());
}

TEST(Endpoints, RemoveTheLinkOfAPseudoTerminal)
{
    {
        const PseudoTerminal terminal{folder.file("port")};
        CHECK(std::filesystem::is_symlink(folder.file("port")));
    }
    CHECK_FALSE(std::filesystem::is_symlink(folder.file("port")));
}

TEST(Endpoints, NeverReplaceAFileByALink)
{
    folder.with("precious", "text");
    CHECK_THROWS(std::system_error, PseudoTerminal{folder.file("precious")});
    STRCMP_EQUAL("text", folder.text_of("precious").c_str());
}

TEST(Endpoints, OpenATerminalForOneSenderOnly)
{
    const PseudoTerminal terminal{folder.file("port")};
    const Descriptor first = open_terminal(folder.file("port"));
    CHECK_THROWS(std::system_error, open_terminal(folder.file("port")));
}

TEST(Endpoints, CarryBytesOverTcpAndNoticeTheEnd)
{
    const TcpListener listener{{"127.0.0.1", "0"}};
    CHECK_FALSE(listener.accept_waiting().is_open());
    DescriptorLink sender{connect_tcp({"127.0.0.1", std::to_string(listener.port())})};
    DescriptorLink controller{listener.accept_waiting()};
    say(sender, "$$\n");
    STRCMP_EQUAL("$$\n", hear(controller, 3).c_str());
    controller.disconnect();
    hear(sender, 1);
    CHECK(sender.lost());
}

TEST(Endpoints, RefuseAPortThatNobodyServes)
{
    CHECK_THROWS(std::system_error, connect_tcp({"127.0.0.1", "1"}));
}

TEST(Endpoints, ParseTcpAddresses)
{
    STRCMP_EQUAL("localhost", parse_tcp_address("localhost:23")->host.c_str());
    STRCMP_EQUAL("::1", parse_tcp_address("[::1]:23")->host.c_str());
    STRCMP_EQUAL("4000", parse_tcp_address(":4000")->port.c_str());
    CHECK_FALSE(parse_tcp_address("localhost").has_value());
    CHECK_FALSE(parse_tcp_address("localhost:").has_value());
    CHECK_FALSE(parse_tcp_address("localhost:http").has_value());
    CHECK_FALSE(parse_tcp_address("localhost:70000").has_value());
    CHECK_FALSE(parse_tcp_address("::1:23").has_value());
}

TEST(Endpoints, DropWhatIsSaidToNobody)
{
    DescriptorLink link;
    say(link, "ok\r\n");
    CHECK_FALSE(link.pending());
    std::uint8_t byte = 0;
    CHECK_FALSE(link.try_read(byte));
}
