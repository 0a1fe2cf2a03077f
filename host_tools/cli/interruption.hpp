// Counts Ctrl-C instead of ending the process, so that machines can be stopped and files completed.
#pragma once

#include <atomic>

namespace cusp::cli {

// Number of SIGINT and SIGTERM since the first call, which installs the handler.
const std::atomic<int>& count_interruptions();

}  // namespace cusp::cli
