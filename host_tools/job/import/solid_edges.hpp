// Broken edges of a solid: bands of even slope beside what stands above a height, as chamfers and countersinks are.
#pragma once

#include <array>
#include <vector>

#include "host_tools/geometry/offset/edge_tree.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/job/import/part_regions.hpp"

namespace cusp::import {

class SolidEdges {
public:
    // facets  of the whole part
    explicit SolidEdges(const std::vector<std::array<Vec3d, 3>>& facets);

    // Those with closed loops, the highest first.
    std::vector<EdgeBand> bands() const;

    // The lower edges of a band, with the material on their left. Beside all of a loop the ground rises evenly.
    offset::Region2d loops(const EdgeBand& band) const;

    // True if the tool gouges nothing of the part, its tip at `z` along the contours.
    bool is_clear(const toolpath::Tool& tool, const offset::Region2d& centres, double z) const;

private:
    offset::Region2d standing(double z) const;
    bool rises_beside(const offset::Contour& loop, const EdgeBand& band) const;
    bool is_ground(Vec2d at, double z) const;

    const std::vector<std::array<Vec3d, 3>>& facets_;
    part_model::PartModel model_;
};

// True if the facet is ground of the band.
class BandGround {
public:
    BandGround(const EdgeBand& band, const offset::Region2d& loops);
    bool has(const std::array<Vec3d, 3>& facet) const;

private:
    EdgeBand band_;
    offset::EdgeTree tree_;
};

}  // namespace cusp::import
