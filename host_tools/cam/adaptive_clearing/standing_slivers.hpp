// Slivers that passes leave: they stand as high as before, whatever the height of the level around them.
//
//     StandingSlivers slivers;
//     slivers.add(path, 0.0);               // a level that was cut from z = 0
//     slivers.top_at({20, 5}, 3.0, -4.0);   // z: 0 beside a sliver, else -4
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"

namespace cusp::adaptive_clearing {

class StandingSlivers {
public:
    // The slivers of a path.
    //
    // above        z: stock began there at most
    // tool_radius  mm
    void add(const AdaptivePath& path, double tool_radius, double above);

    // z: stock begins there at most under a tool (radius in mm) at a place, where it begins at `above`
    // beside slivers.
    double top_at(Vec2d place, double tool_radius, double above) const;

private:
    struct Sliver {
        Vec2d at;
        double top;  // z
    };
    std::vector<Sliver> slivers_;
};

// The region of the tool's centre without the places from which the tool meets a sliver of the path.
offset::Region2d off_slivers(const offset::Region2d& region,
                             const AdaptivePath& path,
                             double tool_radius);

}  // namespace cusp::adaptive_clearing
