// Branch and bound over halved Bezier patches.
#include "host_tools/clearing/tip_floor.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {

namespace {

constexpr double kSteepest = 60.0;  // planes beyond this slope are not used as z(x, y)
constexpr std::size_t kStack = 256;

double excess(double low, double high, double x) { return std::max({low - x, 0.0, x - high}); }

// The largest value on [low, high] of a + slope y + sqrt(room - y^2), a cap of a ball over a line.
double cap_on_interval(double slope, double room, double low, double high)
{
    const double reach = std::sqrt(room);
    const double best = slope * reach / std::sqrt(1.0 + slope * slope);
    const double y = std::clamp(best, std::max(low, -reach), std::min(high, reach));
    return slope * y + std::sqrt(std::max(room - y * y, 0.0));
}

}  // namespace

TipFloor::TipFloor(const std::vector<Surface>& surfaces, const Tool& tool, double accuracy)
    : tool_{tool}, accuracy_{accuracy}, surfaces_{surfaces}
{
    pieces_.push_back({});  // child 0 means none
    nets_.push_back({});
    for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
        for (const BezierPatch& patch : bezier_patches(surfaces_[s])) {
            const Surface& bezier = patch.surface;
            Net net;
            for (std::size_t i = 0; i < bezier.points.size(); ++i) {
                const double w = bezier.weights[i];
                const Vec3d p = bezier.points[i];
                net.push_back({p.x * w, p.y * w, p.z * w, w});
            }
            patches_.push_back({s, bezier.degree_u, bezier.degree_v});
            const auto index = static_cast<std::uint32_t>(patches_.size() - 1);
            roots_.push_back(add_piece(std::move(net), index,
                                       {patch.u_begin, patch.u_end, patch.v_begin, patch.v_end}));
            lowest_ = std::min(lowest_, pieces_[roots_.back()].z0);
            highest_ = std::max(highest_, pieces_[roots_.back()].z1);
        }
    }
}

std::uint32_t TipFloor::add_piece(Net net, std::uint32_t patch, std::array<double, 4> domain) const
{
    Piece piece{};
    piece.patch = patch;
    piece.u0 = domain[0];
    piece.u1 = domain[1];
    piece.v0 = domain[2];
    piece.v1 = domain[3];
    measure(piece, net);
    nets_.push_back(std::move(net));
    piece.net = static_cast<std::uint32_t>(nets_.size() - 1);
    pieces_.push_back(piece);
    return static_cast<std::uint32_t>(pieces_.size() - 1);
}

