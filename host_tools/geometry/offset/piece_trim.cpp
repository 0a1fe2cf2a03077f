// Trims from both ends inward, then from the middle outward. Each step removes the part of a piece
// in a disc around one point of the source.
#include "host_tools/geometry/offset/piece_trim.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::offset {

namespace {

constexpr double kNearerBy = 1e-5;  // mm: trimmed parts are nearer to the source by this at least
constexpr int kSteps = 12;          // discs at one end
constexpr int kDepth = 6;           // halvings

// A piece by a parameter: length along a line, angle along an arc.
class Track {
public:
    explicit Track(const Edge& edge) : edge_{edge}
    {
        if (edge.turn == 0) {
            size_ = distance(edge.start, edge.end);
            way_ = unit(edge.end - edge.start);
        } else {
            size_ = sweep(edge);
            way_ = unit(edge.start - edge.centre);
        }
    }

    double size() const { return size_; }

    Vec2d at(double t) const
    {
        if (t <= 0.0 || t >= size_) {
            return t <= 0.0 ? edge_.start : edge_.end;
        }
        if (edge_.turn == 0) {
            return edge_.start + way_ * t;
        }
        const Vec2d aside = left_normal(way_) * edge_.turn;
        return edge_.centre +
               (way_ * elementary::cos(t) + aside * elementary::sin(t)) * edge_.radius;
    }

    Edge part(double from, double to) const { return between(edge_, at(from), at(to)); }

    struct Range {
        double from;
        double to;
    };

    // The interval around t inside the disc. Precondition: the point at t is inside.
    Range in_disc(double t, Vec2d centre, double radius) const
    {
        if (edge_.turn == 0) {
            const Vec2d arm = centre - edge_.start;
            const double foot = dot(arm, way_);
            const double away = cross(way_, arm);
            const double half = std::sqrt(std::max(radius * radius - away * away, 0.0));
            return {foot - half, foot + half};
        }
        const Vec2d arm = centre - edge_.centre;
        const double apart = std::sqrt(dot(arm, arm));
        const double r = edge_.radius;
        const double cosine = (r * r + apart * apart - radius * radius) / (2.0 * r * apart);
        if (!(cosine > -1.0)) {
            return {0.0, size_};
        }
        const double half = elementary::acos(std::min(cosine, 1.0));
        double middle = elementary::atan2(cross(way_, arm) * edge_.turn, dot(way_, arm));
        middle += middle < t - kPi ? 2.0 * kPi : middle > t + kPi ? -2.0 * kPi : 0.0;
        return {middle - half, middle + half};
    }

private:
    const Edge& edge_;
    Vec2d way_;
    double size_{};
};

class PieceTrimmer {
public:
    // guess  a point of the source that is usually near enough; updated to the last one that was
    PieceTrimmer(const Edge& edge, const EdgeTree& source, double reach, Vec2d& guess)
        : track_{edge}, source_{source}, reach_{reach}, guess_{guess}
    {
    }

    // The remaining intervals, in order.
    const std::vector<Track::Range>& run()
    {
        keep(0.0, track_.size(), 0);
        return kept_;
    }
    const Track& track() const { return track_; }

private:
    // The interval around t that is too near to one point of the source.
    std::optional<Track::Range> too_near(double t) const
    {
        const Vec2d p = track_.at(t);
        if (distance(p, guess_) >= reach_) {
            const auto near = source_.some_nearer(p, reach_);
            if (!near) {
                return std::nullopt;
            }
            guess_ = *near;
        }
        return track_.in_disc(t, guess_, reach_);
    }

    void keep(double from, double to, int depth)
    {
        for (int i = 0; i < kSteps && from < to; ++i) {
            const auto gone = too_near(from);
            if (!gone || gone->to <= from) {
                break;
            }
            from = gone->to;
        }
        for (int i = 0; i < kSteps && from < to; ++i) {
            const auto gone = too_near(to);
            if (!gone || gone->from >= to) {
                break;
            }
            to = gone->from;
        }
        if (from >= to) {
            return;
        }
        const double middle = 0.5 * (from + to);
        const auto gone = depth < kDepth ? too_near(middle) : std::nullopt;
        if (gone) {
            keep(from, std::min(gone->from, middle), depth + 1);
            keep(std::max(gone->to, middle), to, depth + 1);
        } else {
            kept_.push_back({from, to});
        }
    }

    Track track_;
    const EdgeTree& source_;
    double reach_;
    Vec2d& guess_;
    std::vector<Track::Range> kept_;
};

}  // namespace

std::vector<RawPiece> trimmed(const std::vector<RawPiece>& pieces,
                              const EdgeTree& source,
                              double distance)
{
    std::vector<RawPiece> result;
    std::size_t contour = 0;   // where the contour begins in the result
    bool whole_start = false;  // the start of its first piece is not trimmed
    bool whole_end = false;    // the end of the piece before is not trimmed
    bool first = true;
    Vec2d guess{kUnbounded, kUnbounded};
    for (const RawPiece& piece : pieces) {
        PieceTrimmer trimmer{piece.edge, source, distance - kNearerBy, guess};
        const auto& kept = trimmer.run();
        const double size = trimmer.track().size();
        const bool from_start = !kept.empty() && kept.front().from <= 0.0;
        if (first) {
            contour = result.size();
            whole_start = from_start;
        } else if (result.size() > contour && !(whole_end && from_start)) {
            result.back().joined = false;
        }
        for (const Track::Range& range : kept) {
            result.push_back(
                {trimmer.track().part(range.from, range.to), false, false, piece.origin});
        }
        whole_end = !kept.empty() && kept.back().to >= size;
        if (whole_end) {
            result.back().joined = piece.joined;
        }
        first = piece.last;
        if (piece.last && result.size() > contour) {
            result.back().last = true;
            result.back().joined = result.back().joined && whole_end && whole_start;
        }
    }
    return result;
}

}  // namespace cusp::offset
