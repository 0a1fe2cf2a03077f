// Counts Ctrl-C instead of ending the process, so that machines are stopped and files completed.
#pragma once

#include <atomic>

namespace cusp::cli {

// From the first call on SIGINT and SIGTERM only count here.
const std::atomic<int>& count_interruptions();

}  // namespace cusp::cli