void TipFloor::measure(Piece& piece, const Net& net) const
{
    const auto rows = static_cast<std::size_t>(patches_[piece.patch].degree_u + 1);
    const auto columns = static_cast<std::size_t>(patches_[piece.patch].degree_v + 1);
    std::vector<Vec3d> points(net.size());
    piece.x0 = piece.y0 = piece.z0 = 1e300;
    piece.x1 = piece.y1 = piece.z1 = -1e300;
    for (std::size_t i = 0; i < net.size(); ++i) {
        const Vec3d p = Vec3d{net[i].x, net[i].y, net[i].z} / net[i].w;
        points[i] = p;
        piece.x0 = std::min(piece.x0, p.x);
        piece.y0 = std::min(piece.y0, p.y);
        piece.z0 = std::min(piece.z0, p.z);
        piece.x1 = std::max(piece.x1, p.x);
        piece.y1 = std::max(piece.y1, p.y);
        piece.z1 = std::max(piece.z1, p.z);
    }
    const Vec3d c00 = points[0];
    const Vec3d c01 = points[columns - 1];
    const Vec3d c10 = points[(rows - 1) * columns];
    const Vec3d c11 = points[rows * columns - 1];
    const Vec3d along_u = (c10 - c00) + (c11 - c01);
    const Vec3d along_v = (c01 - c00) + (c11 - c10);
    Vec3d normal = cross(along_u, along_v);
    const double size = norm(normal);
    normal = size > 0.0 ? normal / size : Vec3d{0.0, 0.0, 1.0};
    if (normal.z < 0.0) {
        normal = -normal;
    }
    piece.graph = normal.z * kSteepest > 1.0;
    if (piece.graph) {
        piece.gradient = {-normal.x / normal.z, -normal.y / normal.z};
        double low = 1e300;
        double high = -1e300;
        for (const Vec3d p : points) {
            const double level = p.z - piece.gradient.x * p.x - piece.gradient.y * p.y;
            low = std::min(low, level);
            high = std::max(high, level);
        }
        piece.level = high;
        piece.thickness = high - low;
    }
    piece.normal = normal;
    const double run = norm(along_u);
    Vec3d along = run > 0.0 ? along_u / run : Vec3d{1.0, 0.0, 0.0};
    along = along - normal * dot(along, normal);
    piece.along = norm(along) > 1e-9 ? along / norm(along) : cross(normal, Vec3d{0.0, 1.0, 0.0});
    piece.aside = cross(normal, piece.along);
    piece.origin = c00;
    piece.reach = {1e300, -1e300, 1e300, -1e300, 1e300, -1e300};
    for (const Vec3d p : points) {
        const Vec3d arm = p - piece.origin;
        const double ends[3] = {dot(arm, piece.along), dot(arm, piece.aside), dot(arm, normal)};
        for (std::size_t k = 0; k < 3; ++k) {
            piece.reach[2 * k] = std::min(piece.reach[2 * k], ends[k]);
            piece.reach[2 * k + 1] = std::max(piece.reach[2 * k + 1], ends[k]);
        }
    }
}

void TipFloor::halve(std::uint32_t index) const
{
    const Piece piece = pieces_[index];
    const Net net = nets_[piece.net];
    const auto rows = static_cast<std::size_t>(patches_[piece.patch].degree_u + 1);
    const auto columns = static_cast<std::size_t>(patches_[piece.patch].degree_v + 1);
    const auto place = [&](std::size_t i) {
        return Vec3d{net[i].x, net[i].y, net[i].z} / net[i].w;
    };
    double long_u = 0.0;
    double long_v = 0.0;
    for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t j = 0; j < columns; ++j) {
            const std::size_t at = i * columns + j;
            if (i + 1 < rows) {
                long_u += norm(place(at + columns) - place(at)) / static_cast<double>(columns);
            }
            if (j + 1 < columns) {
                long_v += norm(place(at + 1) - place(at)) / static_cast<double>(rows);
            }
        }
    }
    const bool by_u = long_u > long_v;
    const std::size_t lines = by_u ? columns : rows;
    const std::size_t count = by_u ? rows : columns;
    const std::size_t stride = by_u ? columns : 1;
    Net low = net;
    Net high = net;
    // De Casteljau at one half: the first points of each level make one half, the last the other.
    for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t base = by_u ? line : line * columns;
        for (std::size_t level = 1; level < count; ++level) {
            low[base + (level - 1) * stride] = high[base];
            for (std::size_t k = 0; k + level < count; ++k) {
                Homogeneous& a = high[base + k * stride];
                const Homogeneous& b = high[base + (k + 1) * stride];
                a = {0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z), 0.5 * (a.w + b.w)};
            }
        }
        low[base + (count - 1) * stride] = high[base];
    }
    const double u = 0.5 * (piece.u0 + piece.u1);
    const double v = 0.5 * (piece.v0 + piece.v1);
    const std::array<double, 4> first{piece.u0, by_u ? u : piece.u1, piece.v0, by_u ? piece.v1 : v};
    const std::array<double, 4> second{by_u ? u : piece.u0, piece.u1, by_u ? piece.v0 : v,
                                       piece.v1};
    const std::uint32_t child = add_piece(std::move(low), piece.patch, first);
    add_piece(std::move(high), piece.patch, second);
    nets_[piece.net] = {};
    pieces_[index].child = child;
}

