// Cells are halved across the passes as long as one move covers each half.
#include "host_tools/surface_passes/coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cusp::host {
namespace {

constexpr double kSmallest = 1.0 / 96;  // cells, in steps between passes
constexpr double kLargest = 4;          // the same
constexpr double kBlockedCell = 0.25;   // the same, where the tool can't touch
constexpr double kSlopeShare = 0.02;    // of the scallop, for the slope in a smallest cell
constexpr double kReachPitch = 0.125;   // radii, at least
constexpr double kTraceStep = 0.125;    // in steps between passes
constexpr double kTraceApart = 0.3;     // the same, of tips that one line may join
constexpr double kFarApart = 0.5;       // radii, of tips that one pass may join
constexpr int kMostTraced = 4000;       // places of one pass
constexpr int kRounds = 5;
constexpr int kDeepest = 40;
constexpr double kUpright = 0.05;   // z of the normal
constexpr double kSteep = 0.2;      // the same
constexpr double kHidden = 1e-3;    // mm
constexpr double kShortest = 1e-3;  // mm

// Where metal may stand at most. On all but steep ground it is measured upright and turned square:
// over sharp ridges that asks for more than the way along the normal.
Vec3d raised(Vec3d point, Vec3d normal, double scallop, bool upright)
{
    return upright ? point + Vec3d{0, 0, scallop / normal.z} : point + normal * scallop;
}

// The centre of a ball that touches the surface under where the metal may stand: raised upright
// over a steep wall that is up the wall from the place itself.
Vec3d centre_under(Vec3d top, Vec3d normal, double scallop, double radius)
{
    return top + normal * (radius - scallop);
}

double largest(const std::array<double, 4>& of) { return *std::max_element(of.begin(), of.end()); }

}  // namespace

Coverage::Coverage(const std::vector<Surface>& surfaces,
                   const CertifiedPasses& certified,
                   double scallop,
                   double path_off,
                   std::size_t most_gaps)
    : surfaces_{surfaces},
      certified_{certified},
      radius_{certified.tool().radius},
      scallop_{scallop},
      path_off_{path_off},
      step_{std::sqrt(8 * certified.tool().radius * scallop)},
      most_gaps_{most_gaps},
      swept_{radius_, 0.6 * step_},
      reach_{surfaces, certified, std::max(kBlockedCell * step_, kReachPitch * radius_)}
{
}

void Coverage::add(const Points& tips)
{
    if (tops_) {
        swept_.add(tips);
    } else {
        waiting_.push_back(tips);
    }
}

Coverage::Corner Coverage::corner(int surface, double u, double v) const
{
    Corner out{surface, u, v, certified_.model().evaluate(surface, u, v), {}};
    out.normal = certified_.model().facing_up(surface, u, v, out.point);
    return out;
}

Vec3d Coverage::touching_tip(const Corner& at) const
{
    return at.point.point + at.normal * (radius_ + certified_.band().lift) - Vec3d{0, 0, radius_};
}

bool Coverage::place_covered(const Corner& at) const
{
    const double allowed = scallop_ * (1 - kSlopeShare);
    const Vec3d top = raised(at.point.point, at.normal, allowed, at.normal.z >= kSteep);
    swept_.near(centre_under(top, at.normal, allowed, radius_), near_);
    return std::any_of(near_.begin(), near_.end(),
                       [&](std::uint32_t move) { return swept_.removes(move, top, path_off_); });
}

