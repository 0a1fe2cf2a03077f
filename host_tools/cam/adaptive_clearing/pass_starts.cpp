// A raster of the target finds starts. It proves nothing: passes are measured against the swept
// area.
#include "host_tools/cam/adaptive_clearing/pass_starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::adaptive_clearing {

using offset::Box2d;
using offset::Edge;
using offset::edges_of;
using offset::EdgeTree;
using offset::left_normal;
using offset::length;
using offset::point_on;
using offset::Region2d;

namespace {

constexpr double kStartPitch = 1.0 / 12;  // radii
constexpr double kPlaces = 0.101;         // radii between places: a step of a pass
constexpr int kDirections = 32;
constexpr double kProbes[] = {1.03, 1.08, 1.15};  // radii from the place
constexpr double kUpstream = 0.5;                 // radii
constexpr double kNear = 0.45;                    // radii
constexpr int kMostUpstream = 4000;
constexpr double kSame = 1e-9;
constexpr double kFarthest = 2.0;  // radii: edges farther away are not looked for

}  // namespace

PassStarts::PassStarts(const Box2d& box, const Region2d& target, double radius)
    : radius_{radius},
      corner_{box.x0, box.y0},
      pitch_{kStartPitch * radius},
      columns_{std::max(1, static_cast<int>(std::ceil((box.x1 - box.x0) / pitch_)))},
      rows_{std::max(1, static_cast<int>(std::ceil((box.y1 - box.y0) / pitch_)))},
      target_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      size_{radius},
      across_{std::max(1, static_cast<int>(std::ceil((box.x1 - box.x0) / size_)))},
      up_{std::max(1, static_cast<int>(std::ceil((box.y1 - box.y0) / size_)))},
      buckets_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(up_))
{
    const std::vector<Edge> edges = edges_of(target);
    const EdgeTree tree{edges};
    for (int j = 0; j < rows_; ++j) {
        const double y = corner_.y + (j + 0.5) * pitch_;
        double known = 0.0;  // mm to the right in which no edge is met
        bool inside = false;
        for (int i = 0; i < columns_; ++i, known -= pitch_) {
            if (known <= 0.0) {
                const Vec2d p{corner_.x + (i + 0.5) * pitch_, y};
                inside = tree.surrounds(p);
                known = tree.nearest(p, kFarthest * radius_);
            }
            target_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(i)] = inside;
        }
    }
}

std::size_t PassStarts::bucket(Vec2d point) const
{
    const int i = std::clamp(static_cast<int>((point.x - corner_.x) / size_), 0, across_ - 1);
    const int j = std::clamp(static_cast<int>((point.y - corner_.y) / size_), 0, up_ - 1);
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(i);
}

void PassStarts::add(Vec2d place) { buckets_[bucket(place)].push_back({place}); }

void PassStarts::add(const std::vector<Edge>& path)
{
    for (const Edge& edge : path) {
        const int n = std::max(1, static_cast<int>(std::ceil(length(edge) / (kPlaces * radius_))));
        for (int i = 1; i <= n; ++i) {
            add(point_on(edge, static_cast<double>(i) / n));
        }
    }
}

void PassStarts::drop(Vec2d place)
{
    for (Place& p : buckets_[bucket(place)]) {
        p.dropped = p.dropped || norm(p.at - place) < kSame;
    }
}

bool PassStarts::is_stock(Vec2d point, const SweptArea& swept) const
{
    const double x = (point.x - corner_.x) / pitch_;
    const double y = (point.y - corner_.y) / pitch_;
    return x >= 0.0 && y >= 0.0 && x < columns_ && y < rows_ &&
           target_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(x)] &&
           !swept.contains(point);
}

