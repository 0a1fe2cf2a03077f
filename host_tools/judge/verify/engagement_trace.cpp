// Counts per band, so that the sum is the same for any number of threads.
#include "host_tools/judge/verify/engagement_trace.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::verify {

namespace {

constexpr int kLooks = 120;           // on the front half of the circle: 1.5 degrees apart
constexpr double kOutside = 1.0;      // pitches from the tool to the places looked up
constexpr double kMeanReach = 1.5;    // pitches: the mean is over so much before and after
constexpr double kGap = 3.0;          // pitches between two cuts that are one
constexpr double kEntrySlope = 0.02;  // of the way: steeper ones down are entries
constexpr double kFoot = 0.05;        // radii from the foot of an entry
constexpr double kOverTip = 1e-4;     // mm: stock that is higher over the tool is in its way

// Directions from the axis, x along the feed.
std::array<Vec2d, kLooks> front_half()
{
    std::array<Vec2d, kLooks> all{};
    for (int n = 0; n < kLooks; ++n) {
        const double angle = kPi * ((n + 0.5) / kLooks - 0.5);
        all[static_cast<std::size_t>(n)] = {elementary::cos(angle), elementary::sin(angle)};
    }
    return all;
}

// The point of a grid that is nearest to a place, or the second nearest.
class NearPoint {
public:
    NearPoint(const HeightGrid& grid, const std::vector<double>& shifts)
        : grid_{grid}, shifts_{shifts}
    {
    }

    // Its place in the grid; grid.size() where the place is outside or in another band.
    std::size_t at(Vec2d place, std::size_t begin, std::size_t end) const
    {
        const double x = (place.x - grid_.x0) / grid_.pitch;
        const double y = (place.y - grid_.y0) / grid_.pitch;
        const long column = rounded(x);  // off by one at most
        if (column + 1 < static_cast<long>(begin) || column > static_cast<long>(end)) {
            return grid_.size();
        }
        const long first = rounded(y - shift(column));
        const long i = rounded(x - shift(first));
        const long second = rounded(y - shift(i));
        const auto squared = [&](long j) {
            const double dx = static_cast<double>(i) + shift(j) - x;
            const double dy = static_cast<double>(j) + shift(i) - y;
            return dx * dx + dy * dy;
        };
        const long j = squared(second) < squared(first) ? second : first;
        const bool inside = i >= static_cast<long>(begin) && i < static_cast<long>(end) && j >= 0 &&
                            j < static_cast<long>(grid_.ny);
        return inside ? grid_.index(static_cast<std::size_t>(i), static_cast<std::size_t>(j))
                      : grid_.size();
    }

private:
    static long rounded(double value) { return static_cast<long>(std::floor(value + 0.5)); }
    double shift(long k) const
    {
        return shifts_[static_cast<std::size_t>(
            std::clamp(k, 0L, static_cast<long>(shifts_.size()) - 1))];
    }

    const HeightGrid& grid_;
    const std::vector<double>& shifts_;
};

}  // namespace

EngagementTrace::EngagementTrace(const HeightGrid& grid, const ToolPositions& positions)
    : grid_{grid}, positions_{positions}, shifts_(std::max(grid.nx, grid.ny))
{
    for (std::size_t k = 0; k < shifts_.size(); ++k) {
        shifts_[k] = grid.shift(k) / grid.pitch;
    }
    for (auto& band : seen_) {
        band.resize(positions.tips.size());
    }
    find_entries();
}

void EngagementTrace::find_entries()
{
    enters_.resize(positions_.tips.size());
    Vec3d foot{};
    for (std::size_t k = 1; k < enters_.size(); ++k) {
        const Vec3d tip = positions_.tips[k];
        if (descends(k)) {
            enters_[k] = true;
            foot = tip;
        } else if (enters_[k - 1] && !positions_.rapid[k]) {
            enters_[k] = norm(tip - foot) <= kFoot * positions_.tool.radius;
        }
    }
}

double EngagementTrace::way(std::size_t k) const
{
    return k > 0 ? norm(positions_.tips[k] - positions_.tips[k - 1]) : 0.0;
}

bool EngagementTrace::descends(std::size_t k) const
{
    return positions_.tips[k].z - positions_.tips[k - 1].z < -kEntrySlope * way(k);
}

