// One side of a facet that is vertical or nearly so: where passes of a ball leave stock beside it
// that the ball's side or shank could remove, and the passes along it that do.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/cam/finishing/wall_facet.hpp"

namespace cusp::finishing {

// Columns of the wall are looked at one by one. A move removes stock all the way up. So only the
// lowest place of a vertical column counts that a ball reaches while it rests on the part: with its
// side, from an axis the radius off the wall. A ball with nothing below it is not asked for: it
// would go down beside the part without end.
//
// The lower side of a wall that leans lies under its upper end. Only the part of a column that
// overhangs by at most 2e-4 mm is checked; no ball reaches the rest.
//
// Between two columns one move proves the wall, if it removes all four ends of what is reached.
// Reach is bounded between columns: a ball smaller by their distance rests no higher in the middle
// than the ball itself does anywhere between. If that proves nothing, reach is sampled a sixteenth
// of a stepover apart, and not proved between the samples. If one column is too high for the ball
// and the next has nothing below it, the place between them is searched.
class WallSide {
public:
    // Places around which no ball reaches a wall below some height, or none that rests on something:
    // behind a wall, and beside the part. The last few that were found.
    class KnownReach {
    public:
        // True if no centre within `away` (mm, in plan) of the place is below `top`, or rests.
        bool holds(Vec3d place, double away, double top) const;
        // lowest  z of the lowest centre within `wide` of the place; kInfinite: none rests
        void add(Vec3d place, double wide, double lowest);

    private:
        struct Spot {
            Vec2d place;
            double wide{-1};
            double lowest{};
        };
        std::array<Spot, 8> spots_{};
        std::size_t next_{0};
    };

    // turned  whether the side behind the facet is looked at
    // fitter  kept while the wall is used
    WallSide(const WallFacet& facet, bool turned, const GougeFreePathFitter& fitter);

    // A stretch along the wall where stock is left.
    struct Run {
        double from;   // mm along the wall
        double to;     // the same
        double level;  // where on a leaning wall: 0 the lowest place reached, 1 the top
    };
    // known  of this or other walls of the model, looked at with the same tool
    std::vector<Run> missing_runs(const ScallopAtPoint& places, KnownReach& known) const;

    // Tips along the wall that remove what is left in a run.
    Points pass_along(const Run& run) const;

    // mm: the stock left in a run, square to the wall; at most the radius.
    double left_in(const Run& run, const ScallopAtPoint& places) const;

    const std::vector<Vec3d>& corners() const { return corners_; }
    double begin() const { return begin_; }  // mm along the wall
    double end() const { return end_; }
    Vec3d out() const { return out_; }  // unit

    // A place of the wall.
    Vec3d place_at(double along) const { return point_at(along, whole_column_at(along).top); }
    // The centre of a ball that touches the upper end of the wall at a place along it.
    Vec3d centre_at_top(double along) const;
    // True if something lies below a ball there that is smaller by a tenth; a ball that touches the
    // wall takes a hundred times as long.
    bool rests(Vec3d centre) const;

private:
    // The reached part of a column.
    struct Column {
        double along;  // mm
        double low;    // z, mm
        double top;
        bool to_bottom;  // of the facet: nothing lower could be reached on it
        bool rests;      // something lies below the ball

        bool is_reached() const { return low < top; }
        double at(double level) const { return low + level * (top - low); }
    };
    Column whole_column_at(double place) const;
    Column column_at(double place) const;
    Vec3d point_at(double along, double z) const;
    Vec3d out_at(double along) const;
    Vec3d centre_beside(double along, double z) const;
    std::optional<double> drop_centre(Vec3d over, double radius) const;
    std::optional<double> rest_beside(double along, double z) const;
    bool is_reached(double along, double z) const;
    double end_of_reach(double reached, double beside) const;
    std::optional<double> missing_level(const Column& column, const ScallopAtPoint& places) const;
    bool one_move_cuts(const Column& a, const Column& b, const ScallopAtPoint& places) const;
    std::vector<double> first_places(double step) const;
    bool is_unreached(Vec3d centre, double away, double top, KnownReach& known) const;
    bool is_cut_between(
        double from, double to, bool far, const ScallopAtPoint& places, KnownReach& known) const;
    void look_over(double from,
                   double to,
                   int tries,
                   const ScallopAtPoint& places,
                   KnownReach& known,
                   std::vector<Run>& out) const;
    void look_between(const Column& a,
                      const Column& b,
                      const ScallopAtPoint& places,
                      std::vector<Run>& out) const;

    std::vector<Vec3d> corners_;
    Vec3d out_;
    double bend_;    // of the normal to this side
    double middle_;  // mm along the wall
    double off_;     // mm
    double beside_;  // mm: how far the ball keeps off besides the band's offset
    Vec3d along_;    // level, unit
    Vec3d upward_;   // in the wall, by 1 mm of z
    const GougeFreePathFitter& fitter_;
    double begin_;  // mm along the wall
    double end_;
    double overhang_{};  // mm: of a column's top over the lowest place of it that is looked at
    bool leans_;
};

// Both sides of a facet that could be reached; none of a facet without height.
std::vector<WallSide> wall_sides_of(const WallFacet& facet, const GougeFreePathFitter& fitter);

}  // namespace cusp::finishing
