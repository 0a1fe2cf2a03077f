// Branch and bound over halved Bezier patches.
#include "host_tools/clearing/tip_floor.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/offset/contour.hpp"

namespace cusp::host {

namespace {

constexpr double kSteepest = 60.0;  // planes beyond this slope are not used as z(x, y)
constexpr std::size_t kStack = 256;

double excess(double low, double high, double x) { return std::max({low - x, 0.0, x - high}); }

}  // namespace

TipFloor::TipFloor(const std::vector<Surface>& surfaces, const Tool& tool, double accuracy)
    : tool_{tool}, accuracy_{accuracy}, surfaces_{surfaces}
{
    pieces_.push_back({});  // child 0 means none
    for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
        for (const BezierPatch& patch : bezier_patches(surfaces_[s])) {
            const Surface& bezier = patch.surface;
            Piece piece{};
            piece.patch = static_cast<std::uint32_t>(patches_.size());
            piece.net = static_cast<std::uint32_t>(nets_.size());
            piece.u = piece.v = {0.0F, 1.0F};
            for (std::size_t i = 0; i < bezier.points.size(); ++i) {
                const double w = bezier.weights[i];
                const Vec3d p = bezier.points[i];
                nets_.push_back({p.x * w, p.y * w, p.z * w, w});
            }
            patches_.push_back({s, static_cast<std::uint32_t>(bezier.degree_u + 1),
                                static_cast<std::uint32_t>(bezier.degree_v + 1), patch.u_begin,
                                patch.u_end, patch.v_begin, patch.v_end});
            measure(piece);
            roots_.push_back(static_cast<std::uint32_t>(pieces_.size()));
            pieces_.push_back(piece);
            lowest_ = std::min(lowest_, piece.z0);
            highest_ = std::max(highest_, piece.z1);
        }
    }
}

void TipFloor::measure(Piece& piece) const
{
    const Patch& patch = patches_[piece.patch];
    corners_.clear();
    piece.x0 = piece.y0 = piece.z0 = 1e300;
    piece.x1 = piece.y1 = piece.z1 = -1e300;
    for (std::size_t i = 0; i < patch.rows * patch.columns; ++i) {
        const Homogeneous& q = nets_[piece.net + i];
        const Vec3d p = q.w == 1.0 ? Vec3d{q.x, q.y, q.z} : Vec3d{q.x, q.y, q.z} / q.w;
        corners_.push_back(p);
        piece.x0 = std::min(piece.x0, p.x);
        piece.y0 = std::min(piece.y0, p.y);
        piece.z0 = std::min(piece.z0, p.z);
        piece.x1 = std::max(piece.x1, p.x);
        piece.y1 = std::max(piece.y1, p.y);
        piece.z1 = std::max(piece.z1, p.z);
    }
    measure_plane(piece, corners_);
}

void TipFloor::measure_plane(Piece& piece, const std::vector<Vec3d>& points) const
{
    const Patch& patch = patches_[piece.patch];
    const Vec3d c00 = points[0];
    const Vec3d c01 = points[patch.columns - 1];
    const Vec3d c10 = points[(patch.rows - 1) * patch.columns];
    const Vec3d c11 = points[patch.rows * patch.columns - 1];
    Vec3d normal = cross((c10 - c00) + (c11 - c01), (c01 - c00) + (c11 - c10));
    normal = normal.z < 0.0 ? -normal : normal;
    piece.graph = normal.z * kSteepest > norm(normal);
    if (!piece.graph) {
        return;
    }
    const Vec2d g{-normal.x / normal.z, -normal.y / normal.z};
    piece.gradient = g;
    const double square = dot(g, g);
    piece.secant = std::sqrt(1.0 + square);
    const double slope = std::sqrt(square);
    const double c = tool_.corner_radius;
    const double flat = tool_.radius - c;
    piece.rise = slope * flat + c * (piece.secant - 1.0);
    piece.contact = (slope > 0.0 ? flat / slope : 0.0) + c / piece.secant;
    const double along = 1.0 / std::sqrt(1.0 + g.x * g.x);
    const double aside = 1.0 / (piece.secant * std::sqrt(1.0 + g.x * g.x));
    double low = 1e300;
    double high = -1e300;
    piece.lateral = {1e300, -1e300, 1e300, -1e300};
    for (const Vec3d p : points) {
        const double level = p.z - g.x * p.x - g.y * p.y;
        low = std::min(low, level);
        high = std::max(high, level);
        const double first = along * (p.x + g.x * p.z);
        const double second = aside * ((1.0 + g.x * g.x) * p.y + g.y * (p.z - g.x * p.x));
        piece.lateral[0] = std::min(piece.lateral[0], first);
        piece.lateral[1] = std::max(piece.lateral[1], first);
        piece.lateral[2] = std::min(piece.lateral[2], second);
        piece.lateral[3] = std::max(piece.lateral[3], second);
    }
    piece.level = high;
    piece.thickness = high - low;
}

