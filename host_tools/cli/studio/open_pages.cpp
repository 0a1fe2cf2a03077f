// A count of pages, and the wait for its end.
#include "host_tools/cli/studio/open_pages.hpp"

namespace cusp::studio {

void OpenPages::opened()
{
    const std::lock_guard<std::mutex> lock{mutex_};
    ++open_;
    had_one_ = true;
    changed_.notify_all();
}

void OpenPages::closed()
{
    const std::lock_guard<std::mutex> lock{mutex_};
    --open_;
    changed_.notify_all();
}

void OpenPages::wait_for_the_last(std::chrono::duration<double> linger)
{
    std::unique_lock<std::mutex> lock{mutex_};
    const auto is_open = [&] {
        return open_ > 0 || ended_;
    };
    changed_.wait(lock, [&] { return had_one_ || ended_; });
    while (!ended_) {
        changed_.wait(lock, [&] { return open_ == 0 || ended_; });
        // a page that is loaded again closes and opens
        if (!changed_.wait_for(lock, linger, is_open)) {
            return;
        }
    }
}

void OpenPages::end()
{
    const std::lock_guard<std::mutex> lock{mutex_};
    ended_ = true;
    changed_.notify_all();
}

}  // namespace cusp::studio
