// Records the progress reports of a planner.
#pragma once

#include <vector>

#include "host_tools/job/job/job.hpp"

namespace cusp::test {

// Records reports during its lifetime, in which the job must not be moved.
class RecordedProgress {
public:
    explicit RecordedProgress(job::Job& job)
    {
        job.progress = [this](double share) {
            shares_.push_back(share);
        };
    }
    RecordedProgress(const RecordedProgress&) = delete;
    RecordedProgress& operator=(const RecordedProgress&) = delete;

    // True if the reports are in 0 to 1, never decrease, and differ by at most `widest`.
    bool rises(double widest) const
    {
        double last = 0.0;
        for (const double share : shares_) {
            if (share < last || share > last + widest) {
                return false;
            }
            last = share;
        }
        return last <= 1.0 && last + widest >= 1.0;
    }

private:
    std::vector<double> shares_;
};

}  // namespace cusp::test
