// The region is divided across at all corners of its loops; what continues is joined again.
#include "host_tools/cam/finishing/column_outlines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cusp::finishing {

namespace {

constexpr double kNarrowest = 1e-7;       // mm: strips between corners
constexpr double kContinues = 1e-6;       // mm: ends of pieces that belong together
constexpr std::size_t kMostSkipped = 64;  // corners of a loop that one side replaces

struct Side {
    Vec2d from;  // the one with the lesser x
    Vec2d to;

    double at(double x) const
    {
        return x <= from.x ? from.y
               : x >= to.x ? to.y
                           : from.y + (to.y - from.y) * (x - from.x) / (to.x - from.x);
    }
};

// A piece that may go on: its lower and its upper polyline so far.
struct Piece {
    Outline lower;
    Outline upper;

    bool continues(Vec2d low, Vec2d high) const
    {
        return std::abs(lower.back().x - low.x) <= kContinues &&
               std::abs(lower.back().y - low.y) <= kContinues &&
               std::abs(upper.back().y - high.y) <= kContinues;
    }
    Outline outline() const
    {
        Outline out = lower;
        out.insert(out.end(), upper.rbegin(), upper.rend());
        return out;
    }
};

double distance_to_chord(Vec2d p, Vec2d a, Vec2d b)
{
    const Vec2d way = b - a;
    const double square = dot(way, way);
    const double share = square > 0 ? std::clamp(dot(p - a, way) / square, 0.0, 1.0) : 0.0;
    const Vec2d off = p - a - way * share;
    return std::sqrt(dot(off, off));
}

// A corner on the straight way between its neighbours is none.
void append(Outline& line, Vec2d next)
{
    if (line.size() > 1 &&
        distance_to_chord(line.back(), line[line.size() - 2], next) <= kNarrowest) {
        line.back() = next;
    } else {
        line.push_back(next);
    }
}

std::vector<Side> sides_of(const std::vector<Outline>& loops)
{
    std::vector<Side> out;
    for (const Outline& loop : loops) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Vec2d a = loop[k];
            const Vec2d b = loop[(k + 1) % loop.size()];
            if (a.x != b.x) {
                out.push_back(a.x < b.x ? Side{a, b} : Side{b, a});
            }
        }
    }
    std::sort(out.begin(), out.end(), [](const Side& a, const Side& b) {
        return std::pair{a.from.x, a.from.y} < std::pair{b.from.x, b.from.y};
    });
    return out;
}

// Places at which the region is divided across.
std::vector<double> places_of(const std::vector<Side>& sides, double longest)
{
    std::vector<double> corners;
    for (const Side& side : sides) {
        corners.push_back(side.from.x);
        corners.push_back(side.to.x);
    }
    std::sort(corners.begin(), corners.end());
    std::vector<double> out;
    for (const double x : corners) {
        if (!out.empty() && x - out.back() > longest) {
            const double from = out.back();
            const auto parts = std::ceil((x - from) / longest);
            for (int k = 1; k < static_cast<int>(parts); ++k) {
                out.push_back(from + (x - from) * k / parts);
            }
        }
        if (out.empty() || x > out.back()) {
            out.push_back(x);
        }
    }
    return out;
}

}  // namespace

Outline simplified(const Outline& loop, double most_off)
{
    Outline out;
    for (std::size_t k = 0; k < loop.size();) {
        out.push_back(loop[k]);
        std::size_t next = k + 1;
        while (next + 1 < loop.size() && next - k < kMostSkipped) {
            const bool fits = std::all_of(
                loop.begin() + static_cast<std::ptrdiff_t>(k + 1),
                loop.begin() + static_cast<std::ptrdiff_t>(next + 1),
                [&](Vec2d p) { return distance_to_chord(p, loop[k], loop[next + 1]) <= most_off; });
            if (!fits) {
                break;
            }
            ++next;
        }
        k = next;
    }
    return out;
}

Outline clipped(const Outline& loop, Vec2d inward, double least)
{
    Outline out;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec2d a = loop[k];
        const Vec2d b = loop[(k + 1) % loop.size()];
        const double from = dot(a, inward) - least;
        const double to = dot(b, inward) - least;
        if (from >= 0) {
            out.push_back(a);
        }
        if ((from < 0) != (to < 0)) {
            out.push_back(a + (b - a) * (from / (from - to)));
        }
    }
    return out;
}

// Over 60 lines: one sweep, whose state all its steps share.
std::vector<Outline> column_outlines(const std::vector<Outline>& loops,
                                     double longest,
                                     std::size_t most_corners)
{
    const std::vector<Side> sides = sides_of(loops);
    const std::vector<double> places = places_of(sides, longest);
    std::vector<Outline> out;
    std::vector<Piece> open;
    std::vector<Side> across;
    std::size_t next = 0;
    for (std::size_t k = 1; k < places.size(); ++k) {
        const double from = places[k - 1];
        const double to = places[k];
        for (; next < sides.size() && sides[next].from.x <= from; ++next) {
            across.push_back(sides[next]);
        }
        across.erase(std::remove_if(across.begin(), across.end(),
                                    [&](const Side& side) { return side.to.x < to; }),
                     across.end());
        if (to - from <= kNarrowest) {
            continue;
        }
        const double middle = 0.5 * (from + to);
        std::sort(across.begin(), across.end(),
                  [&](const Side& a, const Side& b) { return a.at(middle) < b.at(middle); });
        std::vector<Piece> still;
        for (std::size_t i = 0; i + 1 < across.size(); i += 2) {
            const auto ends = [&](double x) {
                const double a = across[i].at(x);
                const double b = across[i + 1].at(x);
                return std::pair{Vec2d{x, std::min(a, b)}, Vec2d{x, std::max(a, b)}};
            };
            if (across[i + 1].at(middle) - across[i].at(middle) <= kNarrowest) {
                continue;
            }
            const auto [low, high] = ends(from);
            const auto goes_on =
                std::find_if(open.begin(), open.end(), [&, a = low, b = high](const Piece& piece) {
                    return piece.continues(a, b) && from - piece.lower.front().x < longest &&
                           piece.lower.size() + piece.upper.size() < most_corners;
                });
            Piece piece{{low}, {high}};
            if (goes_on != open.end()) {
                piece = std::move(*goes_on);
                open.erase(goes_on);
            }
            const auto [low_end, high_end] = ends(to);
            append(piece.lower, low_end);
            append(piece.upper, high_end);
            still.push_back(std::move(piece));
        }
        for (const Piece& piece : open) {
            out.push_back(piece.outline());
        }
        open = std::move(still);
    }
    for (const Piece& piece : open) {
        out.push_back(piece.outline());
    }
    return out;
}

}  // namespace cusp::finishing
