// Cuts a pocket in memory, move by move, and judges entries, links and retracts. No code of
// the planner is used.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::test {

struct MovesVerdict {
    double rapid_cut{};  // mm, deepest
    bool low_rapid{};    // a rapid move below the clearance that is not straight up or down
    double plunged{};    // mm of stock under the middle of the tool on a vertical plunge
    double entry_cut{};  // mm, deepest there on slopes steeper than entries may be
    double sunk{};       // mm there on descents faster than the plunge feed
    double deepest{};    // mm of cut
    int retracts{};      // up to the clearance
    int links{};
    int turned{};           // links that end on a corner of more than 30 degrees
    double wrong_side{};    // mm^3 that cuts remove on the wrong side of the cutter
    double right_side{};    // mm^3 from that
    double nearest_wall{};  // mm, of the tool's axis below the top
};

class MovesJudge {
public:
    // share: of the smallest tool's radius, between places
    MovesJudge(const offset::Region2d& region, double top, double smallest, double largest)
        : region_{region}, top_{top}, pitch_{smallest / 10}, sliver_{0.03 * smallest}
    {
        const offset::Box2d box = box_of(region);
        low_ = {box.x0 - largest, box.y0 - largest};
        columns_ = static_cast<int>((box.x1 - low_.x + largest) / pitch_) + 2;
        rows_ = static_cast<int>((box.y1 - low_.y + largest) / pitch_) + 2;
        heights_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), top);
    }

    MovesVerdict cut(const toolpath::Toolpath& path, double clearance, bool climb)
    {
        MovesVerdict verdict;
        verdict.nearest_wall = 1e300;
        Vec3d at{};
        Vec2d along{};
        toolpath::MoveKind before = toolpath::MoveKind::kRapid;
        for (std::size_t i = 0; i < path.moves.size(); ++i) {
            const toolpath::ToolMove& move = path.moves[i];
            const double feed = feed_of(path, move, at);
            for (const Vec3d p : points_of(move, at, 0.004)) {
                if (i > 0) {
                    judge_places(path.tool, move.kind, at, p, clearance, climb, verdict);
                    const double down = feed * (at.z - p.z);
                    if (down > 1.01 * path.plunge_feed * norm(p - at)) {
                        verdict.sunk = std::max(verdict.sunk, middle_);
                    }
                }
                const Vec2d way{p.x - at.x, p.y - at.y};
                at = p;
                if (dot(way, way) > 1e-10) {
                    constexpr double kCorner = 0.866;
                    const bool link = before == toolpath::MoveKind::kLink &&
                                      move.kind == toolpath::MoveKind::kCut;
                    verdict.links += link ? 1 : 0;
                    verdict.turned += link && dot(along, offset::unit(way)) < kCorner ? 1 : 0;
                    along = offset::unit(way);
                    before = move.kind;
                } else if (move.kind == toolpath::MoveKind::kPlunge) {
                    // A move over the stock and straight down is no link, but an entry.
                    before = move.kind;
                }
            }
        }
        return verdict;
    }

    // Height of the stock around the place, the highest of four.
    double height(Vec2d p) const
    {
        const auto i = static_cast<int>((p.x - low_.x) / pitch_);
        const auto j = static_cast<int>((p.y - low_.y) / pitch_);
        double z = -1e300;
        for (const int k : {i, i + 1}) {
            for (const int m : {j, j + 1}) {
                z = std::max(
                    z,
                    heights_[index(std::clamp(k, 0, columns_ - 1), std::clamp(m, 0, rows_ - 1))]);
            }
        }
        return z;
    }

