// The stock that passes of a ball leave over a single point of a model, and the tip that would
// remove it.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/cam/finishing/lower_position_proof.hpp"
#include "host_tools/cam/finishing/reachable_height.hpp"
#include "host_tools/cam/finishing/swept_volume.hpp"
#include "host_tools/cam/finishing/triangle_halves.hpp"

namespace cusp::finishing {

// The highest point that stock may reach over a point of the surface. The scallop is measured along
// the normal on steep ground. Elsewhere (`along_z`) it is measured vertically and multiplied by the
// cosine of the slope, which over sharp ridges is stricter.
Vec3d raised(Vec3d point, Vec3d normal, double scallop, bool along_z);

// The centre of a ball that touches the surface under raised(). On a steep wall that is above the
// point itself.
Vec3d centre_under(Vec3d top, Vec3d normal, double scallop, double radius);

// Least z of a normal for which the scallop is measured vertically.
constexpr double kSteepNormal = 0.2;
// Least z of a normal for which heights alone measure the stock. On steeper walls stock may be high
// but thin.
constexpr double kUprightNormal = 0.05;
// Share of the scallop allowed at points that represent a smallest cell.
constexpr double kPlaceShare = 0.98;
// In stepovers: the smallest cell of a face where the tool cannot touch; smaller ones of a mesh are proved one by one.
constexpr double kBlockedCell = 0.25;
// In stepovers: cells below this are settled as a whole where the tool can touch no corner; those of a face, if
// it could remove at their middle no more than this share of the scallop.
constexpr double kSettledCell = 0.5;
constexpr double kSettledShare = 0.25;
// In stepovers: the distance of points along a missing pass.
constexpr double kTraceStep = 0.125;
constexpr int kMostTraced = 4000;
// mm: how far a surface has to lie over a point to hide it.
constexpr double kHidden = 1e-3;
constexpr double kHiddenBeside = 1e-5;  // the same beside a wall: vertices of files are rounded
// z of a normal: less is a vertical facet, which has no height.
constexpr double kLevelFacet = 1e-9;

// Not for use by two threads at once.

class ScallopAtPoint {
public:
    // surfaces  none for a mesh
    // scallop   mm: allowed height of uncut stock
    // path_off  mm: maximum distance between the path that is cut and the points given to add()
    ScallopAtPoint(const std::vector<nurbs::Surface>& surfaces,
                   const GougeFreePathFitter& path_fitter,
                   double scallop,
                   double path_off);
    // Shares the passes with the other, of which only one may add; searches on its own, so that two
    // threads may use one each while none is added.
    ScallopAtPoint(const ScallopAtPoint& other);
    ScallopAtPoint& operator=(const ScallopAtPoint&) = delete;

    // A pass that will be cut, by its tips.
    void add(const Points& tips) { swept_->add(tips); }

    const SweptVolume& swept() const { return *swept_; }

    // Drops of searches, which copies share: see ReachableHeight.
    ReachableHeight::Drops take_drops() { return reach_.take_drops(); }
    void share(ReachableHeight::Drops drops) { reach_.share(std::move(drops)); }
    ReachableHeight::Drops drops() const { return reach_.drops(); }
    void begin_with(ReachableHeight::Drops drops) { reach_.begin_with(std::move(drops)); }
    std::size_t drops_made() const { return reach_.drops_made(); }

    // mm: stepover on level ground that leaves the scallop.
    double step() const { return step_; }

    // The tip of a ball that touches the point, raised by the band's offset as passes are.
    Vec3d touching_tip(Vec3d point, Vec3d normal) const;

    // True if the stock over the point is cut down to a share of the scallop.
    //
    // normal  unit vector, upward
    bool is_covered(Vec3d point, Vec3d normal, double share = kPlaceShare) const;

    // As is_covered(), for walls steeper than kUprightNormal: the cut of the shank counts. Stock is
    // measured along the normal: little over the point may be much beside it, where the wall leans
    // out under it.
    //
    // off  mm: how far the wall may be off the point
    bool is_wall_cut(Vec3d point, Vec3d normal, double share, double off = 0) const;

    struct WallPoint {
        Vec3d point;
        Vec3d normal;
    };
    // True if one move cuts the stock over all of these points of a wall, and so over their hull.
    bool one_move_cuts_wall(const std::vector<WallPoint>& points, double off) const;

    // mm: the stock over a point of a wall, along the normal; at most the radius.
    double left_beside_wall(Vec3d point, Vec3d normal, double off = 0) const;

    // True if the wall, taken to the height of the model, leans by less than the scallop.
    bool is_upright(Vec3d normal) const { return normal.z <= upright_normal(); }

    // The greatest z of the normal of such a wall.
    double upright_normal() const;

    struct LowerTip {
        std::optional<Vec3d> tip;  // none where no tip removes more than the share
        double left{};             // mm: what it removes
        bool moved_clear{};        // there is one, but it would gouge an edge from the side
    };
    // The lowest position of the tool over the point, if it removes more than a share of the
    // scallop. None where is_upright().
    LowerTip lower_tip(Vec3d point, Vec3d normal, double share = 1) const;

    // Fast rejection: true only where lower_tip() has none.
    // Precondition: normal.z >= kUprightNormal
    bool has_no_lower_tip(Vec3d point, Vec3d normal, double share = 1) const;

    enum class OneMove : std::uint8_t {
        kCuts,        // down to the scallop over the facet
        kGoesLowest,  // down to the scallop above the lowest position of any ball
        kUnknown,
        kTooHigh,  // no move goes low enough over a corner
    };
    // How the move that is lowest over the middle of a triangle cuts it: at the corners, and so between
    // them, since what a move leaves is convex.
    //
    // corners  of a part of a facet
    // longest  mm, of its sides
    // Precondition: normal.z >= kUprightNormal
    OneMove by_one_move(const Corners& corners, Vec3d normal, double longest) const;

    // Share of the scallop for stock above the lowest position of passes: they keep the band's offset,
    // by which a ball alone gets lower.
    double blocked_share() const;

    // True if no tip removes more than `kSettledShare`, tips that would gouge an edge included.
    // Precondition: normal.z >= kUprightNormal
    bool settled(Vec3d point, Vec3d normal) const;

    struct Uncut {
        double reachable{};     // mm: above the lowest position that passes may take
        double beside_edges{};  // mm: above the lowest position of the tool, where passes may not
                                // take that since it would gouge an edge from the side
    };
    // The stock left at a point, along the normal; at most the radius. Values below `resolution`
    // may be inexact, which saves most of the search.
    Uncut uncut_at(Vec3d point, Vec3d normal, double resolution) const;

private:
    double left_from(Vec3d point, Vec3d normal, double height, double now) const;
    LowerPositionProof::Verdict quick_verdict(Vec3d point,
                                              Vec3d normal,
                                              double share,
                                              const SweptVolume::Lowest& now) const;
    LowerTip searched(Vec3d point,
                      Vec3d normal,
                      double share,
                      const SweptVolume::Lowest& now) const;

    const std::vector<nurbs::Surface>& surfaces_;
    const GougeFreePathFitter& path_fitter_;
    double radius_;
    double scallop_;
    double path_off_;
    double step_;
    std::shared_ptr<SweptVolume> swept_;
    double accuracy_;  // mm: how much too high drops may be
    mutable ReachableHeight reach_;
    mutable std::optional<LowerPositionProof> lower_position_;  // over a mesh
    mutable std::vector<std::uint32_t> near_;
};

}  // namespace cusp::finishing
