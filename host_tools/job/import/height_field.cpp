// Samples the mesh's upper envelope, fits a surface, and raises it until all facets lie below.
#include "host_tools/job/import/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::import {

using nurbs::Surface;

namespace {

using Triangle = std::array<Vec3d, 3>;

constexpr int kFirstCells = 24;  // along the longer side
constexpr int kMostCells = 192;
// Subdivision of a cell, along each side, for the proof.
constexpr int kParts = 4;

struct Box {
    double x0, x1, y0, y1, z0;
};

Box box_of(const Facets& facets)
{
    Box box{kInfinite, -kInfinite, kInfinite, -kInfinite, kInfinite};
    for (const Triangle& t : facets.triangles) {
        for (const Vec3d& p : t) {
            box = {std::min(box.x0, p.x), std::max(box.x1, p.x), std::min(box.y0, p.y),
                   std::max(box.y1, p.y), std::min(box.z0, p.z)};
        }
    }
    return box;
}

struct Span {
    int begin, end;
};

// Indices [begin, end) of the cells, of `count`, that the interval [low, high] overlaps.
Span span_of(double low, double high, int count)
{
    return {std::clamp(static_cast<int>(std::floor(low)), 0, count - 1),
            std::clamp(static_cast<int>(std::floor(high)), 0, count - 1) + 1};
}

double lowest(double Vec3d::*axis, const Triangle& t)
{
    return std::min({t[0].*axis, t[1].*axis, t[2].*axis});
}
double highest(double Vec3d::*axis, const Triangle& t)
{
    return std::max({t[0].*axis, t[1].*axis, t[2].*axis});
}

// The part of a convex polygon where sign * (coordinate - at) <= 0.
void clip(std::vector<Vec3d>& polygon, double Vec3d::*axis, double at, double sign)
{
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d a = polygon[i];
        const Vec3d b = polygon[(i + 1) % polygon.size()];
        const double da = sign * (a.*axis - at);
        const double db = sign * (b.*axis - at);
        if (da <= 0) {
            kept.push_back(a);
        }
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
            kept.push_back(a + (da / (da - db)) * (b - a));
        }
    }
    polygon.swap(kept);
}

class Field {
public:
    // goes_on  whether cells without facets extrapolate their neighbours; else they have the mesh's
    //          lowest height
    Field(const Facets& facets, const Box& box, int cells, bool goes_on)
        : facets_{facets},
          box_{box},
          step_{std::max(box.x1 - box.x0, box.y1 - box.y0) / cells},
          nx_{count_along(box.x1 - box.x0)},
          ny_{count_along(box.y1 - box.y0)},
          sx_{(box.x1 - box.x0) / nx_},
          sy_{(box.y1 - box.y0) / ny_},
          goes_on_{goes_on}
    {
        sample();
        if (goes_on) {
            go_on();
        }
        fill_open();
        fit();
    }

    void lift(double tolerance);
    Surface surface() const;
    double step() const { return step_; }
    double most_lift() const { return most_lift_; }
    double loose_share() const { return loose_share_; }
    double open_share() const { return open_share_; }

private:
    int count_along(double side) const
    {
        return std::max(4, static_cast<int>(std::ceil(side / step_ - 1e-9)));
    }
    void sample();
    void go_on();
    void fill_open();
    double gone_on(int i, int j) const;
    void fit();
    // Control points -1 ... n + 1 along each side, at the knots in plan.
    double& control(int i, int j) { return controls_[place(i, j)]; }
    double control(int i, int j) const { return controls_[place(i, j)]; }
    std::size_t place(int i, int j) const
    {
        return static_cast<std::size_t>((i + 1) * (ny_ + 3) + j + 1);
    }
    std::array<double, 16> bezier_of_cell(int i, int j) const;
    struct Missing {
        std::vector<double> up;      // mm, of each cell
        std::vector<double> square;  // the same along the facet's normal
    };
    Missing missing() const;

    const Facets& facets_;
    Box box_;
    double step_;
    int nx_, ny_;
    double sx_, sy_;
    bool goes_on_;
    std::vector<double> samples_;
    std::vector<double> controls_;
    double most_lift_{};
    double loose_share_{};
    double open_share_{};
};

