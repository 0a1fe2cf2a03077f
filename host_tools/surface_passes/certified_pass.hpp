// Turns dense points of the tool tip into few lines or one NURBS, each proved to keep the tool out
// of the model.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/surface_offset/edge_guard.hpp"
#include "host_tools/surface_offset/surface_model.hpp"

namespace cusp::host {

// How the allowance for the path is spent, mm. The tip is planned `lift` too far from the surface;
// the path may leave the planned one by `band` either way.
struct PassBand {
    double lift{};
    double band{};
    double deepest{};  // how far the tool may cut into the model: 0 for a one-sided tolerance
};

// One-sided: the tool never enters the model and stays within `tolerance` of it, with a fifth of
// the tolerance kept for the proof. Both sides: half the tolerance each way.
PassBand make_pass_band(double tolerance, bool one_sided);

using Points = std::vector<Vec3d>;

// A place of a surface that the tool touches: it stands `lift` off it, square, to a fiftieth of the
// band. Ends of lines are exactly over theirs.
struct Foot {
    int surface{-1};  // -1: not known
    double u{};
    double v{};
};
using Feet = std::vector<Foot>;  // one a dense point; empty: none is known

class CertifiedPasses {
public:
    CertifiedPasses(const SurfaceModel& model, const Tool& tool, const PassBand& band);

    // Keeps moves from cutting into rims and creases of the surfaces from beside, where a two-sided
    // tolerance lets them cut into faces; see `EdgeGuard`.
    void guard_edges(const std::vector<Surface>& surfaces);

    // The points, moved off guarded edges that the tool would meet from beside, so that nothing
    // within the band of them cuts into those.
    Points kept_off_edges(const Points& dense) const;

    // The tip, raised so far that it is not moved off guarded edges.
    EdgeGuard::Raised raised_off_edges(Vec3d tip) const;

    // Whether a straight move cuts into no guarded edge from beside.
    bool spares_edges(Vec3d a, Vec3d b) const;

    const PassBand& band() const { return band_; }
    const Tool& tool() const { return tool_; }
    // The tool grown by what passes stay off the model.
    const Tool& lifted_tool() const { return lifted_; }
    const SurfaceModel& model() const { return model_; }

    // Whether a tool that stands `lift` off some surface is no nearer to any other.
    bool stands_free(Vec3d tip) const;

    // The same for the tool that touches the surface at (u, v).
    bool touches_freely(int surface, double u, double v) const;
    bool touches_freely(const Contact& at) const;

    // The tip of the tool that stands `lift` off the surface at (u, v), square to it.
    Vec3d tip_at(int surface, double u, double v) const;

    // Tip at (x, y), `lift` off the model; none where the tool misses the model.
    std::optional<Vec3d> dropped(double x, double y) const;

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
    // feet  where the tool touches at the points, where wanted
    Points sample_dropped(Vec3d a, Vec3d b, Feet* feet = nullptr) const;

    // Few points of a polyline within the band of the dense one, proved: where a line would cut
    // deeper than allowed, the tip is lifted on the drop. With feet the proof is mostly a matter of
    // the surface's bend there, without a search.
    Points fit_lines(const Points& dense, const Feet& feet = {});

    // The same where the tool is free at every point and between all of them; none where it is not
    // or that is not proved.
    std::optional<Points> fit_free_lines(const Points& dense, const Feet& feet);

    // The tip itself where the tool stands free there, else on the model over it.
    Vec3d lifted_free(Vec3d tip) const;

    // Arcs and lines within the band of the dense polyline, from its first point on, proved; where
    // an arc would cut, lines as `fit_lines` makes them.
    std::vector<ToolMove> fit_arcs(const Points& dense);

    // One cubic NURBS along the points, from first to last, proved; none where it would cut.
    // Knots are arc lengths: a constant feed runs smoothly through it.
    std::optional<Curve> fit_nurbs(const Points& dense);

    // Whether the curve (cubic) is proved to cut no deeper than allowed; lowers `least_clearance`
    // if so.
    bool nurbs_is_free(const Curve& curve);

    // Whether the straight move is proved to cut no deeper than allowed; lowers `least_clearance`
    // if so.
    bool line_is_free(Vec3d a, Vec3d b);

    // The least clearance proved of all that was returned; negative: a gouge.
    double least_clearance() const { return least_clearance_; }

private:
    bool arc_is_free(Vec3d start, const ToolMove& arc);
    bool rolls_freely(const Contact& a, const Contact& b);
    Contact contact(const Foot& foot) const;
    Vec3d tip_of(const Contact& at) const;
    // The last point that a straight line from another fits the points up to.
    std::size_t chord_end(const Points& dense, std::size_t from, std::size_t guess) const;
    void append_free_line(Vec3d a, Vec3d b, int depth, Points& out);
    bool curve_is_free(const std::array<Vec3d, 4>& bezier, int depth, double& least) const;

    const SurfaceModel& model_;
    Tool tool_;
    Tool lifted_;
    PassBand band_;
    std::optional<EdgeGuard> edges_;
    double least_clearance_{};
};

double length_of(const Points& points);

}  // namespace cusp::host