Coverage::Verdict Coverage::judge(const Cell& cell) const
{
    if (certified_.model().outside_trims(cell.surface, {cell.u0, cell.v0}, {cell.u1, cell.v1})) {
        return Verdict::kCovered;
    }
    const std::array<Corner, 4> at{
        corner(cell.surface, cell.u0, cell.v0), corner(cell.surface, cell.u1, cell.v0),
        corner(cell.surface, cell.u0, cell.v1), corner(cell.surface, cell.u1, cell.v1)};
    const double width_u = cell.u1 - cell.u0;
    const double width_v = cell.v1 - cell.v0;
    std::array<double, 4> along_u{};
    std::array<double, 4> along_v{};
    std::array<double, 4> bow{};
    double turn = 0;
    double least_z = 1;
    for (std::size_t k = 0; k < 4; ++k) {
        const SurfacePoint& p = at[k].point;
        along_u[k] = norm(p.du) * width_u;
        along_v[k] = norm(p.dv) * width_v;
        bow[k] = 0.25 * (norm(p.duu) * width_u * width_u + norm(p.dvv) * width_v * width_v);
        turn = std::max(turn, norm(at[k].normal - at[0].normal));
        least_z = std::min(least_z, at[k].normal.z);
    }
    const double long_u = std::max(largest(along_u), norm(at[1].point.point - at[0].point.point));
    const double long_v = std::max(largest(along_v), norm(at[2].point.point - at[0].point.point));
    const Verdict longer = long_u >= long_v ? Verdict::kHalveU : Verdict::kHalveV;
    if (std::max(long_u, long_v) > kLargest * step_ || turn > 0.5) {
        if (std::max(long_u, long_v) > kSmallest * step_) {
            return longer;
        }
    }
    const bool upright = least_z >= kSteep;
    const double bend = upright ? turn / least_z : turn;
    const double less = path_off_ + largest(bow) + 0.5 * scallop_ * bend * bend;
    Corner middle = corner(cell.surface, 0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1));
    const Vec3d middle_top =
        raised(middle.point.point, middle.normal, scallop_, upright && middle.normal.z >= kSteep);
    swept_.near(centre_under(middle_top, middle.normal, scallop_, radius_), near_);
    std::array<Vec3d, 4> tops{};
    for (std::size_t k = 0; k < 4; ++k) {
        tops[k] = raised(at[k].point.point, at[k].normal, scallop_, upright);
    }
    // One bit a corner, of the moves that cover it.
    std::array<bool, 16> together{};
    for (const std::uint32_t move : near_) {
        unsigned covers = 0;
        for (unsigned k = 0; k < 4; ++k) {
            if (swept_.removes(move, tops[k], less)) {
                covers |= 1U << k;
            }
        }
        if (covers == 15) {
            return Verdict::kCovered;
        }
        together[covers] = true;
    }
    const auto some = [&](unsigned corners) {
        for (unsigned k = corners; k < 16; ++k) {
            if ((k & corners) == corners && together[k]) {
                return true;
            }
        }
        return false;
    };
    if (std::max(long_u, long_v) < kBlockedCell * step_ && blocked_somewhere(at)) {
        return Verdict::kUncovered;
    }
    if (std::max(long_u, long_v) < kSmallest * step_) {
        const bool each =
            std::all_of(at.begin(), at.end(), [&](const Corner& c) { return place_covered(c); });
        return each ? Verdict::kCovered : Verdict::kUncovered;
    }
    const double least = 0.5 * kSmallest * step_;
    if (long_u > least && long_v > least) {
        if (some(3) && some(12)) {
            return Verdict::kHalveV;
        }
        if (some(5) && some(10)) {
            return Verdict::kHalveU;
        }
    }
    if (near_.empty() && std::max(long_u, long_v) < step_ && hidden(middle) &&
        std::all_of(at.begin(), at.end(), [&](const Corner& c) { return hidden(c); })) {
        return Verdict::kCovered;
    }
    return longer;
}

// Whether some corner is bare because the tool can't touch it, or is trimmed away.
bool Coverage::blocked_somewhere(const std::array<Corner, 4>& at) const
{
    return std::any_of(at.begin(), at.end(), [&](const Corner& c) {
        return !place_covered(c) &&
               !(dot(c.normal, c.normal) > 0 && certified_.stands_free(touching_tip(c)));
    });
}

// Whether the place is trimmed away or lies well under another surface.
bool Coverage::hidden(const Corner& at) const
{
    const Vec3d p = at.point.point;
    return !certified_.model().inside_trims(at.surface, at.u, at.v) ||
           tops_->least_around(p.x, p.y) > p.z + kHidden + 2 * tops_->pitch();
}

void Coverage::look_into(const Cell& cell, int depth)
{
    if (overflowed_) {
        return;
    }
    const Verdict verdict = judge(cell);
    if (verdict == Verdict::kCovered) {
        return;
    }
    if (verdict == Verdict::kUncovered || depth == 0) {
        if (gaps_.size() < most_gaps_) {
            gaps_.push_back(cell);
        } else {
            overflowed_ = true;
        }
        return;
    }
    Cell a = cell;
    Cell b = cell;
    if (verdict == Verdict::kHalveU) {
        a.u1 = b.u0 = 0.5 * (cell.u0 + cell.u1);
    } else {
        a.v1 = b.v0 = 0.5 * (cell.v0 + cell.v1);
    }
    look_into(a, depth - 1);
    look_into(b, depth - 1);
}