void TipFloor::halve(std::uint32_t index) const
{
    const Piece piece = pieces_[index];
    const Patch& patch = patches_[piece.patch];
    const std::size_t rows = patch.rows;
    const std::size_t columns = patch.columns;
    const std::size_t size = rows * columns;
    const auto place = [&](std::size_t i) {
        const Homogeneous& q = nets_[piece.net + i];
        return Vec3d{q.x, q.y, q.z} / q.w;
    };
    // The longer way, by the corners and the middle rows.
    const double long_u =
        norm(place((rows - 1) * columns) - place(0)) + norm(place(size - 1) - place(columns - 1));
    const double long_v =
        norm(place(columns - 1) - place(0)) + norm(place(size - 1) - place((rows - 1) * columns));
    const bool by_u = columns == 1 || (rows > 1 && long_u > long_v);
    const std::size_t lines = by_u ? columns : rows;
    const std::size_t count = by_u ? rows : columns;
    const std::size_t stride = by_u ? columns : 1;
    const std::size_t base = nets_.size();
    nets_.resize(base + size);
    Homogeneous* const low = &nets_[piece.net];
    Homogeneous* const high = &nets_[base];
    std::copy(low, low + size, high);
    // De Casteljau at one half: the first points of each level make one half, the last the other.
    for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t start = by_u ? line : line * columns;
        for (std::size_t level = 1; level < count; ++level) {
            low[start + (level - 1) * stride] = high[start];
            for (std::size_t k = 0; k + level < count; ++k) {
                Homogeneous& a = high[start + k * stride];
                const Homogeneous& b = high[start + (k + 1) * stride];
                a = {0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z), 0.5 * (a.w + b.w)};
            }
        }
        low[start + (count - 1) * stride] = high[start];
    }
    Piece first = piece;
    Piece second = piece;
    second.net = static_cast<std::uint32_t>(base);
    (by_u ? first.u : first.v)[1] = (by_u ? second.u : second.v)[0] =
        by_u ? 0.5F * (piece.u[0] + piece.u[1]) : 0.5F * (piece.v[0] + piece.v[1]);
    measure(first);
    measure(second);
    pieces_[index].child = static_cast<std::uint32_t>(pieces_.size());
    pieces_.push_back(first);
    pieces_.push_back(second);
}

// The highest value of slope y - profile over y in [low, high], at the distance sqrt(away^2 + y^2)
// from the tool's axis: how far a straight edge lifts the tip. The profile is convex, so the value
// has one top; halving finds it to nanometres in a fixed number of steps.
double TipFloor::on_edge(double slope, double away, double low, double high) const
{
    const double r = tool_.radius;
    const double c = tool_.corner_radius;
    const double room = r * r - away * away;
    if (room <= 0.0) {
        return kNothing;
    }
    const double reach = std::sqrt(room);
    low = std::max(low, -reach);
    high = std::min(high, reach);
    if (low > high) {
        return kNothing;
    }
    const auto value = [&](double y) {
        const double out = std::max(0.0, std::sqrt(away * away + y * y) - (r - c));
        return slope * y - (c - std::sqrt(std::max(c * c - out * out, 0.0)));
    };
    if (c == 0.0) {
        return std::max(value(low), value(high));
    }
    if (c == r) {
        const double best = slope * reach / std::sqrt(1.0 + slope * slope);
        return value(std::clamp(best, low, high));
    }
    const auto rising = [&](double y) {
        const double d = std::sqrt(away * away + y * y);
        const double out = d - (r - c);
        if (out <= 0.0 || d == 0.0) {
            return slope > 0.0;
        }
        return slope * d * std::sqrt(std::max(c * c - out * out, 0.0)) > out * y;
    };
    constexpr int kHalvings = 34;
    double a = low;
    double b = high;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (a + b);
        (rising(middle) ? a : b) = middle;
    }
    return std::max({value(a), value(b), value(low), value(high)});
}

