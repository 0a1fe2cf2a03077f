// Fixtures of planner tests: a job, hills, a count of a planned operation.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "tests/support/tap.hpp"

namespace cusp::test {

// A job without tools and operations, with feeds and a clearance for any test.
inline job::Job plain_job()
{
    job::Job job;
    job.file = "job.toml";
    job.feed = 1000;
    job.plunge_feed = 200;
    job.clearance = 5;
    return job;
}

// Equal hills on a square of about `patches` patches of 10 x 10 mm.
inline nurbs::Surface hills(double patches)
{
    const int side = static_cast<int>(std::lround(std::sqrt(patches))) + 3;
    std::vector<Vec3d> net;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            net.push_back({10.0 * i, 10.0 * j, 8 * std::sin(i * 0.7) * std::cos(j * 0.6)});
        }
    }
    return bicubic(side, side, std::move(net));
}

// NaN, which fails any comparison, where there is no count of that name.
inline double count_of(const toolpath::PlannedOperation& planned, const std::string& name)
{
    for (const auto& [key, value] : planned.stats.counts) {
        if (key == name) {
            return value;
        }
    }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace cusp::test
