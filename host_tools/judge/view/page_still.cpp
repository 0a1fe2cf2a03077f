// Controls the browser through a pair of pipes: JSON messages, each followed by a zero byte (Chrome
// DevTools Protocol).
#include "host_tools/judge/view/page_still.hpp"

#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <sstream>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/json_text/json_text.hpp"

#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::view {

namespace {

namespace fs = std::filesystem;
using StillClock = std::chrono::steady_clock;
using BrowserMessage = nlohmann::json;

constexpr int kWidth = 1600;
constexpr int kHeight = 1000;
constexpr std::chrono::seconds kStillPatience{120};

std::string browser_program()
{
    if (const char* named = std::getenv("CHROMIUM")) {
        return named;
    }
    const char* path = std::getenv("PATH");
    std::istringstream folders{path != nullptr ? path : ""};
    for (std::string folder; std::getline(folders, folder, ':');) {
        for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
            const std::string program = folder + "/" + name;
            if (::access(program.c_str(), X_OK) == 0) {
                return program;
            }
        }
    }
    throw InputError{"cusp view --still: no Chromium is installed (Debian: chromium)"};
}

// A temporary folder for the browser's state, removed at the end.
class ScratchFolder {
public:
    ScratchFolder()
    {
        std::string name = (fs::temp_directory_path() / "cusp-still-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) {
            throw InputError{fmt::format("{}: can't be made: {}", name, std::strerror(errno))};
        }
        path_ = name;
    }
    ~ScratchFolder()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

class Browser {
public:
    Browser(const std::string& program, const std::string& folder)
        : deadline_{StillClock::now() + kStillPatience}
    {
        std::array<int, 2> commands{};
        std::array<int, 2> answers{};
        if (::pipe2(commands.data(), O_CLOEXEC) != 0 || ::pipe2(answers.data(), O_CLOEXEC) != 0) {
            throw InputError{"cusp view --still: no pipe to the browser"};
        }
        // If the browser ends early, write() is to fail and not to raise a signal.
        std::signal(SIGPIPE, SIG_IGN);
        child_ = ::fork();
        if (child_ == 0) {
            become(program, folder, commands[0], answers[1]);
        }
        ::close(commands[0]);
        ::close(answers[1]);
        out_ = commands[1];
        in_ = answers[0];
    }
    ~Browser()
    {
        ::close(out_);  // the browser exits when its pipe is closed
        ::close(in_);
        ::kill(child_, SIGTERM);
        ::waitpid(child_, nullptr, 0);
    }
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;

    // The answer's "result"; an answer with "error" is returned whole.
    BrowserMessage ask(const char* method, const BrowserMessage& parameters)
    {
        BrowserMessage message{{"id", ++number_}, {"method", method}, {"params", parameters}};
        if (!session_.empty()) {
            message["sessionId"] = session_;
        }
        write_all(json_text::written(message) + '\0');
        while (true) {
            BrowserMessage answer = next();
            if (answer.value("id", 0) == number_) {
                return answer.contains("result") ? answer["result"] : answer;
            }
        }
    }
    void attach(const std::string& session) { session_ = session; }

private:
    // Runs in the child process and does not return.
    [[noreturn]] static void become(const std::string& program,
                                    const std::string& folder,
                                    int commands,
                                    int answers)
    {
        // The browser reads from descriptor 3 and writes to 4. Both ends are first moved to other
        // numbers, since either may occupy 3 or 4.
        constexpr int kApart = 10;
        const int in = ::fcntl(commands, F_DUPFD, kApart);
        const int out = ::fcntl(answers, F_DUPFD, kApart);
        ::dup2(in, 3);
        ::dup2(out, 4);
        const int nowhere = ::open("/dev/null", O_RDWR);
        ::dup2(nowhere, STDOUT_FILENO);
        ::dup2(nowhere, STDERR_FILENO);
        std::vector<std::string> words{program,
                                       "--headless=new",
                                       "--remote-debugging-pipe",
                                       "--enable-unsafe-swiftshader",
                                       "--hide-scrollbars",
                                       "--no-first-run",
                                       "--disable-background-networking",
                                       "--disable-component-update",
                                       "--disable-sync",
                                       "--user-data-dir=" + folder,
                                       "about:blank"};
        if (::geteuid() == 0) {
            words.insert(words.begin() + 1, "--no-sandbox");
        }
        std::vector<char*> arguments;
        for (std::string& word : words) {
            arguments.push_back(word.data());
        }
        arguments.push_back(nullptr);
        ::execv(program.c_str(), arguments.data());
        ::_exit(127);
    }

