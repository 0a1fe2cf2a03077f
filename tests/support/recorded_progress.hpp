// What a planner tells of its progress.
#pragma once

#include <vector>

#include "host_tools/job/job.hpp"

namespace cusp::test {

// Keeps the shares told while it lives; the job is not to be moved meanwhile.
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

    // Whether shares of 0 to 1 were told that never fell, with no step of more than `widest`.
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
