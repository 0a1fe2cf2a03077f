// The highest scallop between two neighbouring rings of loops.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/cam/contour_pocket/height_bounds.hpp"
#include "host_tools/cam/contour_pocket/pocket_task.hpp"
#include "host_tools/cam/contour_pocket/tip_segment.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"

namespace cusp::contour_pocket {

class LoopScallop {
public:
    LoopScallop(const drop_cutter::DropCutter& floor,
                const std::vector<nurbs::Surface>& surfaces,
                const ToleranceSplit& tolerances);

    // The largest scallop of the strip, along the normal, over the surface that the tool can cut;
    // as a share of the height allowed between passes.
    //
    // For balls, HeightBounds may prove that no scallop is too high within half the strip's width
    // of a pass. Every place of the strip is that near to a pass (clear_region()), so nothing is
    // sampled then.
    //
    // Else the strip is sampled on lines straight inward from the outer ring, at most a sixth of
    // the tool's radius apart (less for flat bottoms). They are denser where the scallop changes
    // and, for flat bottoms, where the passes become level, since steps are left there. On each
    // line the floor is computed at the contacts of evenly spaced tool positions, and compared with
    // the cut of both rings' paths. The ends of lines that meet others are sampled too.
    double relative_scallop(const clearing::LoopStrip& strip);

    // mm: how far inward from the ring the next one may lie so that HeightBounds alone prove a
    // relative_scallop() of at most 1; 0 where they prove nothing.
    double proven_stepover(const offset::Region2d& ring) const;

    // mm: how far apart along a straight line the tip's heights and slopes may be computed so that
    // the cubic through them is within `max_error` (mm) of the true height, by HeightBounds; 0
    // where they prove nothing.
    double lookup_spacing(const offset::Region2d& region, double max_error) const;

    // True where HeightBounds prove that the ball reaches all of the floor around the region: no
    // valley has a radius below the ball's.
    bool reaches_floor(const offset::Region2d& region) const;

    // For partial loops. begin() takes the strip, add() the paths cut between its rings. Then
    // stretches() finds the parts of edges of the outer ring from which cross lines meet too high a
    // scallop, `from` to `to` (mm) from the contours.
    //
    // Here the scallop is measured along the axis: on steep floors that is more.
    void begin(const clearing::LoopStrip& strip);
    void add(const std::vector<clearing::PartialLoop>& loops);
    std::vector<offset::Edge> stretches(const std::vector<offset::Edge>& edges,
                                        const clearing::LoopStrip& strip,
                                        double from,
                                        double to);

private:
    static constexpr int kPlaces = 8;  // on a cross line, at most
    struct Probe {
        Vec2d at;
        double tip;  // z
        Vec2d touched;
        std::optional<double> floor;  // z of the contact; none where no surface lies under the tool
        Vec2d gradient;
        double secant;
    };
    // A line inward from a point of an edge.
    struct CrossLine {
        double along;  // share of the edge
        double share;  // largest share of the allowed height on it
        double climb;  // slope of the tip's height along the edge
        std::array<Probe, kPlaces + 1> probes{};
        int count{0};  // of valid probes
    };
    // The search of one edge: the strip, or for partial loops the part of it from `foot` mm off its
    // outer ring on.
    struct Search {
        const clearing::LoopStrip& strip;
        double foot;
        double step;     // mm: length of cross lines
        bool stretches;  // for partial loops
    };
    void set_resolution(double step);
    void set_paths(const offset::Region2d& ring, double step);
    void sort_segments(double cell);
    CrossLine cross_line(const offset::Edge& edge, double along, const Search& search) const;
    struct Corners {
        bool before, after;
    };
    std::vector<double> places_along(const offset::Edge& edge, Corners corners, double step) const;
    double cross_lines_along(const offset::Edge& edge, Corners corners, const Search& search) const;
    void stretches_on(const offset::Edge& edge,
                      const Search& search,
                      std::vector<offset::Edge>& found) const;
    double between(const offset::Edge& edge,
                   const CrossLine& a,
                   const CrossLine& b,
                   const Search& search) const;
    Vec2d inside_rim(Vec2d at, Vec2d touched) const;
    Probe probe(Vec2d at) const;
    double allowed(double secant) const;
    double uncut(const Probe& probe, bool stretches) const;
    bool is_low_along_normal(const Probe& probe) const;
    struct Lowest {
        Vec2d at;
        double height;  // of the tip: z
    };
    static Lowest where_sides_meet(const Probe& a, const Probe& b);
    double left_under(const Probe& a, const Probe& b) const;
    double left_under_flat(const Probe& a, const Probe& b) const;
    double left_between(const Probe& a, const Probe& b) const
    {
        return ball_ ? left_under(a, b) : left_under_flat(a, b);
    }
    double left_beside(const CrossLine& a, const CrossLine& b) const;
    double highest_between(const std::array<double, kPlaces + 1>& found, std::size_t n) const;
    double left_at(Vec2d at, Vec2d near) const;

    double proven(const offset::Box2d& passes, double step) const;
    double proven(const part_model::BendBounds& bounds) const;

    const drop_cutter::DropCutter& floor_;
    const ToleranceSplit& tolerances_;
    bool ball_;
    double apart_;  // mm: largest distance of cross lines
    HeightBounds bounds_;
    std::vector<TipSegment> segments_;
    offset::Box2d field_{};
    double cell_{};
    int columns_{};
    int rows_{};
    std::vector<std::vector<std::uint32_t>> cells_;
    int places_{3};           // on a cross line from one ring to the other
    double scallop_share_{};  // of a scallop, after deviations of moves from their paths
};

}  // namespace cusp::contour_pocket
