// Loops of straight sides for jobs in tests.
#pragma once

#include <vector>

#include "host_tools/job/job/job.hpp"

namespace cusp::test {

inline job::Loop loop_of(const std::vector<Vec2d>& corners)
{
    job::Loop loop;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2d a = corners[i];
        const Vec2d b = corners[(i + 1) % corners.size()];
        loop.push_back({1, {0, 0, 1, 1}, {{a.x, a.y, 0}, {b.x, b.y, 0}}, {1, 1}});
    }
    return loop;
}

}  // namespace cusp::test
