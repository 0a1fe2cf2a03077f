// What passes of a ball leave over single places of a model, and the tip that would take it off.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/finishing/gouge_free_path.hpp"
#include "host_tools/finishing/lower_position_proof.hpp"
#include "host_tools/finishing/reachable_height.hpp"
#include "host_tools/finishing/swept_volume.hpp"

namespace cusp::finishing {

// Where metal may stand at most over a place, with `scallop` left. On all but steep ground it is
// measured upright and turned square: over sharp ridges that asks for more than the way along the
// normal.
Vec3d raised(Vec3d point, Vec3d normal, double scallop, bool upright);

// The centre of a ball that touches the surface under where the metal may stand: raised upright
// over a steep wall that is up the wall from the place itself.
Vec3d centre_under(Vec3d top, Vec3d normal, double scallop, double radius);

// Least z of a normal for metal to be measured upright.
constexpr double kSteepNormal = 0.2;
// Least z of a normal where heights say anything.
constexpr double kUprightNormal = 0.05;
// Of the scallop: what is asked of places that stand for a smallest cell.
constexpr double kPlaceShare = 0.98;
// In steps between passes: a smallest cell where the tool can't touch.
constexpr double kBlockedCell = 0.25;
// The same where none of its corners can be touched and next to nothing could be taken off at its
// middle; and how much that is, of the scallop.
constexpr double kSettledCell = 0.5;
constexpr double kSettledShare = 0.25;
// In steps between passes: between places that a missing pass is traced by.
constexpr double kTraceStep = 0.125;
constexpr int kMostTraced = 4000;
// mm: how far a surface must lie over a place to hide it.
constexpr double kHidden = 1e-3;

class ScallopAtPoint {
public:
    // surfaces  none for a mesh
    // scallop   mm: what may be left
    // path_off  mm: how far the path that is cut may be from the points given to `add`
    ScallopAtPoint(const std::vector<nurbs::Surface>& surfaces,
                   const GougeFreePathFitter& path_fitter,
                   double scallop,
                   double path_off);

    // A pass that will be cut, by its tips.
    void add(const Points& tips) { swept_.add(tips); }

    const SweptVolume& swept() const { return swept_; }

    // mm, between passes on flat ground that leave the scallop.
    double step() const { return step_; }

    // The tip of a ball that rests on the place, lifted as passes are.
    Vec3d touching_tip(Vec3d point, Vec3d normal) const;

    // Whether what stands over the place is taken off to a share of the scallop.
    //
    //   normal  unit, upward
    bool is_covered(Vec3d point, Vec3d normal, double share = kPlaceShare) const;

    struct LowerTip {
        std::optional<Vec3d> tip;  // none where no tip takes more than the share off
        double left{};             // mm: what it takes off
        bool moved_clear{};        // there is one, but passes keep off the edge beside it
    };
    // Where the tool would stand lowest over the place, if that takes off more than a share of the
    // scallop.
    // Precondition: normal.z >= kUprightNormal
    LowerTip lower_tip(Vec3d point, Vec3d normal, double share = 1) const;

    // Whether it is told at once that `lower_tip` has none. False says nothing.
    bool has_no_lower_tip(Vec3d point, Vec3d normal) const;

    // Whether no tip would take off more than `kSettledShare`, those that passes keep off included.
    bool settled(Vec3d point, Vec3d normal) const;

    struct Uncut {
        double reachable{};     // mm: over the best that passes can do
        double beside_edges{};  // mm: over the best that the tool could do, where passes keep off
                                // an edge of which it would take too much
    };
    // What is left at a place, square to the surface; at most the radius. May be inexact below
    // `resolution`, which saves most of the search.
    Uncut uncut_at(Vec3d point, Vec3d normal, double resolution) const;

    // Passes of best tips of neighbouring places. They may lie apart (two sides of a ridge):
    // between those that do the tool follows the model, or it is lifted.
    std::vector<Points> runs_of(const Points& tips) const;

private:
    LowerPositionProof::Verdict quick_verdict(Vec3d point,
                                              Vec3d normal,
                                              double share,
                                              const SweptVolume::Lowest& now) const;
    LowerTip searched(Vec3d point,
                      Vec3d normal,
                      double share,
                      const SweptVolume::Lowest& now) const;

    const GougeFreePathFitter& path_fitter_;
    double radius_;
    double scallop_;
    double path_off_;
    double step_;
    SweptVolume swept_;
    double accuracy_;  // mm: how high drops may be
    mutable ReachableHeight reach_;
    mutable std::optional<LowerPositionProof> lower_position_;  // over a mesh
    mutable std::vector<std::uint32_t> near_;
};

}  // namespace cusp::finishing
