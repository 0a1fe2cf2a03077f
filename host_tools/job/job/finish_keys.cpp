// A slope is compared by the z of its normal.
#include "host_tools/job/job/finish_keys.hpp"

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

#include "fmt/format.h"

namespace cusp::job {
namespace {

constexpr double kUpright = 90;      // degrees
constexpr double kSameSlope = 1e-9;  // of a normal's z

double normal_z_at(double degrees)
{
    return degrees >= kUpright ? 0.0 : elementary::cos(degrees * kPi / 180);
}

}  // namespace

double GroundRange::least_normal_z() const { return normal_z_at(most_slope) - kSameSlope; }
double GroundRange::most_normal_z() const { return normal_z_at(least_slope) + kSameSlope; }

bool GroundRange::holds(double z, double normal_z) const
{
    return normal_z >= least_normal_z() && normal_z <= most_normal_z() && z >= low && z <= high;
}

bool finishes_ground(const Operation& operation)
{
    return std::any_cast<FinishKeys>(&operation.parameters) != nullptr;
}

GroundRange ground_range_of(const Operation& operation)
{
    const auto* keys = std::any_cast<FinishKeys>(&operation.parameters);
    return keys == nullptr ? GroundRange{} : keys->range;
}

Key direction_key()
{
    return choice("direction", {"u", "v"}, "passes run along u or v; of planes along x or y");
}

std::vector<Key> with_ranges(std::vector<Key> keys)
{
    keys.push_back(
        {"slopes",
         KeyKind::kNumbers,
         "all",
         "`[least, greatest]`, degrees from level: only ground of these slopes is finished",
         {0, kUpright}});
    keys.push_back({"heights", KeyKind::kExtent, "all", "only ground between these z is finished"});
    return keys;
}

GroundRange read_range(const KeyValues& values, const Refuse& refuse)
{
    GroundRange range;
    if (const auto slopes = values.find<std::vector<double>>("slopes")) {
        if (slopes->size() != 2 || !((*slopes)[0] < (*slopes)[1])) {
            refuse("slopes", "needs the least and the greatest slope, such as [0, 45]");
        }
        range.least_slope = (*slopes)[0];
        range.most_slope = (*slopes)[1];
    }
    if (const auto heights = values.find<std::vector<double>>("heights")) {
        range.low = (*heights)[0];
        range.high = (*heights)[1];
    }
    return range;
}

}  // namespace cusp::job