// The highest rest of a ball on the piece's plane above the piece's own rectangle. The ball's lower
// side under the plane is concave over the rectangle: where its top lies outside, it is on an edge.
double TipFloor::on_edges(const Piece& piece, Vec2d at) const
{
    const double r = tool_.radius;
    const Vec2d g = piece.gradient;
    const double here = piece.level + g.x * at.x + g.y * at.y - r;
    double best = kNothing;
    for (const double x : {piece.x0, piece.x1}) {
        const double room = r * r - (x - at.x) * (x - at.x);
        const double low = piece.y0 - at.y;
        const double high = piece.y1 - at.y;
        if (room > 0.0 && low * std::abs(low) < room && high * std::abs(high) > -room) {
            best = std::max(best, here + g.x * (x - at.x) + cap_on_interval(g.y, room, low, high));
        }
    }
    for (const double y : {piece.y0, piece.y1}) {
        const double room = r * r - (y - at.y) * (y - at.y);
        const double low = piece.x0 - at.x;
        const double high = piece.x1 - at.x;
        if (room > 0.0 && low * std::abs(low) < room && high * std::abs(high) > -room) {
            best = std::max(best, here + g.y * (y - at.y) + cap_on_interval(g.x, room, low, high));
        }
    }
    return best;
}

// Upper bound of the tip's height that the piece asks for; tight where halving it would change it
// by no more than its thickness.
double TipFloor::bound(const Piece& piece, Vec2d at, bool& tight) const
{
    tight = false;
    const double dx = excess(piece.x0, piece.x1, at.x);
    const double dy = excess(piece.y0, piece.y1, at.y);
    const double square = dx * dx + dy * dy;
    const double r = tool_.radius;
    if (square >= r * r) {
        return kNothing;
    }
    const double c = tool_.corner_radius;
    const double far = std::max(0.0, std::sqrt(square) - (r - c));
    const double by_box = piece.z1 - (c - std::sqrt(std::max(c * c - far * far, 0.0)));
    if (!piece.graph) {
        tight = std::max(piece.x1 - piece.x0, piece.y1 - piece.y0) < 5.0 * accuracy_;
        return by_box;
    }
    const Vec2d g = piece.gradient;
    const double slope = std::sqrt(dot(g, g));
    const double secant = std::sqrt(1.0 + slope * slope);
    const double by_plane =
        piece.level + g.x * at.x + g.y * at.y + slope * (r - c) + c * (secant - 1.0);
    const double reach = slope > 0.0 ? ((r - c) + c * slope / secant) / slope : 0.0;
    const Vec2d contact = at + g * reach;
    const bool within = contact.x >= piece.x0 && contact.x <= piece.x1 && contact.y >= piece.y0 &&
                        contact.y <= piece.y1;
    tight = piece.thickness <= accuracy_;
    if (within || by_box <= by_plane - 5.0) {
        return std::min(by_plane, by_box);
    }
    if (c == r) {
        return std::min({by_plane, by_box, on_edges(piece, at)});
    }
    const double size = std::max(piece.x1 - piece.x0, piece.y1 - piece.y0);
    tight = tight && size * (1.0 + slope) < 20.0 * accuracy_;
    return std::min(by_plane, by_box);
}

