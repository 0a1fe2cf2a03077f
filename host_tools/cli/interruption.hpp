// Counts Ctrl-C instead of ending the process, so that machines can be stopped and files completed.
#pragma once

#include <atomic>
#include <functional>

namespace cusp::cli {

// Number of SIGINT and SIGTERM since the first call, which installs the handler.
const std::atomic<int>& count_interruptions();

// True from the first of them on, for runs that ask whether to stop.
std::function<bool()> was_interrupted();

}  // namespace cusp::cli
