// What a planner tells of its progress.
#pragma once

#include <vector>

#include "host_tools/import/job.hpp"

namespace cusp::test {

// Keeps the shares told while it lives; the job is not to be moved meanwhile.
class ToldProgress {
public:
    explicit ToldProgress(host::Job& job)
    {
        job.progress = [this](double share) {
            told_.push_back(share);
        };
    }
    ToldProgress(const ToldProgress&) = delete;
    ToldProgress& operator=(const ToldProgress&) = delete;

    // Whether shares of 0 to 1 were told that never fell, with no step of more than `widest`.
    bool rises(double widest) const
    {
        double last = 0.0;
        for (const double share : told_) {
            if (share < last || share > last + widest) {
                return false;
            }
            last = share;
        }
        return last <= 1.0 && last + widest >= 1.0;
    }

private:
    std::vector<double> told_;
};

}  // namespace cusp::test