TipFloor::Rest TipFloor::drop(Vec2d at) const
{
    struct Entry {
        double height;
        std::uint32_t piece;
        bool tight;
    };
    std::array<Entry, kStack> stack;
    std::size_t depth = 0;
    Rest best{kNothing, {0.0, 0.0}, 0};
    const auto consider = [&](std::uint32_t index) {
        bool tight = false;
        const double height = bound(pieces_[index], at, tight);
        if (height > best.height && tight) {
            best = {height, pieces_[index].gradient, index};
        } else if (height > best.height && depth < kStack) {
            stack[depth++] = {height, index, tight};
        }
    };
    for (const std::uint32_t root : roots_) {
        consider(root);
        // Only the promising ones are kept; many roots are worked off as they come.
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
    return best;
}

// Distance from the ball's centre line to the piece's turned box, component by component, or to its
// upright box, whichever says more.
double TipFloor::gap_to(const Piece& piece, Vec3d a, Vec3d b) const
{
    const auto apart = [](double low, double high, double p, double q) {
        return std::max({low - std::max(p, q), 0.0, std::min(p, q) - high});
    };
    const double ux = apart(piece.x0, piece.x1, a.x, b.x);
    const double uy = apart(piece.y0, piece.y1, a.y, b.y);
    const double uz = apart(piece.z0, piece.z1, a.z, b.z);
    const Vec3d p = a - piece.origin;
    const Vec3d q = b - piece.origin;
    const auto& r = piece.reach;
    const double tx = apart(r[0], r[1], dot(p, piece.along), dot(q, piece.along));
    const double ty = apart(r[2], r[3], dot(p, piece.aside), dot(q, piece.aside));
    const double tz = apart(r[4], r[5], dot(p, piece.normal), dot(q, piece.normal));
    return std::sqrt(std::max(ux * ux + uy * uy + uz * uz, tx * tx + ty * ty + tz * tz)) -
           tool_.radius;
}

double TipFloor::gap(Vec3d a, Vec3d b, double enough) const
{
    struct Entry {
        std::uint32_t piece;
        Vec3d a, b;
    };
    const Vec3d up{0.0, 0.0, tool_.radius};
    constexpr double kFinest = 0.02;  // of the accuracy: halving ends here
    const double fine = kFinest * accuracy_;
    double least = enough;
    std::array<Entry, kStack> stack;
    for (const std::uint32_t root : roots_) {
        std::size_t depth = 0;
        stack[depth++] = {root, a + up, b + up};
        while (depth > 0) {
            const Entry top = stack[--depth];
            const Piece& piece = pieces_[top.piece];
            const double here = gap_to(piece, top.a, top.b);
            if (here >= least) {
                continue;
            }
            const double thin = piece.reach[5] - piece.reach[4];
            const double turned = std::abs(dot(top.b - top.a, piece.normal));
            const bool small =
                norm(top.b - top.a) < fine &&
                std::max(piece.reach[1] - piece.reach[0], piece.reach[3] - piece.reach[2]) < fine;
            if ((thin < fine && turned < fine) || small || depth + 2 > kStack) {
                least = std::min(least, here);
                continue;
            }
            if (turned > thin) {
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
        if (std::max(piece.x1 - piece.x0, piece.y1 - piece.y0) < 0.01 * tool_.radius) {
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
        return {0.0, 0.0, false};
    }
    const Piece& piece = pieces_[rest.piece];
    const Surface& surface = surfaces_[patches_[piece.patch].surface];
    const SurfacePoint s =
        derivatives_at(surface, 0.5 * (piece.u0 + piece.u1), 0.5 * (piece.v0 + piece.v1));
    const Vec3d n = upward_normal(s);
    // du : dv of the plan direction: along = x_u du + x_v dv in plan.
    const double bend = s.du.x * s.dv.y - s.du.y * s.dv.x;
    if (std::abs(bend) < 1e-12 || n.z < 1e-3) {
        return {0.0, 0.0, false};
    }
    const double du = (along.x * s.dv.y - along.y * s.dv.x) / bend;
    const double dv = (s.du.x * along.y - s.du.y * along.x) / bend;
    const Vec3d tangent = s.du * du + s.dv * dv;
    const Vec3d second = s.duu * (du * du) + s.duv * (2.0 * du * dv) + s.dvv * (dv * dv);
    return {-dot(second, n) / dot(tangent, tangent), tangent.z, true};
}

}  // namespace cusp::host
