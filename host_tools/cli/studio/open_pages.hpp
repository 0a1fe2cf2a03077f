// The pages that are open, each known by a request that lasts as long as it does.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace cusp::studio {

class OpenPages {
public:
    void opened();
    void closed();

    // Returns when there has been a page, and none has been open for so long; or after end().
    void wait_for_the_last(std::chrono::duration<double> linger);
    void end();

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int open_{0};
    bool had_one_{false};
    bool ended_{false};
};

}  // namespace cusp::studio
