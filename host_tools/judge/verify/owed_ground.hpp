// The ground that the operations of a job owe: all of the part, or what their areas hold.
#pragma once

#include <vector>

#include "host_tools/job/job/finish_keys.hpp"
#include "host_tools/judge/verify/wall_distance.hpp"

namespace cusp::verify {

// Operations that finish surfaces may be for an area: inside a boundary, outside islands, of a range of
// slopes and heights. Ground is owed where one of them is for it. A pocket owes all: its walls limit it.
class OwedGround {
public:
    // The operations with a scallop, where there are some; else all.
    explicit OwedGround(const job::Job& job);

    // place     of the part
    // normal_z  of its upward unit normal
    bool holds(Vec3d place, double normal_z) const;

private:
    struct Area {
        std::vector<WallDistance> walls;
        job::GroundRange range;
    };
    std::vector<Area> areas_;  // none: everything
};

}  // namespace cusp::verify
