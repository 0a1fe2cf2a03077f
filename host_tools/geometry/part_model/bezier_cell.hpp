// A piece of a Bezier patch with bounds of its points and derivatives, from its control points.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_model {

// a u^2 + 2 b u v + c v^2.
struct QuadraticForm {
    double a{};
    double b{};
    double c{};

    double operator()(double u, double v) const { return a * u * u + 2 * b * u * v + c * v * v; }
    double determinant() const { return a * c - b * b; }
    bool never_negative() const { return a >= 0 && c >= 0 && determinant() >= 0; }
};

// For use by several threads at once, but for forget(): halves() and what follows below it keep what
// they find, and where two threads find it, they find the same.
class BezierCell {
public:
    // A patch with one span in u and v, as by bezier_patches().
    //
    // made  if given, is increased for every half made, at all levels; must outlive the cell
    BezierCell(const nurbs::BezierPatch& patch,
               int surface,
               std::atomic<std::size_t>* made = nullptr);
    ~BezierCell();
    BezierCell(const BezierCell&) = delete;
    BezierCell& operator=(const BezierCell&) = delete;

    int surface() const { return surface_; }
    // Point and derivatives by the local parameters, each in [0, 1].
    nurbs::SurfacePoint at(double s, double t) const;
    // First derivatives at (s, t); second derivatives may be left zero.
    nurbs::SurfacePoint tangents_at(double s, double t) const;

    // A bicubic cell at one s, as control points of a curve of t and of its derivative by s.
    struct Curve4 {
        std::array<double, 12> value;
        std::array<double, 12> along_s;
        std::array<double, 12> along_ss;
    };
    // False for cells of other degrees, and rational ones.
    bool cut_at(double s, Curve4& out) const;
    // Point and first derivatives.
    static nurbs::SurfacePoint on_cut(const Curve4& cut, double t);
    // Second derivatives as well.
    static nurbs::SurfacePoint bends_on_cut(const Curve4& cut, double t);

    double u(double s) const { return u_begin_ + s * (u_end_ - u_begin_); }
    double v(double t) const { return v_begin_ + t * (v_end_ - v_begin_); }
    // The local parameters of u and v, clamped to [0, 1].
    double s_of(double u) const
    {
        return std::clamp((u - u_begin_) / (u_end_ - u_begin_), 0.0, 1.0);
    }
    double t_of(double v) const
    {
        return std::clamp((v - v_begin_) / (v_end_ - v_begin_), 0.0, 1.0);
    }
    double u_begin() const { return u_begin_; }
    double u_end() const { return u_end_; }
    double v_begin() const { return v_begin_; }
    double v_end() const { return v_end_; }
    // True if the cell reaches the patch's first or last u, or v.
    bool ends_in_u() const { return first_u_ || last_u_; }
    bool ends_in_v() const { return first_v_ || last_v_; }

    // A point of the cell with derivatives by its own parameters, as derivatives by u and v.
    nurbs::SurfacePoint by_domain(nurbs::SurfacePoint p) const;

    Vec3d low() const { return low_; }
    Vec3d high() const { return high_; }

    // The values at the middle, and bounds of their distance from all values in the cell. Proved by
    // the convex hulls of the control points of the values and derivatives; for rational cells by
    // interval arithmetic.
    struct Spread {
        double point;
        double ds;
        double dt;
        double dss;
        double dst;
        double dtt;
    };
    const nurbs::SurfacePoint& middle() const { return middle_; }
    const Spread& spread() const { return spread_; }

    // A box along the tangent plane of the middle; axes()[0] is the upward normal.
    const std::array<Vec3d, 3>& axes() const { return axes_; }
    // Bounds of dot(point - middle().point, axes()[k]).
    double box_low(std::size_t k) const { return box_low_[k]; }
    double box_high(std::size_t k) const { return box_high_[k]; }

    // Two halves across the longer side, or the one along which a derivative vanishes, made when first
    // needed.
    std::array<const BezierCell*, 2> halves() const;
    // Releases the halves and the surroundings.
    void forget() const;

    // The surface in and around the cell, for `MoveClearanceBound`; kept here once it is known.
    struct Surroundings {
        double u_begin, u_end, v_begin, v_end;
        // For a contact x in the cell with upward normal n, and any point y of the surroundings, at
        // the distance w from x in the domain:
        //   (y - x)^2 >= nearness * metric(w),  2 n . (y - x) <= bend(w) + extra_bend * metric(w),
        //   (y - x).z^2 <= climb^2 * metric(w).
        // `extra_bend` is kInfinite where nothing is proved.
        QuadraticForm metric;
        QuadraticForm bend;
        double nearness;
        double extra_bend;
        double climb;
        double top;  // upper bound of z in the surroundings
    };
    const Surroundings* surroundings() const { return surroundings_; }
    void set_surroundings(const Surroundings& found) const;

    // Patches nearer than `range` to the core of a ball (its centre and everything straight above)
    // at `centre`, over the middle of the cell; null: not known.
    struct NearPatches {
        std::vector<const BezierCell*> patches;
        Vec3d centre;
        double range;
        // Those known before, which another thread may still read.
        std::unique_ptr<const NearPatches> older;
    };
    const NearPatches* near_patches() const { return near_patches_; }
    // Returns the patches as kept.
    const NearPatches& set_near_patches(std::unique_ptr<NearPatches> found) const;

    enum class Trim : std::uint8_t { kUnknown, kInside, kOutside, kCut };
    Trim trim() const { return trim_; }
    void set_trim(Trim trim) const { trim_ = trim; }

private:
    BezierCell() = default;
    nurbs::SurfacePoint at_any_degree(double s, double t) const;
    void find_bounds();
    Spread polynomial_spread() const;
    Spread rational_spread() const;
    bool is_halved_across_u() const;
    void begin_half(BezierCell& half, bool across_u, bool upper) const;
    Vec3d control(std::size_t i, std::size_t j) const;

    struct Halves;

    int surface_{};
    std::atomic<std::size_t>* made_{};
    std::size_t count_s_{};
    std::size_t count_t_{};
    const Vec3d* points_{};    // times the weight
    const double* weights_{};  // null: all 1
    struct Controls {
        std::vector<Vec3d> points;
        std::vector<double> weights;  // empty: all 1
    };
    std::unique_ptr<const Controls> controls_;  // of a whole patch; those of halves lie beside them
    double u_begin_{};
    double u_end_{};
    double v_begin_{};
    double v_end_{};
    bool first_u_{true};
    bool last_u_{true};
    bool first_v_{true};
    bool last_v_{true};
    Vec3d low_;
    Vec3d high_;
    nurbs::SurfacePoint middle_;
    Spread spread_{};
    std::array<Vec3d, 3> axes_;
    std::array<double, 3> box_low_{};
    std::array<double, 3> box_high_{};
    // Owned.
    mutable std::atomic<Halves*> halves_{nullptr};
    mutable std::atomic<const Surroundings*> surroundings_{nullptr};
    mutable std::atomic<const NearPatches*> near_patches_{nullptr};
    mutable std::atomic<Trim> trim_{Trim::kUnknown};
};

}  // namespace cusp::part_model