    void write_all(const std::string& text)
    {
        std::size_t done = 0;
        while (done < text.size()) {
            const ssize_t count = ::write(out_, text.data() + done, text.size() - done);
            if (count <= 0) {
                throw InputError{"cusp view --still: the browser ended"};
            }
            done += static_cast<std::size_t>(count);
        }
    }

    BrowserMessage next()
    {
        for (std::size_t end; (end = heard_.find('\0')) == std::string::npos;) {
            const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                deadline_ - StillClock::now());
            pollfd wait{in_, POLLIN, 0};
            if (left.count() <= 0 || ::poll(&wait, 1, static_cast<int>(left.count())) == 0) {
                throw InputError{"cusp view --still: the browser did not draw the page in 120 s"};
            }
            std::array<char, 65536> buffer{};
            const ssize_t count = ::read(in_, buffer.data(), buffer.size());
            if (count <= 0) {
                throw InputError{"cusp view --still: the browser ended"};
            }
            heard_.append(buffer.data(), static_cast<std::size_t>(count));
        }
        const std::size_t end = heard_.find('\0');
        BrowserMessage message =
            BrowserMessage::parse(heard_.substr(0, end), nullptr, /*allow_exceptions=*/false);
        heard_.erase(0, end + 1);
        return message.is_object() ? message : BrowserMessage::object();
    }

    StillClock::time_point deadline_;
    pid_t child_{-1};
    int out_{-1};
    int in_{-1};
    int number_{0};
    std::string session_;
    std::string heard_;
};

std::string from_base64(const std::string& text)
{
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    unsigned held = 0;
    unsigned bits = 0;
    for (const char c : text) {
        const std::size_t digit = kDigits.find(c);
        if (digit == std::string_view::npos) {
            break;
        }
        held = (held << 6U | static_cast<unsigned>(digit)) & 0xffffU;
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            out.push_back(static_cast<char>(held >> bits & 0xffU));
        }
    }
    return out;
}

// A file: URL.
std::string file_address(const std::string& file)
{
    std::string out = "file://";
    for (const char c : fs::absolute(file).string()) {
        const bool plain =
            std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("/._-~", c) != nullptr;
        out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return out;
}

}  // namespace

std::string page_still(const std::string& page)
{
    const ScratchFolder folder;
    Browser browser{browser_program(), folder.path()};
    const BrowserMessage target =
        browser.ask("Target.createTarget", {{"url", file_address(page) + "#still"}});
    const BrowserMessage session = browser.ask(
        "Target.attachToTarget", {{"targetId", target.value("targetId", "")}, {"flatten", true}});
    browser.attach(session.value("sessionId", ""));
    browser.ask(
        "Emulation.setDeviceMetricsOverride",
        {{"width", kWidth}, {"height", kHeight}, {"deviceScaleFactor", 1}, {"mobile", false}});
    // window.cusp exists only once the script has run; a navigation in progress discards the answer.
    constexpr const char* kReady =
        "new Promise((done, fail) => { const look = () => window.cusp ? cusp.ready.then(() => "
        "cusp.seek(1e9)).then(() => done(\"drawn\"), fail) : setTimeout(look, 50); look(); })";
    BrowserMessage answer;
    do {
        answer =
            browser.ask("Runtime.evaluate",
                        {{"expression", kReady}, {"awaitPromise", true}, {"returnByValue", true}});
        if (answer.contains("exceptionDetails")) {
            throw InputError{fmt::format("{}: the page could not be drawn", page)};
        }
    } while (answer.contains("error") || answer["result"].value("value", "") != "drawn");
    const BrowserMessage picture = browser.ask("Page.captureScreenshot", {{"format", "png"}});
    return from_base64(picture.value("data", ""));
}

}  // namespace cusp::view
