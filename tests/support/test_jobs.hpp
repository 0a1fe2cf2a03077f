// What tests of planners ask for again and again: a job, hills, a count of a planned operation.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"
#include "tests/support/tap.hpp"

namespace cusp::test {

// Without tools and operations, at feeds and a clearance that suit all.
inline job::Job plain_job()
{
    job::Job job;
    job.file = "job.toml";
    job.feed = 1000;
    job.plunge_feed = 200;
    job.clearance = 5;
    return job;
}

// Hills of one size over a square of about `patches` patches of 10 x 10 mm.
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

// Not a number, which fails any comparison, where there is none of that name.
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
