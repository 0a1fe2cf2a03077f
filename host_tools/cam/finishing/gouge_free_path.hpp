// From dense points of the tool tip to few lines, arcs or one NURBS, each move proved free of
// gouges.
//
//     GougeFreePathFitter fitter{model, tool, make_tolerance_band(0.01, true)};
//     const Points dense = fitter.sample_dropped({0, 0, 0}, {40, 0, 0});
//     const Points path = fitter.fit_lines(dense);
//     fitter.least_clearance();  // >= 0: no move of the path cuts into the model
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "host_tools/geometry/part_model/edge_gouge_check.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::finishing {

class FinishArea;

// The parts of a tolerance, mm. The tip is planned `offset` off the surface, and the path may
// deviate from the planned one by `half_width`.
struct ToleranceBand {
    double offset{};
    double half_width{};
    // How deep the tool may cut into the model: 0 for a one-sided tolerance; < 0: it keeps off by that.
    double max_gouge{};
};

// One-sided: the tool never cuts into the model and stays within `tolerance` of it; a fifth of the
// tolerance is reserved for the proof. Two-sided: half the tolerance each way.
ToleranceBand make_tolerance_band(double tolerance, bool one_sided);

using Points = std::vector<Vec3d>;

// The contact of a tip over surfaces: the ball is `offset` off the surface there, along the normal, within a
// fiftieth of the band. Ends of lines are exact.
struct CcParameters {
    int surface{-1};  // -1: not known
    double u{};
    double v{};
};
using CcParameterList = std::vector<CcParameters>;  // one per dense point; empty: none is known

// Not for use by two threads at once, const members aside; copies are cheap.
class GougeFreePathFitter {
public:
    GougeFreePathFitter(const part_model::PartModel& model,
                        const toolpath::Tool& tool,
                        const ToleranceBand& band);

    // From this call on, moves gouge no rim or crease of the surfaces from the side, where a
    // two-sided tolerance lets them cut into faces; see `EdgeGougeCheck`.
    void check_edge_gouges(const std::vector<nurbs::Surface>& surfaces);

    // From this call on, proofs of the scallop over the model are for that part of it.
    void limit_to(std::shared_ptr<const FinishArea> area) { area_ = std::move(area); }
    const FinishArea& area() const { return *area_; }

    // The points, moved off edges that the tool would gouge from the side, so far that no point
    // within the band gouges them.
    Points moved_clear_of_edges(const Points& dense) const;

    // The tip, raised until it gouges no edge from the side.
    part_model::EdgeGougeCheck::RaisedTip raised_clear_of_edges(Vec3d tip) const;

    // True if a straight move gouges no edge from the side.
    bool clears_edges(Vec3d a, Vec3d b) const;

    const ToleranceBand& band() const { return band_; }
    const toolpath::Tool& tool() const { return tool_; }
    // The tool grown by the band's offset.
    const toolpath::Tool& offset_tool() const { return offset_tool_; }
    const part_model::PartModel& model() const { return model_; }

    // mm: the clearance that moves need; > 0 for a tool without a corner radius, whose depth nothing
    // measures.
    double least_allowed() const;

    // True if the tool is at least `offset` off the whole model.
    bool is_clear(Vec3d tip) const;

    // True if the tool whose contact is (u, v), `offset` off it, is no nearer to anything else.
    bool is_clear_at_contact(int surface, double u, double v) const;
    bool is_clear_at_contact(const part_model::CcPoint& at) const;

    // The tip of the tool that is `offset` off the surface at (u, v), along the normal.
    Vec3d tip_at(int surface, double u, double v) const;

    // The tip dropped at (x, y), `offset` off the model; none where the tool misses the model.
    std::optional<Vec3d> drop(double x, double y) const;

    // Samples a function that gives the tip at a parameter, so densely that straight lines between
    // the points deviate from it by a small part of the band only.
    //
    // at          tip at a parameter
    // breaks      parameters in order, first and last included; features narrower than a quarter
    //             of their distance may be missed
    // deepest     halvings between two breaks; fewer for a function with jumps, since a jump is
    //             refined down to the last one
    // parameters  if given, those of the points are appended
    Points sample(const std::function<Vec3d(double)>& at,
                  const std::vector<double>& breaks,
                  int deepest = 12,
                  std::vector<double>* parameters = nullptr) const;

    // Samples tips dropped along the straight line from a to b in plan; beside the model they have
    // the lower height of the two ends.
    //
    // cc_parameters  if given, the contacts of the points are appended
    Points sample_dropped(Vec3d a, Vec3d b, CcParameterList* cc_parameters = nullptr) const;

    // A polyline of few points within the band of the dense one, proved. If a line would cut
    // deeper than allowed, the tip is raised by a drop. With contacts the proof usually needs only
    // the curvature of the surface there, without a search.
    Points fit_lines(const Points& dense, const CcParameterList& cc_parameters = {});

    // The part of a loop on several threads that uses this from now on: fit_lines() begins the next one
    // between lines, now and then. Other threads would wait for a pass of metres before they release
    // cells.
    void set_part(const part_model::PartModel::SharedQueries::Part& queries)
    {
        queries_ = &queries;
    }

    // As fit_lines(), without raising any tip; none where a line would cut or that is not proved.
    std::optional<Points> fit_clear_lines(const Points& dense,
                                          const CcParameterList& cc_parameters);

    // The tip itself where the tool is clear there, else raised onto the model.
    Vec3d raised_clear(Vec3d tip) const;

    // Arcs and lines within the band of the dense polyline, starting at its first point, proved.
    // If an arc would cut, lines as by fit_lines() replace it.
    std::vector<toolpath::ToolMove> fit_arcs(const Points& dense);

    // One cubic NURBS through the points, from first to last, proved; none where it would cut.
    // Its knots are arc lengths, so a constant feed has a smooth speed along it.
    std::optional<nurbs::Curve> fit_nurbs(const Points& dense);

    // True if the cubic curve is proved to cut no deeper than allowed. If so, least_clearance()
    // includes it.
    bool is_nurbs_clear(const nurbs::Curve& curve);

    // True if the straight move is proved to cut no deeper than allowed. If so, least_clearance()
    // includes it.
    bool is_line_clear(Vec3d a, Vec3d b);

    // The least clearance (mm) proved for all moves returned; negative: a gouge within the band.
    double least_clearance() const { return least_clearance_; }
    // Includes moves that a copy returned, by its least_clearance().
    void include_moves_with(double least_clearance);

private:
    bool is_arc_clear(Vec3d start, const toolpath::ToolMove& arc);
    bool is_move_between_contacts_clear(const part_model::CcPoint& a, const part_model::CcPoint& b);
    part_model::CcPoint cc_point(const CcParameters& cc) const;
    Vec3d tip_of(const part_model::CcPoint& at) const;
    // The last dense point to which one straight line from `from` fits.
    std::size_t chord_end(const Points& dense, std::size_t from, std::size_t guess) const;
    void append_clear_line(Vec3d a, Vec3d b, int depth, Points& out);
    bool is_curve_clear(const std::array<Vec3d, 4>& bezier, int depth, double& least) const;

    const part_model::PartModel& model_;
    toolpath::Tool tool_;
    toolpath::Tool offset_tool_;
    ToleranceBand band_;
    std::shared_ptr<const part_model::EdgeGougeCheck> edges_;
    std::shared_ptr<const FinishArea> area_;
    double least_clearance_{};
    const part_model::PartModel::SharedQueries::Part* queries_{nullptr};
};

double length_of(const Points& points);

}  // namespace cusp::finishing