void Coverage::look_over(int surface)
{
    if (!tops_) {
        tops_.emplace(surfaces_, certified_.model(), kBlockedCell * step_);
        for (const Points& tips : waiting_) {
            swept_.add(tips);
        }
        waiting_.clear();
    }
    for (const BezierPatch& patch : bezier_patches(surfaces_[static_cast<std::size_t>(surface)])) {
        look_into({surface, patch.u_begin, patch.u_end, patch.v_begin, patch.v_end}, kDeepest);
    }
}

std::optional<Vec3d> Coverage::missing_tip(int surface,
                                           double u,
                                           double v,
                                           bool where_blocked) const
{
    const Corner at = corner(surface, u, v);
    if (!certified_.model().inside_trims(surface, u, v) || place_covered(at)) {
        return std::nullopt;
    }
    if (dot(at.normal, at.normal) > 0) {
        const Vec3d tip = touching_tip(at);
        if (certified_.stands_free(tip)) {
            return tip;
        }
    }
    return where_blocked ? better_tip(at) : std::nullopt;
}

// Where the tool would stand lowest over the place, from where it does now.
std::optional<Vec3d> Coverage::better_tip(const Corner& at) const
{
    const Vec3d p = at.point.point;
    const double cosine = at.normal.z;
    // On upright walls heights say nothing.
    if (at.normal.z < kUpright || hidden(at)) {
        return std::nullopt;
    }
    const SweptBalls::Lowest now = swept_.lowest(p.x, p.y);
    if ((now.height - p.z) * cosine <= scallop_) {
        return std::nullopt;
    }
    const std::optional<LowestReach::Answer> best = reach_.over(p, now.height - scallop_ / cosine);
    if (!best || (now.height - best->height) * cosine <= scallop_) {
        return std::nullopt;
    }
    // A pass there is kept off edges, and so no better than this.
    const Vec3d kept = certified_.kept_off_edges({best->tip}).front() + Vec3d{0, 0, radius_};
    const double square =
        radius_ * radius_ - (kept.x - p.x) * (kept.x - p.x) - (kept.y - p.y) * (kept.y - p.y);
    if ((now.height - kept.z + std::sqrt(std::max(0.0, square))) * cosine <= scallop_) {
        kept_off_ = true;
        return std::nullopt;
    }
    return best->tip;
}

Points Coverage::trace(int surface, Place place, bool along_u) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    const double begin = along_u ? s.u_begin() : s.v_begin();
    const double end = along_u ? s.u_end() : s.v_end();
    Points out;
    for (const double sign : {-1.0, 1.0}) {
        double at_u = place.u;
        double at_v = place.v;
        for (int k = 0; k < kMostTraced; ++k) {
            const std::optional<Vec3d> tip = missing_tip(surface, at_u, at_v, true);
            if (k == 0 && sign > 0) {
                // the start is there already
            } else if (tip) {
                out.push_back(*tip);
            } else {
                break;
            }
            const SurfacePoint p = certified_.model().evaluate(surface, at_u, at_v);
            const double speed = norm(along_u ? p.du : p.dv);
            double& at = along_u ? at_u : at_v;
            const double step =
                std::min(kTraceStep * step_ / std::max(1e-9, speed), (end - begin) / 8);
            const double next = std::clamp(at + sign * step, begin, end);
            if (next == at) {
                break;
            }
            at = next;
        }
        if (sign < 0) {
            std::reverse(out.begin(), out.end());
        }
    }
    return out;
}

// The best tips of neighbouring places may lie apart (two sides of a ridge): between those that do
// the tool follows the model, or it is lifted.
std::vector<Points> Coverage::runs_of(const Points& tips) const
{
    // A place that is at the limit may have its tip when asked once and none the next time: drops
    // are right to a micrometre only.
    if (tips.empty()) {
        return {};
    }
    std::vector<Points> out{{tips.front()}};
    for (std::size_t k = 1; k < tips.size(); ++k) {
        const double apart = norm(tips[k] - out.back().back());
        if (apart > kFarApart * radius_) {
            out.push_back({tips[k]});
            continue;
        }
        if (apart > kTraceApart * step_) {
            const Points between = certified_.sample_dropped(out.back().back(), tips[k]);
            out.back().insert(out.back().end(), between.begin() + 1, between.end() - 1);
        }
        out.back().push_back(tips[k]);
    }
    for (Points& run : out) {
        if (run.size() == 1) {
            run.push_back(run.front() + Vec3d{kShortest, 0, 0});
        }
    }
    return out;
}