private:
    struct Bite {
        double tracked{};  // mm, by a tool smaller by a sliver
        double middle{};   // mm, under the middle third of it
        double left{};     // mm^3
        double right{};
    };

    std::size_t index(int i, int j) const
    {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(rows_) +
               static_cast<std::size_t>(j);
    }

    Bite bite(const toolpath::Tool& tool, Vec3d tip, Vec3d way)
    {
        Bite bite;
        const double radius = tool.radius;
        toolpath::Tool probe = tool;
        probe.radius -= sliver_;
        probe.corner_radius = std::max(0.0, tool.corner_radius - sliver_);
        const auto first = [&](double at, double low) {
            return std::max(0, static_cast<int>(std::ceil((at - radius - low) / pitch_)));
        };
        const auto last = [&](double at, double low, int count) {
            return std::min(count - 1, static_cast<int>((at + radius - low) / pitch_));
        };
        for (int i = first(tip.x, low_.x); i <= last(tip.x, low_.x, columns_); ++i) {
            for (int j = first(tip.y, low_.y); j <= last(tip.y, low_.y, rows_); ++j) {
                double& height = heights_[index(i, j)];
                if (height <= tip.z) {
                    continue;
                }
                const double x = low_.x + i * pitch_ - tip.x;
                const double y = low_.y + j * pitch_ - tip.y;
                const double out = std::hypot(x, y);
                const double cut = height - tip.z - profile_height(tool, out);
                if (cut <= 0.0) {
                    continue;
                }
                const double tracked = height - tip.z - sliver_ - profile_height(probe, out);
                bite.tracked = std::max(bite.tracked, tracked);
                if (out < radius / 3) {
                    bite.middle = std::max(bite.middle, tracked);
                }
                (way.x * y - way.y * x > 0.0 ? bite.left : bite.right) += cut * pitch_ * pitch_;
                height -= cut;
            }
        }
        return bite;
    }

    void judge_places(const toolpath::Tool& tool,
                      toolpath::MoveKind kind,
                      Vec3d from,
                      Vec3d to,
                      double clearance,
                      bool climb,
                      MovesVerdict& verdict)
    {
        middle_ = 0.0;
        constexpr double kSteepest = 0.1;  // entries' 0.08, and chords of it
        constexpr double kTracked = 0.05;  // mm
        const Vec3d way = to - from;
        const double level = std::hypot(way.x, way.y);
        if (kind == toolpath::MoveKind::kRapid) {
            verdict.low_rapid |= level > 1e-9 && std::min(from.z, to.z) < clearance - 1e-9;
            verdict.retracts += way.z > 0.0 && to.z >= clearance - 1e-9 ? 1 : 0;
        }
        const int n = 1 + static_cast<int>(norm(way) / (0.12 * tool.radius));
        for (int i = 1; i <= n; ++i) {
            const Vec3d tip = from + way * (static_cast<double>(i) / n);
            if (tip.z >= top_) {
                continue;
            }
            verdict.nearest_wall =
                std::min(verdict.nearest_wall, distance_to(region_, {tip.x, tip.y}));
            const Bite bite = this->bite(tool, tip, way);
            middle_ = std::max(middle_, bite.middle);
            verdict.deepest = std::max(verdict.deepest, bite.tracked);
            if (kind == toolpath::MoveKind::kRapid) {
                verdict.rapid_cut = std::max(verdict.rapid_cut, bite.tracked);
            } else if (kind == toolpath::MoveKind::kPlunge && level < 1e-9 && way.z < 0.0) {
                verdict.plunged = std::max(verdict.plunged, bite.middle);
            } else if (kind == toolpath::MoveKind::kPlunge && -way.z > kSteepest * level) {
                verdict.entry_cut = std::max(verdict.entry_cut, bite.middle);
            } else if ((kind == toolpath::MoveKind::kCut ||
                        kind == toolpath::MoveKind::kPlungingCut) &&
                       bite.tracked > kTracked) {
                add_sides(bite, climb, verdict);
            }
        }
    }

    // With the spindle turning clockwise from above, stock is on the right of a climbing cutter.
    static void add_sides(const Bite& bite, bool climb, MovesVerdict& verdict)
    {
        constexpr double kOneSided = 4.0;
        const double most = std::max(bite.left, bite.right);
        if (most > kOneSided * std::min(bite.left, bite.right)) {
            ((bite.right > bite.left) == climb ? verdict.right_side : verdict.wrong_side) += most;
        }
    }

    const offset::Region2d& region_;
    double top_;
    double pitch_;
    double sliver_;
    Vec2d low_;
    int columns_{};
    int rows_{};
    std::vector<double> heights_;
    double middle_{};  // depth cut by the last move under the middle of the tool, mm
};

}  // namespace cusp::test