// Headings have the stock in the middle of their right side, or as near to that as room allows.
std::optional<Pose> PassStarts::pose_at(Vec2d place, const SteeringSpace& space) const
{
    bool stock[kDirections];
    bool any = false;
    static const std::array<Vec2d, kDirections> table = [] {
        std::array<Vec2d, kDirections> t;
        for (std::size_t i = 0; i < kDirections; ++i) {
            const double angle = 2 * kPi * static_cast<double>(i) / kDirections;
            t[i] = {elementary::cos(angle), elementary::sin(angle)};
        }
        return t;
    }();
    for (std::size_t i = 0; i < kDirections; ++i) {
        const Vec2d u = table[i];
        stock[i] = std::any_of(std::begin(kProbes), std::end(kProbes), [&](double far) {
            return is_stock(place + u * (far * radius_), space.swept);
        });
        any = any || stock[i];
    }
    if (!any) {
        return std::nullopt;
    }
    for (int i = 0; i < kDirections; ++i) {
        if (!stock[i] || stock[(i + kDirections - 1) % kDirections]) {
            continue;
        }
        int n = 1;
        while (n < kDirections && stock[(i + n) % kDirections]) {
            ++n;
        }
        for (const double share : {0.5, 0.25, 0.75, 0.0, 1.0}) {
            const double angle = 2 * kPi * (i + share * (n - 1)) / kDirections;
            const Pose pose{place, left_normal({elementary::cos(angle), elementary::sin(angle)})};
            if (has_room_to_turn(space, pose)) {
                return pose;
            }
        }
    }
    return std::nullopt;
}

// Those that are not dropped, the nearest first.
std::vector<PassStarts::Place*> PassStarts::places_near(Vec2d point, double reach)
{
    std::vector<std::pair<double, Place*>> near;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            for (Place& p : buckets_[bucket(point + Vec2d{dx * size_, dy * size_})]) {
                const double d = norm(p.at - point);
                if (!p.dropped && d < reach) {
                    near.emplace_back(d, &p);
                }
            }
        }
    }
    std::stable_sort(near.begin(), near.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Place*> result;
    result.reserve(near.size());
    for (const auto& [d, place] : near) {
        result.push_back(place);
    }
    return result;
}

Pose PassStarts::upstream(Pose pose, const SteeringSpace& space)
{
    const Pose first = pose;
    for (int i = 0; i < kMostUpstream; ++i) {
        const Vec2d behind = pose.at - pose.heading * (kUpstream * radius_);
        std::optional<Pose> best;
        for (Place* const p : places_near(behind, kNear * radius_)) {
            const std::optional<Pose> there = pose_at(p->at, space);
            p->dropped = !there;
            if (there && dot(there->heading, pose.heading) > 0.5) {
                best = there;
                break;
            }
        }
        if (!best || (i > 4 && norm(best->at - first.at) < kUpstream * radius_)) {
            return best ? first : pose;
        }
        pose = *best;
    }
    return first;
}

std::optional<Pose> PassStarts::next(Vec2d from, const SteeringSpace& space)
{
    const int i0 = std::clamp(static_cast<int>((from.x - corner_.x) / size_), 0, across_ - 1);
    const int j0 = std::clamp(static_cast<int>((from.y - corner_.y) / size_), 0, up_ - 1);
    std::optional<Pose> best;
    double nearest = kUnbounded;
    for (int ring = 0; ring <= std::max(across_, up_) && (ring - 1) * size_ <= nearest; ++ring) {
        for (int j = std::max(0, j0 - ring); j <= std::min(up_ - 1, j0 + ring); ++j) {
            const bool whole = j == j0 - ring || j == j0 + ring;
            for (int i = i0 - ring; i <= i0 + ring; i += whole || ring == 0 ? 1 : 2 * ring) {
                if (i < 0 || i >= across_) {
                    continue;
                }
                auto& places =
                    buckets_[static_cast<std::size_t>(j) * static_cast<std::size_t>(across_) +
                             static_cast<std::size_t>(i)];
                for (Place& p : places) {
                    const double d = norm(p.at - from);
                    if (p.dropped || d >= nearest) {
                        continue;
                    }
                    if (const std::optional<Pose> pose = pose_at(p.at, space)) {
                        best = pose;
                        nearest = d;
                    } else {
                        p.dropped = true;
                    }
                }
                places.erase(std::remove_if(places.begin(), places.end(),
                                            [](const Place& p) { return p.dropped; }),
                             places.end());
            }
        }
    }
    return best ? std::optional{upstream(*best, space)} : std::nullopt;
}

}  // namespace cusp::adaptive_clearing