// A place of the cell that lacks a pass.
std::optional<Coverage::Place> Coverage::bare_place(const Cell& cell) const
{
    const double u = 0.5 * (cell.u0 + cell.u1);
    const double v = 0.5 * (cell.v0 + cell.v1);
    const Surface& s = surfaces_[static_cast<std::size_t>(cell.surface)];
    // Beyond a border no other cell says what is left.
    const auto on_border = [&](const Place& at) {
        return at.u == s.u_begin() || at.u == s.u_end() || at.v == s.v_begin() || at.v == s.v_end();
    };
    for (const Place& place : {Place{u, v}, Place{cell.u0, cell.v0}, Place{cell.u1, cell.v0},
                               Place{cell.u0, cell.v1}, Place{cell.u1, cell.v1}}) {
        if (missing_tip(cell.surface, place.u, place.v, place.u == u || on_border(place))) {
            return place;
        }
    }
    return std::nullopt;
}

void Coverage::close_gaps(const std::function<void(const Points&)>& cut)
{
    std::vector<Cell> beside_edges;
    for (int round = 0; round < kRounds && !gaps_.empty(); ++round) {
        const std::vector<Cell> open = std::move(gaps_);
        gaps_.clear();
        std::vector<Cell> changed;
        for (const Cell& cell : open) {
            kept_off_ = false;
            const std::optional<Place> place = bare_place(cell);
            if (!place) {
                if (kept_off_) {
                    beside_edges.push_back(cell);
                }
                continue;
            }
            changed.push_back(cell);
            Points one = trace(cell.surface, *place, true);
            Points other = trace(cell.surface, *place, false);
            if (one.empty() || length_of(other) > length_of(one)) {
                std::swap(one, other);
            }
            for (const Points& run : runs_of(one)) {
                cut(run);
            }
        }
        for (const Cell& cell : changed) {
            look_into(cell, kDeepest / 4);
        }
    }
    const auto met = [&](const Cell& cell) {
        return !bare_place(cell).has_value();
    };
    gaps_.erase(std::remove_if(gaps_.begin(), gaps_.end(), met), gaps_.end());
    for (const Cell& cell : gaps_) {
        most_left_ = std::max(most_left_, left_over(cell));
    }
    for (const Cell& cell : beside_edges) {
        const Corner at =
            corner(cell.surface, 0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1));
        most_left_ = std::max(most_left_, left_at(at, std::max(scallop_, most_left_)));
    }
}

// What is left at a bare place of the cell, square to the surface, over the best that can be done.
double Coverage::left_over(const Cell& cell) const
{
    const std::optional<Place> place = bare_place(cell);
    if (!place) {
        return 0;
    }
    return left_at(corner(cell.surface, place->u, place->v), 0);
}

// Not told apart below `worth`, which saves most of the search.
double Coverage::left_at(const Corner& at, double worth) const
{
    const Vec3d p = at.point.point;
    const SweptBalls::Lowest now = swept_.lowest(p.x, p.y);
    if (!std::isfinite(now.height)) {
        return radius_;
    }
    if ((now.height - p.z) * at.normal.z <= worth) {
        return 0;
    }
    const std::optional<LowestReach::Answer> best =
        reach_.over(p, now.height - worth / at.normal.z);
    const double from = best ? std::max(p.z, best->height) : p.z;
    return std::min(radius_, std::max(0.0, (now.height - from) * at.normal.z));
}

// Highest places first: most of the others are told to be lower without a search.
double Coverage::measured_left() const
{
    struct High {
        Corner at;
        double over;  // mm, over the surface
    };
    std::vector<High> all;
    for (const Cell& cell : gaps_) {
        const Place middle{0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1)};
        for (const Place& place : {middle, Place{cell.u0, cell.v0}, Place{cell.u1, cell.v0},
                                   Place{cell.u0, cell.v1}, Place{cell.u1, cell.v1}}) {
            const Corner at = corner(cell.surface, place.u, place.v);
            const Vec3d p = at.point.point;
            const double over = (swept_.lowest(p.x, p.y).height - p.z) * at.normal.z;
            if (over > scallop_ && at.normal.z >= kUpright && !hidden(at)) {
                all.push_back({at, over});
            }
        }
    }
    std::sort(all.begin(), all.end(), [](const High& a, const High& b) { return a.over > b.over; });
    double most = 0;
    for (const High& high : all) {
        if (high.over <= most) {
            break;
        }
        most = std::max(most, left_at(high.at, std::max(scallop_, most)));
    }
    return most;
}

}  // namespace cusp::host
