// Keys of strategies that finish surfaces, and the range of ground that an operation is for.
//
//     const GroundRange& range = finish_keys(operation).range;
//     range.holds(-4.0, elementary::cos(slope));  // whether ground at that height and slope is to be finished
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/operation_keys.hpp"

namespace cusp::job {

// Ground by its slope and its height.
struct GroundRange {
    double least_slope{0};  // degrees from level
    double most_slope{90};
    double low{-kInfinite};  // z, mm
    double high{kInfinite};

    bool is_everything() const
    {
        return least_slope <= 0 && most_slope >= 90 && low == -kInfinite && high == kInfinite;
    }
    // The limits of the z of a unit normal.
    double least_normal_z() const;
    double most_normal_z() const;
    // z         mm, of a place of the part
    // normal_z  of its upward unit normal
    bool holds(double z, double normal_z) const;
};

// Each strategy takes the keys that it knows; the others keep these values.
struct FinishKeys {
    std::optional<double> iso_distance;  // mm; none: by the scallop
    bool even_steps{false};  // iso_spacing = "even": full steps, not the paper's halving
    char direction{'u'};     // or 'v'; of planes along x or y
    double plane_angle{0};   // degrees: planes are turned by that, counter-clockwise
    bool spiral{false};      // levels: loops above each other are one way down
    double steep_from{45};   // degrees: levels from there on, planes below
    GroundRange range;
};

template <class AnyOperation>
decltype(auto) finish_keys(AnyOperation& operation)
{
    return parameters_of<FinishKeys>(operation);
}

// True if boundary and islands limit the ground that the operation finishes; those of others are walls of what
// it clears.
bool finishes_ground(const Operation& operation);

// The range of the operation; everything where its strategy has no such keys.
GroundRange ground_range_of(const Operation& operation);

// Along which way passes run.
Key direction_key();

// The keys, and `slopes` and `heights`.
std::vector<Key> with_ranges(std::vector<Key> keys);
// The values of these two. Errors: `refuse` where a range is none.
GroundRange read_range(const KeyValues& values, const Refuse& refuse);

}  // namespace cusp::job
