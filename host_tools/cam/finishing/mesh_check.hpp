// Finds the stock that passes leave over a mesh, triangle by triangle, and the passes that are missing if it is more than
// the scallop.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/cam/finishing/triangle_halves.hpp"

namespace cusp::finishing {

// The result of a check that is over.
struct MeshLeft {
    // mm2 of facets with more than the scallop left because the tool cannot touch them: feet of walls,
    // concave edges, valleys narrower than the tool.
    double blocked_area{};
    // mm: what stays there, measured at places. None: a proof holds there too.
    std::optional<double> measured{};
    std::size_t uncovered{};  // cells where more than the scallop was left
    bool overflowed{};        // the check ended early because of too many of them
    double most_left{};       // mm: the highest stock measured there
    double over_nothing{};    // mm of walls without passes and claims: see walls_over_nothing()
};

// The volume that one straight move of a convex end removes is convex. Thus a move that removes all three
// corners of a triangle, raised by the scallop, removes the whole raised triangle. Triangles that no single
// move covers are halved. Facets hidden under others are not checked.
//
// Not for use by two threads at once.
class MeshCheck {
public:
    virtual ~MeshCheck() = default;

    // A pass that will be cut, by its tips.
    virtual void add(const Points& tips) = 0;

    // True if the stock over a point of the mesh is cut down to a share of the scallop.
    //
    // normal  unit vector, upward
    virtual bool is_covered(Vec3d place, Vec3d normal, double share) const = 0;

    // mm: of passes on level ground
    virtual double step() const = 0;

    // Checks all triangles, on several threads. Uncovered cells are kept for add_missing_passes().
    virtual void check() = 0;

    // Adds passes over uncovered cells. Each is given to `cut`, which must add() the path it cuts.
    virtual void add_missing_passes(const std::function<void(const Points&)>& cut) = 0;

    // Measures the stock left in the uncovered cells and forgets those where no pass is missing, as
    // the end of add_missing_passes() does.
    virtual void measure_left() = 0;

    virtual MeshLeft left() const = 0;

    // Calls work(check, k) for each k below count, on several threads, each with a check of its own that
    // has the passes of this one.
    virtual void share_out(std::size_t count,
                           const std::function<void(const MeshCheck&, std::size_t)>& work) = 0;

    MeshCheck(const MeshCheck&) = delete;
    MeshCheck& operator=(const MeshCheck&) = delete;

protected:
    MeshCheck() = default;
};

// The check for the tool of the passes: `MeshScallopCheck` for a ball, which proves that the ball gets no
// lower where it can't touch, `EndScallopCheck` for others.
//
// triangles    kept
// path_fitter  of passes over the mesh of `triangles`; kept
// scallop      mm: allowed height of uncut stock
// path_off     mm: maximum distance between the path that is cut and the points given to add()
std::unique_ptr<MeshCheck> mesh_check(const std::vector<Corners>& triangles,
                                      const GougeFreePathFitter& path_fitter,
                                      double scallop,
                                      double path_off);

}  // namespace cusp::finishing