// The highest rest of the tool on the piece's plane above the piece's own rectangle. The tip's
// height is concave over the rectangle: where its top lies outside, the best place inside is on an
// edge that faces it.
double TipFloor::on_edges(const Piece& piece, Vec2d at) const
{
    const Vec2d g = piece.gradient;
    const Vec2d contact = at + g * piece.contact;
    const double here = piece.level + g.x * at.x + g.y * at.y;
    double best = kNothing;
    if (contact.x < piece.x0 || contact.x > piece.x1) {
        const double x = (contact.x < piece.x0 ? piece.x0 : piece.x1) - at.x;
        best = here + g.x * x + on_edge(g.y, x, piece.y0 - at.y, piece.y1 - at.y);
    }
    if (contact.y < piece.y0 || contact.y > piece.y1) {
        const double y = (contact.y < piece.y0 ? piece.y0 : piece.y1) - at.y;
        best = std::max(best, here + g.y * y + on_edge(g.x, y, piece.x0 - at.x, piece.x1 - at.x));
    }
    return best;
}

// Upper bound of the tip's height that the piece asks for, as far as it is above `best`; tight
// where halving it would change it by no more than its thickness.
double TipFloor::bound(const Piece& piece, Vec2d at, double best, bool& tight) const
{
    tight = false;
    const Vec2d g = piece.gradient;
    const double by_plane =
        piece.graph ? piece.level + g.x * at.x + g.y * at.y + piece.rise : 1e300;
    if (by_plane <= best) {
        return kNothing;
    }
    const double r = tool_.radius;
    const double c = tool_.corner_radius;
    const double dx = excess(piece.x0, piece.x1, at.x);
    const double dy = excess(piece.y0, piece.y1, at.y);
    const double square = dx * dx + dy * dy;
    if (square >= r * r || piece.z1 <= best) {
        return kNothing;
    }
    if (piece.graph) {
        const Vec2d contact = at + g * piece.contact;
        if (contact.x >= piece.x0 && contact.x <= piece.x1 && contact.y >= piece.y0 &&
            contact.y <= piece.y1) {
            tight = piece.thickness <= accuracy_;
            return std::min(by_plane, piece.z1);
        }
    }
    const double far = std::max(0.0, std::sqrt(square) - (r - c));
    const double by_box = piece.z1 - (c - std::sqrt(std::max(c * c - far * far, 0.0)));
    if (by_box <= best) {
        return kNothing;
    }
    if (!piece.graph) {
        tight = std::max(piece.x1 - piece.x0, piece.y1 - piece.y0) < 5.0 * accuracy_;
        return by_box;
    }
    tight = piece.thickness <= accuracy_;
    return std::min({by_plane, by_box, on_edges(piece, at)});
}

TipFloor::Rest TipFloor::drop(Vec2d at) const
{
    struct Entry {
        double height;
        std::uint32_t piece;
    };
    std::array<Entry, kStack> stack;
    std::size_t depth = 0;
    Rest best{kNothing, {0.0, 0.0}, 0};
    const auto consider = [&](std::uint32_t index) {
        bool tight = false;
        const double height = bound(pieces_[index], at, best.height, tight);
        if (height > best.height && (tight || depth == kStack)) {
            best = {height, pieces_[index].gradient, index};
        } else if (height > best.height) {
            stack[depth++] = {height, index};
        }
    };
    if (last_ != 0 && pieces_[last_].child == 0) {
        consider(last_);
        depth = 0;  // where it is not tight it is met again on the way down
    }
    for (const std::uint32_t root : roots_) {
        consider(root);
        while (depth > 0) {
            const Entry top = stack[--depth];
            if (top.height <= best.height) {
                continue;
            }
            if (pieces_[top.piece].child == 0) {
                halve(top.piece);
            }
            const std::uint32_t child = pieces_[top.piece].child;
            const std::size_t before = depth;
            consider(child);
            consider(child + 1);
            // The more promising half is looked at first.
            if (depth == before + 2 && stack[before].height > stack[before + 1].height) {
                std::swap(stack[before], stack[before + 1]);
            }
        }
    }
    last_ = best.piece;
    return best;
}

