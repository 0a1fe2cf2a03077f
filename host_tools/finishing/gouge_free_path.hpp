// Dense points of the tool tip to few lines, arcs or one NURBS, each proved to be free of gouges.
//
//     GougeFreePathFitter fitter{model, tool, make_tolerance_band(0.01, true)};
//     const Points dense = fitter.sample_dropped({0, 0, 0}, {40, 0, 0});
//     const Points path = fitter.fit_lines(dense);
//     fitter.least_clearance();  // >= 0: no move of the path cuts into the model
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/part_model/edge_gouge_check.hpp"
#include "host_tools/part_model/part_model.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::finishing {

// How the allowance for the path is spent, mm. The tip is planned `offset` too far from the
// surface; the path may leave the planned one by `half_width` either way.
struct ToleranceBand {
    double offset{};
    double half_width{};
    double max_gouge{};  // how far the tool may cut into the model: 0 for a one-sided tolerance
};

// One-sided: the tool never enters the model and stays within `tolerance` of it, with a fifth of
// the tolerance kept for the proof. Both sides: half the tolerance each way.
ToleranceBand make_tolerance_band(double tolerance, bool one_sided);

using Points = std::vector<Vec3d>;

// Where the tool touches a surface: it keeps `offset` off it, along the normal, to a fiftieth of
// the band. Ends of lines are exactly over theirs.
struct CcParameters {
    int surface{-1};  // -1: not known
    double u{};
    double v{};
};
using CcParameterList = std::vector<CcParameters>;  // one a dense point; empty: none is known

class GougeFreePathFitter {
public:
    GougeFreePathFitter(const part_model::PartModel& model,
                        const toolpath::Tool& tool,
                        const ToleranceBand& band);

    // Keeps moves from cutting into rims and creases of the surfaces from beside, where a two-sided
    // tolerance lets them cut into faces; see `EdgeGougeCheck`.
    void check_edge_gouges(const std::vector<nurbs::Surface>& surfaces);

    // The points, moved off edges that the tool would gouge from the side, so that nothing within
    // the band of them does.
    Points moved_clear_of_edges(const Points& dense) const;

    // The tip, raised so far that no edge moves it to the side.
    part_model::EdgeGougeCheck::RaisedTip raised_clear_of_edges(Vec3d tip) const;

    // Whether a straight move gouges no edge from the side.
    bool clears_edges(Vec3d a, Vec3d b) const;

    const ToleranceBand& band() const { return band_; }
    const toolpath::Tool& tool() const { return tool_; }
    // The tool grown by what passes stay off the model.
    const toolpath::Tool& offset_tool() const { return offset_tool_; }
    const part_model::PartModel& model() const { return model_; }

    // Whether a tool that is `offset` off some surface is no nearer to any other.
    bool is_clear(Vec3d tip) const;

    // The same for the tool that touches the surface at (u, v).
    bool is_clear_at_contact(int surface, double u, double v) const;
    bool is_clear_at_contact(const part_model::CcPoint& at) const;

    // The tip of the tool that is `offset` off the surface at (u, v), square to it.
    Vec3d tip_at(int surface, double u, double v) const;

    // Tip at (x, y), `offset` off the model; none where the tool misses the model.
    std::optional<Vec3d> drop(double x, double y) const;

    // Points of the tip along a function of a parameter, so dense that straight lines between them
    // leave it by a small part of the band only.
    //
    // at      tip at a parameter
    // breaks  parameters in order, first and last included; nothing finer than a quarter of their
    //         distance may hide between them
    // deepest halvings between two breaks: fewer where the function jumps, since a jump, and a line
    //         along a cliff, is followed down to the last one
    // parameters  of the points, added to what is there, where wanted
    Points sample(const std::function<Vec3d(double)>& at,
                  const std::vector<double>& breaks,
                  int deepest = 12,
                  std::vector<double>* parameters = nullptr) const;

    // Tips over the straight line from a to b in plan, on the model where there is one, else at
    // the lower height of the ends.
    //
    // cc_parameters  where the tool touches at the points, where wanted
    Points sample_dropped(Vec3d a, Vec3d b, CcParameterList* cc_parameters = nullptr) const;

    // Few points of a polyline within the band of the dense one, proved: where a line would cut
    // deeper than allowed, the tip is raised by a drop. With contacts the proof is mostly a matter
    // of the surface's bend there, without a search.
    Points fit_lines(const Points& dense, const CcParameterList& cc_parameters = {});

    // The same where the tool is free at every point and between all of them; none where it is not
    // or that is not proved.
    std::optional<Points> fit_clear_lines(const Points& dense,
                                          const CcParameterList& cc_parameters);

    // The tip itself where the tool stands free there, else on the model over it.
    Vec3d raised_clear(Vec3d tip) const;

    // Arcs and lines within the band of the dense polyline, from its first point on, proved; where
    // an arc would cut, lines as `fit_lines` makes them.
    std::vector<toolpath::ToolMove> fit_arcs(const Points& dense);

    // One cubic NURBS along the points, from first to last, proved; none where it would cut.
    // Knots are arc lengths: a constant feed runs smoothly through it.
    std::optional<nurbs::Curve> fit_nurbs(const Points& dense);

    // Whether the curve (cubic) is proved to cut no deeper than allowed; lowers `least_clearance`
    // if so.
    bool is_nurbs_clear(const nurbs::Curve& curve);

    // Whether the straight move is proved to cut no deeper than allowed; lowers `least_clearance`
    // if so.
    bool is_line_clear(Vec3d a, Vec3d b);

    // The least clearance proved of all that was returned; negative: a gouge.
    double least_clearance() const { return least_clearance_; }

private:
    bool is_arc_clear(Vec3d start, const toolpath::ToolMove& arc);
    bool is_move_between_contacts_clear(const part_model::CcPoint& a, const part_model::CcPoint& b);
    part_model::CcPoint cc_point(const CcParameters& cc) const;
    Vec3d tip_of(const part_model::CcPoint& at) const;
    // The last point that a straight line from another fits the points up to.
    std::size_t chord_end(const Points& dense, std::size_t from, std::size_t guess) const;
    void append_clear_line(Vec3d a, Vec3d b, int depth, Points& out);
    bool is_curve_clear(const std::array<Vec3d, 4>& bezier, int depth, double& least) const;

    const part_model::PartModel& model_;
    toolpath::Tool tool_;
    toolpath::Tool offset_tool_;
    ToleranceBand band_;
    std::optional<part_model::EdgeGougeCheck> edges_;
    double least_clearance_{};
};

double length_of(const Points& points);

}  // namespace cusp::finishing
