// The share of a loop on several threads that is done.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>

namespace cusp::adaptive_isocurve {

// Reports the share that is done, for use by several threads.
class ShareOfCount {
public:
    ShareOfCount(std::size_t all, std::function<void(double)> report)
        : all_{static_cast<double>(all)}, report_{std::move(report)}
    {
    }

    void count()
    {
        const std::lock_guard lock{guard_};
        report_(static_cast<double>(++done_) / all_);
    }

private:
    double all_;
    std::function<void(double)> report_;
    std::mutex guard_;
    std::size_t done_{0};
};

}  // namespace cusp::adaptive_isocurve