void EngagementTrace::look(const std::vector<double>& heights,
                           std::size_t k,
                           std::size_t band,
                           std::size_t begin,
                           std::size_t end)
{
    static const std::array<Vec2d, kLooks> kFront = front_half();
    if (k == 0 || positions_.rapid[k] || enters(k)) {
        return;
    }
    const Vec3d from = positions_.tips[k - 1];
    const Vec3d step = positions_.tips[k] - from;
    const double flat = std::sqrt(step.x * step.x + step.y * step.y);
    const double radius = positions_.tool.radius + kOutside * grid_.pitch;
    const double near = radius + 2 * grid_.pitch;
    const double x = from.x - grid_.x0;
    if (flat <= 0 || x + near < static_cast<double>(begin) * grid_.pitch ||
        x - near > static_cast<double>(end) * grid_.pitch) {
        return;
    }
    const Vec2d ahead{step.x / flat * radius, step.y / flat * radius};
    const double height = std::max(from.z, from.z + step.z) +
                          profile_height(positions_.tool, positions_.tool.radius) + kOverTip;
    const NearPoint points{grid_, shifts_};
    int in_stock = 0;
    for (const Vec2d direction : kFront) {
        const Vec2d place{from.x + direction.x * ahead.x - direction.y * ahead.y,
                          from.y + direction.x * ahead.y + direction.y * ahead.x};
        const std::size_t point = points.at(place, begin, end);
        in_stock += point < heights.size() && heights[point] > height ? 1 : 0;
    }
    seen_[band][k].in_stock = static_cast<std::uint8_t>(in_stock);
}

bool EngagementTrace::cuts(std::size_t k) const
{
    return std::any_of(seen_.begin(), seen_.end(), [&](const auto& band) { return band[k].cuts; });
}

double EngagementTrace::angle_seen(std::size_t k) const
{
    int in_stock = 0;
    for (const auto& band : seen_) {
        in_stock += band[k].in_stock;
    }
    const double outer = 1 + kOutside * grid_.pitch / positions_.tool.radius;
    return elementary::acos(
        std::clamp(outer * elementary::cos(kPi * in_stock / kLooks), -1.0, 1.0));
}

// Thin cuts remove a point of the grid now and then: only long gaps between such are air.
std::vector<StepKind> EngagementTrace::kinds() const
{
    const std::size_t count = positions_.tips.size();
    std::vector<StepKind> kinds(count, StepKind::kRapid);
    std::size_t gap = 1;  // its first step
    bool open = false;    // a cut lies before the gap, without a rapid move between
    double gap_length = 0;
    const auto close = [&](std::size_t end, bool at_cut) {
        if (open && at_cut && gap_length <= kGap * grid_.pitch) {
            for (std::size_t k = gap; k < end; ++k) {
                kinds[k] = enters(k) ? StepKind::kEntry : StepKind::kCut;
            }
        }
        gap = end + 1;
        gap_length = 0;
        open = at_cut;
    };
    for (std::size_t k = 1; k < count; ++k) {
        if (positions_.rapid[k]) {
            close(k, false);
        } else if (cuts(k)) {
            close(k, true);
            kinds[k] = enters(k) ? StepKind::kEntry : StepKind::kCut;
        } else {
            kinds[k] = StepKind::kAir;
            gap_length += way(k);
        }
    }
    return kinds;
}

EngagementRun EngagementTrace::finish() const
{
    EngagementRun run{kinds(), {}, kUnbounded};
    const std::size_t count = run.kinds.size();
    run.angles.resize(count);
    const double reach = kMeanReach * grid_.pitch;
    for (std::size_t begin = 0; begin < count; ++begin) {
        if (run.kinds[begin] != StepKind::kCut) {
            continue;
        }
        std::size_t end = begin;
        std::vector<double> middle;     // mm from the stretch's start
        std::vector<double> moment{0};  // sums of angle times way
        std::vector<double> along{0};
        for (; end < count && run.kinds[end] == StepKind::kCut; ++end) {
            middle.push_back(along.back() + way(end) / 2);
            along.push_back(along.back() + way(end));
            moment.push_back(moment.back() + way(end) * angle_seen(end));
        }
        std::size_t low = 0;
        std::size_t high = 0;
        for (std::size_t n = 0; n < middle.size(); ++n) {
            for (; middle[low] < middle[n] - reach; ++low) {
            }
            for (; high < middle.size() && middle[high] <= middle[n] + reach; ++high) {
            }
            const double length = along[high] - along[low];
            const double mean = length > 0 ? (moment[high] - moment[low]) / length : 0.0;
            run.angles[begin + n] = static_cast<float>(mean / kPi * 180);
        }
        begin = end;
    }
    return run;
}

}  // namespace cusp::verify