// Distance from the ball's centre line to the piece's upright box, or component by component to its
// turned box, whichever says more.
double TipFloor::ball_gap(const Piece& piece, Vec3d a, Vec3d b) const
{
    const auto apart = [](double low, double high, double p, double q) {
        return std::max({low - std::max(p, q), 0.0, std::min(p, q) - high});
    };
    const double ux = apart(piece.x0, piece.x1, a.x, b.x);
    const double uy = apart(piece.y0, piece.y1, a.y, b.y);
    const double uz = apart(piece.z0, piece.z1, a.z, b.z);
    double square = ux * ux + uy * uy + uz * uz;
    if (piece.graph) {
        const Vec2d g = piece.gradient;
        const double run = 1.0 + g.x * g.x;
        const double along = 1.0 / std::sqrt(run);
        const double aside = along / piece.secant;
        const auto first = [&](Vec3d p) {
            return along * (p.x + g.x * p.z);
        };
        const auto second = [&](Vec3d p) {
            return aside * (run * p.y + g.y * (p.z - g.x * p.x));
        };
        const auto over = [&](Vec3d p) {
            return (p.z - g.x * p.x - g.y * p.y - piece.level) / piece.secant;
        };
        const double tx = apart(piece.lateral[0], piece.lateral[1], first(a), first(b));
        const double ty = apart(piece.lateral[2], piece.lateral[3], second(a), second(b));
        const double tz = apart(-piece.thickness / piece.secant, 0.0, over(a), over(b));
        square = std::max(square, tx * tx + ty * ty + tz * tz);
    }
    return std::sqrt(square) - tool_.radius;
}

// Along the axis: how far the tip stays above what the piece asks for while the tool moves from a
// to b. Over the plane that changes evenly, so the ends tell; the box is met by the tool at its
// nearest.
double TipFloor::axial_gap(const Piece& piece, Vec3d a, Vec3d b, double margin) const
{
    const auto apart = [](double low, double high, double p, double q) {
        return std::max({low - std::max(p, q), 0.0, std::min(p, q) - high});
    };
    const double dx = apart(piece.x0, piece.x1, a.x, b.x);
    const double dy = apart(piece.y0, piece.y1, a.y, b.y);
    const double r = tool_.radius;
    const double c = tool_.corner_radius;
    const double away = std::max(0.0, std::sqrt(dx * dx + dy * dy) - margin);
    if (away >= r) {
        return 1e300;
    }
    const double out = std::max(0.0, away - (r - c));
    const double profile = c - std::sqrt(std::max(c * c - out * out, 0.0));
    const double over_box = std::min(a.z, b.z) + profile - piece.z1;
    if (!piece.graph) {
        return over_box;
    }
    const Vec2d g = piece.gradient;
    const auto over_plane = [&](Vec3d p) {
        return p.z - (piece.level + g.x * p.x + g.y * p.y + piece.rise) -
               margin * std::sqrt(dot(g, g));
    };
    return std::max(over_box, std::min(over_plane(a), over_plane(b)));
}

