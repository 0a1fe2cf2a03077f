// Broken edges of a solid: bands of even slope beside what stands above a height, as chamfers and countersinks are.
#pragma once

#include <array>
#include <vector>

#include "host_tools/geometry/offset/edge_tree.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/job/import/part_regions.hpp"

namespace cusp::import {

// The ways of a vee's tip beside the edges of a band that it breaks.
struct EdgeWays {
    std::vector<std::vector<offset::Edge>> ways;  // a closed one ends where it begins
    double broken{};                              // mm: length of the edges that they are beside
    Vec2d left_at;                                // on another edge of the band, if there is one
};

class SolidEdges {
public:
    // facets  of the whole part
    explicit SolidEdges(const std::vector<std::array<Vec3d, 3>>& facets);

    // Bands with closed loops or with parts of them, the highest first.
    std::vector<EdgeBand> bands() const;

    // The edges of a band, whole loops and parts of them.
    struct Survey {
        std::size_t count{};
        double length{};   // mm
        bool has_parts{};  // of loops
        Vec2d place;       // on one of them, a part if there is one
    };
    Survey survey(const EdgeBand& band) const;

    // The tip runs kChamferTip beside the lower edges, where the ground rises evenly and the tool gouges nothing.
    EdgeWays ways(const EdgeBand& band, const toolpath::Tool& vee) const;

    // The lower edges of a band, with the material on their left. Beside all of a loop the ground rises evenly.
    offset::Region2d loops(const EdgeBand& band) const;

    // True if the tool gouges nothing of the part, its tip at `z` along the contours.
    bool is_clear(const toolpath::Tool& tool, const offset::Region2d& centres, double z) const;
    bool is_clear(const toolpath::Tool& tool, Vec2d at, double z) const;

private:
    // A look from a lower edge to the material.
    struct Look {
        Vec2d foot;
        Vec2d across;  // unit
        double step;   // mm: length of the edge that it stands for
    };
    // The ground beside a lower edge: whether it rises as the band does, and so on below it and over it.
    struct Rise {
        bool evenly;
        bool on_below;
        bool on_above;
    };
    static std::vector<Look> looks_along(const offset::Contour& loop);
    Rise rise_at(const Look& look, const offset::EdgeTree& tree, const EdgeBand& band) const;
    // Looks in the order of a loop that see an edge of the band: in rows that are no part of a longer slope.
    std::vector<bool> on_band(const std::vector<Look>& looks,
                              const offset::EdgeTree& tree,
                              const EdgeBand& band) const;
    offset::Region2d standing(double z) const;
    bool rises_beside(const offset::Contour& loop, const EdgeBand& band) const;
    bool is_ground(Vec2d at, double z) const;

    const std::vector<std::array<Vec3d, 3>>& facets_;
    part_model::PartModel model_;
};

// True if the facet is ground of the band.
class BandGround {
public:
    // edges   lower ones, or the ways of a tip
    // beside  mm: from them to the lower edges
    BandGround(const EdgeBand& band, const std::vector<offset::Edge>& edges, double beside);
    bool has(const std::array<Vec3d, 3>& facet) const;

private:
    EdgeBand band_;
    double reach_;  // mm
    offset::EdgeTree tree_;
};

}  // namespace cusp::import