// Heights of the upper envelope over the knots.
void Field::sample()
{
    samples_.assign(static_cast<std::size_t>((nx_ + 1) * (ny_ + 1)), -kInfinite);
    for (const Triangle& t : facets_.triangles) {
        const double det =
            (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
        if (det == 0) {
            continue;
        }
        const Span in_x = span_of((lowest(&Vec3d::x, t) - box_.x0) / sx_,
                                  (highest(&Vec3d::x, t) - box_.x0) / sx_ + 1, nx_ + 1);
        const Span in_y = span_of((lowest(&Vec3d::y, t) - box_.y0) / sy_,
                                  (highest(&Vec3d::y, t) - box_.y0) / sy_ + 1, ny_ + 1);
        for (int i = in_x.begin; i < in_x.end; ++i) {
            for (int j = in_y.begin; j < in_y.end; ++j) {
                const double ex = box_.x0 + i * sx_ - t[0].x;
                const double ey = box_.y0 + j * sy_ - t[0].y;
                const double a = (ex * (t[2].y - t[0].y) - (t[2].x - t[0].x) * ey) / det;
                const double b = ((t[1].x - t[0].x) * ey - ex * (t[1].y - t[0].y)) / det;
                constexpr double kEdge = -1e-9;
                if (a >= kEdge && b >= kEdge && a + b <= 1 - kEdge) {
                    double& z = samples_[static_cast<std::size_t>(i * (ny_ + 1) + j)];
                    z = std::max(z, t[0].z + a * (t[1].z - t[0].z) + b * (t[2].z - t[0].z));
                }
            }
        }
    }
    const auto open = std::count(samples_.begin(), samples_.end(), -kInfinite);
    open_share_ = static_cast<double>(open) / static_cast<double>(samples_.size());
}

// Extrapolates known neighbouring heights: linearly where two in a row are known.
double Field::gone_on(int i, int j) const
{
    const auto known = [&](int a, int b) {
        return a < 0 || a > nx_ || b < 0 || b > ny_
                   ? -kInfinite
                   : samples_[static_cast<std::size_t>(a * (ny_ + 1) + b)];
    };
    double straight = 0;
    double beside = 0;
    int straights = 0;
    int besides = 0;
    for (int di = -1; di <= 1; ++di) {
        for (int dj = -1; dj <= 1; ++dj) {
            const double near = known(i + di, j + dj);
            const double far = known(i + 2 * di, j + 2 * dj);
            if (near != -kInfinite && far != -kInfinite) {
                straight += 2 * near - far;
                ++straights;
            } else if (near != -kInfinite) {
                beside += near;
                ++besides;
            }
        }
    }
    return straights > 0 ? straight / straights : besides > 0 ? beside / besides : -kInfinite;
}

// Extrapolates samples to all knots that influence cells with facets.
void Field::go_on()
{
    constexpr int kRings = 4;
    for (int ring = 0; ring < kRings; ++ring) {
        std::vector<double> next = samples_;
        for (int i = 0; i <= nx_; ++i) {
            for (int j = 0; j <= ny_; ++j) {
                double& z = next[static_cast<std::size_t>(i * (ny_ + 1) + j)];
                z = z == -kInfinite ? gone_on(i, j) : z;
            }
        }
        samples_.swap(next);
    }
}

void Field::fill_open() { std::replace(samples_.begin(), samples_.end(), -kInfinite, box_.z0); }

// Quasi-interpolation: exact for cubics, without a system of equations.
void Field::fit()
{
    const auto sample_at = [&](int i, int j) {
        return samples_[static_cast<std::size_t>(i * (ny_ + 1) + j)];
    };
    // linear extrapolation beyond the box
    const auto along_y = [&](int i, int j) {
        return j < 0 ? sample_at(i, 0) + j * (sample_at(i, 1) - sample_at(i, 0))
               : j > ny_
                   ? sample_at(i, ny_) + (j - ny_) * (sample_at(i, ny_) - sample_at(i, ny_ - 1))
                   : sample_at(i, j);
    };
    const auto z = [&](int i, int j) {
        return i < 0     ? along_y(0, j) + i * (along_y(1, j) - along_y(0, j))
               : i > nx_ ? along_y(nx_, j) + (i - nx_) * (along_y(nx_, j) - along_y(nx_ - 1, j))
                         : along_y(i, j);
    };
    const auto fitted_in_y = [&](int i, int j) {
        return (8 * z(i, j) - z(i, j - 1) - z(i, j + 1)) / 6;
    };
    controls_.assign(static_cast<std::size_t>((nx_ + 3) * (ny_ + 3)), 0.0);
    for (int i = -1; i <= nx_ + 1; ++i) {
        for (int j = -1; j <= ny_ + 1; ++j) {
            control(i, j) =
                (8 * fitted_in_y(i, j) - fitted_in_y(i - 1, j) - fitted_in_y(i + 1, j)) / 6;
        }
    }
}

// Bezier heights of a uniform cubic span from its four controls.
std::array<double, 4> bezier(double a, double b, double c, double d)
{
    return {(a + 4 * b + c) / 6, (2 * b + c) / 3, (b + 2 * c) / 3, (b + 4 * c + d) / 6};
}

std::array<double, 16> Field::bezier_of_cell(int i, int j) const
{
    std::array<std::array<double, 4>, 4> rows{};
    for (int k = 0; k < 4; ++k) {
        rows[static_cast<std::size_t>(k)] =
            bezier(control(i - 1 + k, j - 1), control(i - 1 + k, j), control(i - 1 + k, j + 1),
                   control(i - 1 + k, j + 2));
    }
    std::array<double, 16> out{};
    for (std::size_t m = 0; m < 4; ++m) {
        const auto column = bezier(rows[0][m], rows[1][m], rows[2][m], rows[3][m]);
        for (std::size_t k = 0; k < 4; ++k) {
            out[4 * k + m] = column[k];
        }
    }
    return out;
}

// The Bezier points of a cubic on the interval [a, b] of its parameter.
std::array<double, 4> cut(const std::array<double, 4>& p, double a, double b)
{
    const auto blossom = [&](double r, double s, double t) {
        const auto mix = [](double x, double y, double at) {
            return x + at * (y - x);
        };
        const double q0 = mix(p[0], p[1], r);
        const double q1 = mix(p[1], p[2], r);
        const double q2 = mix(p[2], p[3], r);
        return mix(mix(q0, q1, s), mix(q1, q2, s), t);
    };
    return {blossom(a, a, a), blossom(a, a, b), blossom(a, b, b), blossom(b, b, b)};
}

// A plane below one part of a cell, z = level + gx (x - x0) + gy (y - y0).
struct LowPlane {
    double level, gx, gy;
};

LowPlane plane_below(const std::array<double, 16>& cell, int p, int q, double sx, double sy)
{
    const double a = static_cast<double>(p) / kParts;
    const double b = static_cast<double>(q) / kParts;
    constexpr double kShare = 1.0 / kParts;
    std::array<std::array<double, 4>, 4> net{};
    for (std::size_t m = 0; m < 4; ++m) {
        const auto column = cut({cell[m], cell[4 + m], cell[8 + m], cell[12 + m]}, a, a + kShare);
        for (std::size_t k = 0; k < 4; ++k) {
            net[k][m] = column[k];
        }
    }
    for (auto& row : net) {
        row = cut(row, b, b + kShare);
    }
    // mean slopes of the part, from its corners
    const double rise_x = (net[3][0] - net[0][0] + net[3][3] - net[0][3]) / 2;
    const double rise_y = (net[0][3] - net[0][0] + net[3][3] - net[3][0]) / 2;
    double level = kInfinite;
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t m = 0; m < 4; ++m) {
            level = std::min(level, net[k][m] - rise_x * static_cast<double>(k) / 3 -
                                        rise_y * static_cast<double>(m) / 3);
        }
    }
    return {level, rise_x * kParts / sx, rise_y * kParts / sy};
}

