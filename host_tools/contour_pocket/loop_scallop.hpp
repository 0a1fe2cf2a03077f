// The highest scallop that two neighbouring rings of loops leave in the strip between them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/contour_pocket/height_bounds.hpp"
#include "host_tools/contour_pocket/pocket_task.hpp"
#include "host_tools/contour_pocket/tip_segment.hpp"
#include "host_tools/drop_cutter/drop_cutter.hpp"

namespace cusp::contour_pocket {

class LoopScallop {
public:
    LoopScallop(const drop_cutter::DropCutter& floor,
                const std::vector<nurbs::Surface>& surfaces,
                const ToleranceSplit& tolerances);

    // The largest scallop of the strip, square to the floor, over the surface that the tool could
    // cut by passing everywhere; as a share of the height allowed between passes.
    //
    // Where bounds of the floor's slope and bend prove that no scallop within half the strip's
    // width of a pass is too high (HeightBounds, balls only), nothing is sampled: every place lies
    // so near to a pass (clear_region()).
    //
    // Every place of the strip lies on a line straight inward from the outer ring. Such lines are a
    // sixth of the tool's radius apart (less under a flat bottom). They are closer where the
    // scallop changes and, for tools with a flat bottom, where the passes turn level: there they
    // leave steps. On each line the floor is looked up at the contacts of evenly spaced tool
    // positions, and compared with what both rings' paths cut there. Ends of lines that meet others
    // are sampled too.
    double relative_scallop(const clearing::LoopStrip& strip);

    // How far inward from the level the next one may lie so that relative_scallop() is 1 at most by
    // those bounds alone, mm; 0 where they prove nothing.
    double proven_stepover(const offset::Region2d& level) const;

    // How far apart along a straight way two of the tip's heights and slopes may be known so that
    // the cubic through them is `max_error` (mm) from the true height at most, by those bounds; 0
    // where they prove nothing.
    double lookup_spacing(const offset::Region2d& region, double max_error) const;

    // True where those bounds prove that the ball reaches all of the floor around the region: no
    // valley is bent tighter than it.
    bool reaches_floor(const offset::Region2d& region) const;

    // Place by place, for partial loops. begin() takes the strip, add() the paths that are cut
    // between its rings, too. Then stretches() finds the parts of edges of the outer ring from
    // which lines inward meet too high a scallop, `from` to `to` (mm) from the contours.
    //
    // Here the scallop's height is measured along the axis: on steep floors that is more.
    void begin(const clearing::LoopStrip& strip);
    void add(const std::vector<clearing::PartialLoop>& loops);
    std::vector<offset::Edge> stretches(const std::vector<offset::Edge>& edges,
                                        const clearing::LoopStrip& strip,
                                        double from,
                                        double to);

private:
    static constexpr int kPlaces = 8;  // on a way, at most
    struct Probe {
        Vec2d at;
        double tip;  // z
        Vec2d touched;
        std::optional<double> floor;  // z of the contact; none where no surface lies under the tool
        Vec2d gradient;
        double secant;
    };
    // A line inward from a place of an edge.
    struct CrossLine {
        double along;  // share of the edge
        double share;  // of the height allowed, the most on it
        double climb;  // slope of the tip's height along the edge
        std::array<Probe, kPlaces + 1> probes{};
        int count{0};  // of them that were looked at
    };
    // What ways are laid for: the strip, or with partial loops the part of it from `foot` mm off
    // its outer level on.
    struct Look {
        const clearing::LoopStrip& strip;
        double foot;
        double step;     // mm: how long ways are
        bool stretches;  // for partial loops
    };
    void look_closely(double step);
    void set_paths(const offset::Region2d& level, double step);
    void sort_segments(double cell);
    CrossLine cross_line(const offset::Edge& edge, double along, const Look& look) const;
    struct Corners {
        bool before, after;
    };
    std::vector<double> places_along(const offset::Edge& edge, Corners corners, double step) const;
    double cross_lines_along(const offset::Edge& edge, Corners corners, const Look& look) const;
    void stretches_on(const offset::Edge& edge,
                      const Look& look,
                      std::vector<offset::Edge>& found) const;
    double between(const offset::Edge& edge,
                   const CrossLine& a,
                   const CrossLine& b,
                   const Look& look) const;
    Vec2d inside_rim(Vec2d at, Vec2d touched) const;
    Probe probe(Vec2d at) const;
    double allowed(double secant) const;
    double uncut(const Probe& probe, bool stretches) const;
    bool clear_square_to(const Probe& probe) const;
    struct Lowest {
        Vec2d at;
        double height;  // of the tip: z
    };
    static Lowest where_sides_meet(const Probe& a, const Probe& b);
    double left_under(const Probe& a, const Probe& b) const;
    double left_under_foot(const Probe& a, const Probe& b) const;
    double left_between(const Probe& a, const Probe& b) const
    {
        return ball_ ? left_under(a, b) : left_under_foot(a, b);
    }
    double left_beside(const CrossLine& a, const CrossLine& b) const;
    double left_at(Vec2d at, Vec2d near) const;

    double proven(const offset::Box2d& level, double step) const;
    double proven(const BendBounds& bounds) const;

    const drop_cutter::DropCutter& floor_;
    const ToleranceSplit& tolerances_;
    bool ball_;
    double apart_;  // mm between ways, at most
    HeightBounds bounds_;
    std::vector<TipSegment> segments_;
    offset::Box2d field_{};
    double cell_{};
    int columns_{};
    int rows_{};
    std::vector<std::vector<std::uint32_t>> cells_;
    int places_{3};     // on a way from one level to the other
    double strayed_{};  // what of a ridge's height moves beside their paths leave allowed
};

}  // namespace cusp::contour_pocket
