// For commands that drive a machine. Planning and verifying end at once: host_tools/cancellation.
#include "host_tools/cli/interruption.hpp"

#include <csignal>

namespace cusp::cli {
namespace {

std::atomic<int> interruptions{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use it");

extern "C" void count_one(int /*signal*/) { ++interruptions; }

}  // namespace

const std::atomic<int>& count_interruptions()
{
    std::signal(SIGINT, count_one);
    std::signal(SIGTERM, count_one);
    return interruptions;
}

std::function<bool()> was_interrupted()
{
    return [&stops = count_interruptions()] {
        return stops.load() > 0;
    };
}

}  // namespace cusp::cli