// Per cell, the greatest height of facets above the planes that bound the surface from below.
Field::Missing Field::missing() const
{
    const double px = sx_ / kParts;
    const double py = sy_ / kParts;
    std::vector<LowPlane> planes;
    for (int i = 0; i < nx_; ++i) {
        for (int j = 0; j < ny_; ++j) {
            const auto cell = bezier_of_cell(i, j);
            for (int k = 0; k < kParts * kParts; ++k) {
                planes.push_back(plane_below(cell, k / kParts, k % kParts, sx_, sy_));
            }
        }
    }
    const auto count = static_cast<std::size_t>(nx_ * ny_);
    Missing most{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
    std::vector<Vec3d> strip;
    std::vector<Vec3d> polygon;
    for (const Triangle& t : facets_.triangles) {
        const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
        const double lean = std::abs(normal.z) / norm(normal);
        const Span in_x = span_of((lowest(&Vec3d::x, t) - box_.x0) / px - 1e-6,
                                  (highest(&Vec3d::x, t) - box_.x0) / px + 1e-6, nx_ * kParts);
        for (int i = in_x.begin; i < in_x.end; ++i) {
            const double x = box_.x0 + i * px;
            strip.assign(t.begin(), t.end());
            clip(strip, &Vec3d::x, x, -1);
            clip(strip, &Vec3d::x, x + px, 1);
            if (strip.empty()) {
                continue;
            }
            const auto [low, high] = std::minmax_element(
                strip.begin(), strip.end(), [](Vec3d a, Vec3d b) { return a.y < b.y; });
            const Span in_y = span_of((low->y - box_.y0) / py - 1e-6,
                                      (high->y - box_.y0) / py + 1e-6, ny_ * kParts);
            for (int j = in_y.begin; j < in_y.end; ++j) {
                const double y = box_.y0 + j * py;
                polygon = strip;
                clip(polygon, &Vec3d::y, y, -1);
                clip(polygon, &Vec3d::y, y + py, 1);
                const auto cell = static_cast<std::size_t>((i / kParts) * ny_ + j / kParts);
                const auto part = static_cast<std::size_t>((i % kParts) * kParts + j % kParts);
                const LowPlane& plane = planes[cell * kParts * kParts + part];
                for (const Vec3d& v : polygon) {
                    const double over =
                        v.z - plane.level - plane.gx * (v.x - x) - plane.gy * (v.y - y);
                    most.up[cell] = std::max(most.up[cell], over);
                    most.square[cell] = std::max(most.square[cell], lean * over);
                }
            }
        }
    }
    return most;
}

void Field::lift(double tolerance)
{
    const Missing most = missing();
    const std::vector<double>& tracked = goes_on_ ? most.square : most.up;
    std::vector<double> lifted = controls_;
    std::size_t loose = 0;
    for (int i = 0; i < nx_; ++i) {
        for (int j = 0; j < ny_; ++j) {
            const auto cell = static_cast<std::size_t>(i * ny_ + j);
            const double add = most.up[cell];
            most_lift_ = std::max(most_lift_, tracked[cell]);
            loose += tracked[cell] > tolerance ? 1U : 0U;
            for (int k = i - 1; k <= i + 2; ++k) {
                for (int m = j - 1; m <= j + 2; ++m) {
                    double& z = lifted[place(k, m)];
                    z = std::max(z, control(k, m) + add);
                }
            }
        }
    }
    controls_.swap(lifted);
    loose_share_ = static_cast<double>(loose) / static_cast<double>(nx_ * ny_);
}

Surface Field::surface() const
{
    const auto knots = [](int n, double step) {
        std::vector<double> out;
        for (int i = -3; i <= n + 3; ++i) {
            out.push_back(i * step);
        }
        return out;
    };
    Surface s{3, 3, knots(nx_, sx_), knots(ny_, sy_), nx_ + 3, ny_ + 3, {}, {}, {}};
    for (int i = -1; i <= nx_ + 1; ++i) {
        for (int j = -1; j <= ny_ + 1; ++j) {
            s.points.push_back({box_.x0 + i * sx_, box_.y0 + j * sy_, control(i, j)});
        }
    }
    s.weights.assign(s.points.size(), 1.0);
    return clamped(s);
}

// Plan area of downward facets above the base; 0 where the mesh has no upward facet: it is inside
// out.
double overhang(const Facets& facets, double base)
{
    constexpr double kOnBase = 1e-3;  // mm
    constexpr double kFacing = 1e-3;
    double area = 0;
    bool any_up = false;
    for (const Triangle& t : facets.triangles) {
        const Vec3d n = cross(t[1] - t[0], t[2] - t[0]);
        any_up = any_up || n.z > kFacing * norm(n);
        if (n.z < -kFacing * norm(n) && highest(&Vec3d::z, t) > base + kOnBase) {
            area -= n.z / 2;
        }
    }
    return any_up ? area : 0;
}

// At creases the error is proportional to the cell size; elsewhere it is of higher order.
int next_cells(int cells, double too_much)
{
    constexpr double kSpare = 1.1;
    const int wanted = static_cast<int>(cells * std::clamp(kSpare * too_much, 1.25, 2.0));
    return cells < kMostCells ? std::min(wanted, kMostCells) : 2 * kMostCells;
}

HeightField finest(const Facets& facets, double tolerance, bool goes_on)
{
    const Box box = box_of(facets);
    HeightField out;
    double before = kInfinite;
    int more = 0;
    for (int cells = kFirstCells; cells <= kMostCells; cells = more) {
        Field field{facets, box, cells, goes_on};
        field.lift(tolerance);
        out = {field.surface(),          field.step(),      field.most_lift(), field.loose_share(),
               overhang(facets, box.z0), field.open_share()};
        // at a step finer cells do not reduce the error, but they slow down planning
        constexpr double kNoBetter = 0.75;
        if (out.loose_share == 0 || (cells >= kMostCells / 2 && out.lift > kNoBetter * before)) {
            break;
        }
        before = out.lift;
        more = goes_on ? next_cells(cells, out.lift / tolerance) : 2 * cells;
    }
    return out;
}

}  // namespace

HeightField height_field(const Facets& facets, double tolerance)
{
    return finest(facets, tolerance, false);
}

HeightField height_patch(const Facets& facets, double tolerance)
{
    return finest(facets, tolerance, true);
}

double overhang_area(const Facets& facets) { return overhang(facets, box_of(facets).z0); }

}  // namespace cusp::import
