// Bars appear for long work alone.
#include "host_tools/cli/console_watcher.hpp"

#include "host_tools/base/cancellation/cancellation.hpp"

#include "fmt/format.h"

namespace cusp::cli {

void ConsoleWatcher::operation(std::size_t place, std::size_t count, const std::string& strategy)
{
    fmt::print(said_, "operation {} of {}: {}\n", place, count, strategy);
    std::fflush(said_);
}

void ConsoleWatcher::begin(const std::string& work)
{
    cancellation::set_work(work);
    bar_.reset();
}

void ConsoleWatcher::progress(const char* work, double share)
{
    constexpr double kQuiet = 0.5;  // s
    if (!bar_) {
        bar_.emplace(work, kQuiet);
    }
    (*bar_)(share);
}

void print_warnings(const std::vector<std::string>& warnings)
{
    for (const std::string& warning : warnings) {
        fmt::print(stderr, "cusp: warning: {}\n", warning);
    }
}

}  // namespace cusp::cli
