// Level curves of the tool: loops in which it touches the part with its tip at a height.
//
//     const LevelCurves curves{work, area};
//     for (const LevelLoop& loop : curves.at(-4.0)) { ... }   // loop.places: in cutting order
#pragma once

#include <vector>

#include "host_tools/cam/finishing/surface_operation.hpp"
#include "host_tools/cam/steep_shallow/section_step.hpp"
#include "host_tools/geometry/waterline_slices/waterline_slices.hpp"

namespace cusp::steep_shallow {

// The tool at a place of a level.
struct LevelPlace {
    Vec3d tip;
    double step{};   // mm: to the next level, by the scallop; 0 on level ground
    bool in_area{};  // touches ground of the area, and rests on the part or leans on a slope
};

// A closed loop, its last place beside the first one. Climb cutting: the part is to the right.
struct LevelLoop {
    std::vector<LevelPlace> places;

    double z() const { return places.front().tip.z; }
    double length() const;  // mm, of what is in the area
};

class LevelCurves {
public:
    // work, area, step  kept
    LevelCurves(const finishing::SurfaceOperation& work,
                const finishing::FinishArea& area,
                const SectionStep& step);

    // The loops with some place in the area; several threads take part.
    std::vector<LevelLoop> at(double z) const;

    // The tool moved level from nearby to where it touches the part.
    Vec3d touching(Vec2d near, double z) const { return touch(near, z).tip; }

    double pitch() const { return slices_.pitch(); }  // mm, about that of places

private:
    struct Touch {
        Vec3d tip;
        part_model::NearestPoint nearest;
        Vec3d lean;  // unit, from there into the tool; zero where it touches nothing
    };
    Touch touch(Vec2d near, double z) const;
    LevelPlace place_at(Vec2d near, double z) const;
    bool rests(Vec3d tip) const;
    bool faces(Vec3d tip) const;

    const finishing::SurfaceOperation& work_;
    const finishing::FinishArea& area_;
    const SectionStep& step_;
    waterline_slices::WaterlineSlices slices_;
};

}  // namespace cusp::steep_shallow