double TipFloor::gap(Vec3d a, Vec3d b, double margin) const
{
    struct Entry {
        std::uint32_t piece;
        Vec3d a, b;
    };
    const bool ball = tool_.corner_radius == tool_.radius;
    const Vec3d up{0.0, 0.0, ball ? tool_.radius : 0.0};
    double least = 0.0;
    std::array<Entry, kStack> stack;
    for (const std::uint32_t root : roots_) {
        std::size_t depth = 0;
        stack[depth++] = {root, a + up, b + up};
        while (depth > 0) {
            const Entry top = stack[--depth];
            const Piece& piece = pieces_[top.piece];
            const double here = ball ? ball_gap(piece, top.a, top.b) - margin
                                     : axial_gap(piece, top.a, top.b, margin);
            if (here >= least) {
                continue;
            }
            const Vec3d move = top.b - top.a;
            const double size = std::max(piece.x1 - piece.x0, piece.y1 - piece.y0);
            const double thin = piece.graph ? piece.thickness / piece.secant : size;
            const double tilt = move.z - dot(piece.gradient, Vec2d{move.x, move.y});
            const double turned = piece.graph ? std::abs(tilt) / piece.secant : norm(move);
            const bool small = norm(move) < accuracy_ && size < accuracy_;
            // Beyond the piece's rectangle its plane tells of metal that is not there: only a
            // ball's turned box knows of the rectangle, for other tools the pieces must be small.
            const bool settled =
                ball ? thin < accuracy_ && turned < accuracy_
                     : thin < 0.5 * accuracy_ && size * piece.secant < 0.05 && norm(move) < 0.05;
            if (settled || small || depth + 2 > kStack) {
                least = std::min(least, here);
                continue;
            }
            const bool halve_move = ball ? turned > thin : norm(move) > size;
            if (halve_move) {
                const Vec3d middle = (top.a + top.b) * 0.5;
                stack[depth++] = {top.piece, top.a, middle};
                stack[depth++] = {top.piece, middle, top.b};
                continue;
            }
            if (piece.child == 0) {
                halve(top.piece);
            }
            const std::uint32_t child = pieces_[top.piece].child;
            stack[depth++] = {child, top.a, top.b};
            stack[depth++] = {child + 1, top.a, top.b};
        }
    }
    return least;
}

bool TipFloor::covers(Vec2d at) const
{
    std::vector<std::uint32_t> stack(roots_);
    while (!stack.empty()) {
        const std::uint32_t index = stack.back();
        stack.pop_back();
        const Piece& piece = pieces_[index];
        if (excess(piece.x0, piece.x1, at.x) > 0.0 || excess(piece.y0, piece.y1, at.y) > 0.0) {
            continue;
        }
        if (std::max(piece.x1 - piece.x0, piece.y1 - piece.y0) < 0.1 * tool_.radius) {
            return true;
        }
        if (piece.child == 0) {
            halve(index);
        }
        stack.push_back(pieces_[index].child);
        stack.push_back(pieces_[index].child + 1);
    }
    return false;
}

TipFloor::Section TipFloor::section(Vec2d at, Vec2d along) const
{
    const Rest rest = drop(at);
    if (rest.height == kNothing) {
        return {0.0, 0.0, 0.0, false};
    }
    const Piece& piece = pieces_[rest.piece];
    const Patch& patch = patches_[piece.patch];
    const Surface& surface = surfaces_[patch.surface];
    const auto middle = [](std::array<float, 2> ends) {
        return 0.5 * static_cast<double>(ends[0] + ends[1]);
    };
    const SurfacePoint s =
        derivatives_at(surface, patch.u0 + (patch.u1 - patch.u0) * middle(piece.u),
                       patch.v0 + (patch.v1 - patch.v0) * middle(piece.v));
    const Vec3d n = upward_normal(s);
    // du : dv of the plan direction: along = x_u du + x_v dv in plan.
    const double bend = s.du.x * s.dv.y - s.du.y * s.dv.x;
    if (std::abs(bend) < 1e-12 || n.z < 1e-3) {
        return {0.0, 0.0, 0.0, false};
    }
    const double du = (along.x * s.dv.y - along.y * s.dv.x) / bend;
    const double dv = (s.du.x * along.y - s.du.y * along.x) / bend;
    const Vec3d tangent = s.du * du + s.dv * dv;
    const Vec3d second = s.duu * (du * du) + s.duv * (2.0 * du * dv) + s.dvv * (dv * dv);
    const Vec2d gradient{-n.x / n.z, -n.y / n.z};
    return {-dot(second, n) / dot(tangent, tangent), tangent.z, dot(gradient, left_normal(along)),
            true};
}

}  // namespace cusp::host
