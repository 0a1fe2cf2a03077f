// The check of a mesh for ends that are no ball: proved where the end can touch, searched and measured
// where it can't.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/cam/finishing/mesh_check.hpp"
#include "host_tools/cam/finishing/mesh_ground.hpp"

namespace cusp::finishing {

// A facet that is too near to the tool at all three corners of a cell is so between them as well. There
// nothing is proved: passes go along the lowest places that a search finds, and what stays is measured.
// Walls are triangles as any other, with two sides; vertical ones with nothing of the part beside them are
// left out.
//
// The stock counts as thick as it is along the normal; of a tapered ball, over ground that is not steep, as
// it is vertically, multiplied by the cosine of the slope.
class EndScallopCheck : public MeshCheck {
public:
    // As mesh_check()
    EndScallopCheck(const std::vector<Corners>& triangles,
                    const GougeFreePathFitter& path_fitter,
                    double scallop,
                    double path_off);

    void add(const Points& tips) override { ground_.add(tips); }
    bool is_covered(Vec3d place, Vec3d normal, double share) const override
    {
        return ground_.is_covered({place, normal}, share);
    }
    double step() const override { return ground_.step(); }
    void check() override;
    void add_missing_passes(const std::function<void(const Points&)>& cut) override;
    void measure_left() override;
    MeshLeft left() const override;
    void share_out(std::size_t count,
                   const std::function<void(const MeshCheck&, std::size_t)>& work) override;

private:
    using Cell = FacetCell;
    struct Findings {
        std::vector<Cell> open;     // the tool can touch them
        std::vector<Cell> blocked;  // it cannot
        bool overflowed{};
    };
    class CellSearch;

    std::vector<Cell> sides() const;
    Findings look_at(const std::vector<Cell>& cells) const;
    bool cut_missing(const std::function<void(const Points&)>& cut);
    void cut_lowest(double pitch, const std::function<void(const Points&)>& cut);
    void cut_rest(const std::function<void(const Points&)>& cut);
    std::vector<Vec3d> deep_places() const;
    Points trace_wall(const MeshPlace& from) const;
    Points longest_trace(const MeshPlace& from) const;
    std::optional<MeshPlace> beside_on_wall(const MeshPlace& at, Vec3d tip) const;

    const std::vector<Corners>& triangles_;
    MeshGround ground_;
    std::vector<Cell> open_;
    std::vector<Cell> blocked_;
    double most_left_{};
    double measured_{};  // mm: over `blocked_`
    double over_nothing_{};
    bool overflowed_{};
};

}  // namespace cusp::finishing
