// Follows the positions of the verification tick by tick.
#include "host_tools/judge/view/engagement_samples.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/base/assert.hpp"

namespace cusp::view {
namespace {

double squared_distance(Vec3d a, Vec3d b)
{
    const Vec3d way = b - a;
    return dot(way, way);
}

}  // namespace

EngagementSamples::EngagementSamples(const std::vector<verify::ToolPositions>& positions,
                                     const std::vector<verify::EngagementRun>& found)
    : positions_{positions}, found_{found}
{
    CUSP_ASSERT(positions.size() == found.size());
    skip_ended_runs();
}

void EngagementSamples::skip_ended_runs()
{
    while (has_position() && at_ >= positions_[run_].tips.size()) {
        ++run_;
        at_ = 0;
    }
}

void EngagementSamples::next_position()
{
    ++at_;
    skip_ended_runs();
}

bool EngagementSamples::next_is_nearer(Vec3d tip, std::uint32_t line) const
{
    const verify::ToolPositions& run = positions_[run_];
    return at_ + 1 < run.tips.size() && run.lines[at_ + 1] == line &&
           squared_distance(tip, run.tips[at_ + 1]) <= squared_distance(tip, run.tips[at_]);
}

void EngagementSamples::add(Vec3d tip, std::uint32_t line)
{
    while (has_position() && line_here() < line) {
        next_position();
    }
    if (has_position() && line_here() == line) {
        while (next_is_nearer(tip, line)) {
            ++at_;
        }
        greatest_ = std::max(greatest_, found_[run_].angles[at_]);
    }
    if (++bucket_ticks_ == kBucket) {
        end_bucket();
    }
}

void EngagementSamples::end_bucket()
{
    constexpr float kMost = 180;
    out_.put_u8(static_cast<std::uint64_t>(std::lround(std::min(greatest_, kMost))));
    bucket_ticks_ = 0;
    greatest_ = 0;
}

Bytes EngagementSamples::finish()
{
    if (bucket_ticks_ > 0) {
        end_bucket();
    }
    return std::move(out_);
}

}  // namespace cusp::view
