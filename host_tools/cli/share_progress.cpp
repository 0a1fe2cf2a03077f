// Prints on the standard error stream, so that results can be piped.
#include "host_tools/cli/share_progress.hpp"

#include <unistd.h>
#include <utility>

#include "host_tools/base/cancellation/cancellation.hpp"

#include "fmt/format.h"

namespace cusp::cli {

ShareProgress::ShareProgress(std::string what, double quiet_s)
    : what_{std::move(what)},
      quiet_s_{quiet_s},
      begin_{std::chrono::steady_clock::now()},
      is_terminal_{isatty(STDERR_FILENO) != 0}
{
}

void ShareProgress::operator()(double share)
{
    cancellation::set_share(share);
    constexpr int kWidth = 40;
    const int steps = is_terminal_ ? kWidth : 4;
    const int now = static_cast<int>(share * steps);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
    if (now <= shown_ || (shown_ == 0 && spent.count() < quiet_s_)) {
        return;
    }
    shown_ = now;
    if (is_terminal_) {
        fmt::print(stderr, "\r{} [{:<{}}] {:3.0f} %{}", what_,
                   std::string(static_cast<std::size_t>(now), '='), kWidth, 100 * share,
                   now == kWidth ? "\n" : "");
    } else {
        fmt::print(stderr, "{} {:.0f} %\n", what_, 100 * share);
    }
    std::fflush(stderr);
}

}  // namespace cusp::cli
