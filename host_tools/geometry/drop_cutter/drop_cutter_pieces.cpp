// The tree of pieces: Bezier patches, halved when needed, each with its box and the plane over it.
#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/drop_cutter/drop_cutter_state.hpp"

namespace cusp::drop_cutter {

using nurbs::BezierPatch;
using nurbs::Surface;
using toolpath::Tool;

namespace {

constexpr double kSteepest = 60.0;  // planes beyond this slope are not used as z(x, y)
// The kept halves.
constexpr std::size_t kMostHalves = 40000;
constexpr std::size_t kMostBytes = 20'000'000;
constexpr std::size_t kMostSpare = 16;  // rooms kept

// Copies `from` with room for so many bytes of halves. Room that is never written takes no memory; lists
// that grow leave holes behind.
template <class T>
void begin_with(const std::vector<T>& from, std::vector<T>& to)
{
    to.reserve(from.size() + kMostBytes / sizeof(T));
    to = from;
}

// Halves `stride` interleaved Bezier polynomials of `count` coefficients each by de Casteljau's
// algorithm: `low` becomes the first half, `high` the second.
template <class Coefficient>
void halve_line(Coefficient* low, Coefficient* high, std::size_t count, std::size_t stride)
{
    constexpr std::size_t kCubic = 4;
    if (count == kCubic) {
        for (std::size_t k = 0; k < stride; ++k) {
            const Coefficient a = low[k];
            const Coefficient b = low[k + stride];
            const Coefficient c = low[k + 2 * stride];
            const Coefficient d = low[k + 3 * stride];
            const Coefficient ab = 0.5 * (a + b);
            const Coefficient bc = 0.5 * (b + c);
            const Coefficient cd = 0.5 * (c + d);
            const Coefficient abc = 0.5 * (ab + bc);
            const Coefficient bcd = 0.5 * (bc + cd);
            low[k + stride] = ab;
            low[k + 2 * stride] = abc;
            low[k + 3 * stride] = high[k] = 0.5 * (abc + bcd);
            high[k + stride] = bcd;
            high[k + 2 * stride] = cd;
            high[k + 3 * stride] = d;
        }
        return;
    }
    std::copy_n(low, count * stride, high);
    for (std::size_t level = 1; level < count; ++level) {
        std::copy(high, high + stride, low + (level - 1) * stride);
        for (std::size_t k = 0; k < (count - level) * stride; ++k) {
            high[k] = 0.5 * (high[k] + high[k + stride]);
        }
    }
    std::copy(high, high + stride, low + (count - 1) * stride);
}

}  // namespace

DropCutter::State::State(const std::vector<Surface>& surfaces, const Tool& tool, double accuracy)
    : tool_{tool}, accuracy_{accuracy}
{
    const auto floor = std::make_shared<Floor>();
    floor_ = floor;
    floor->surfaces = surfaces;
    std::vector<Piece> whole;  // patches
    if (std::any_of(surfaces.begin(), surfaces.end(),
                    [](const Surface& s) { return !s.trims.empty(); })) {
        for (const Surface& surface : surfaces) {
            floor->trims.emplace_back(surface, 0.5 * accuracy);
        }
    }
    for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
        add_patches(*floor, s, whole);
    }
    pieces_.resize(kRoot + 1);  // child 0 means none
    gather(kRoot, kRoot, whole.data(), whole.data() + whole.size());
    floor->pieces = std::move(pieces_);
    floor->nets = std::move(nets_);
    floor->weights = std::move(weights_);
    floor->outlines = std::move(outlines_);
    begin_with_whole_pieces();
}

// Adds the pieces of a surface, each a whole patch, to `whole`.
void DropCutter::State::add_patches(Floor& floor, std::uint32_t s, std::vector<Piece>& whole)
{
    const Surface& whole_surface = floor.surfaces[s];
    for (const BezierPatch& patch : bezier_patches(whole_surface)) {
        const Surface& bezier = patch.surface;
        Piece piece{};
        piece.patch = static_cast<std::uint32_t>(floor.patches.size());
        piece.net = static_cast<std::uint32_t>(nets_.size());
        piece.u = piece.v = {0.0F, 1.0F};
        const bool even = std::all_of(bezier.weights.begin(), bezier.weights.end(),
                                      [](double w) { return w == 1.0; });
        for (std::size_t i = 0; i < bezier.points.size(); ++i) {
            nets_.push_back(bezier.points[i] * bezier.weights[i]);
        }
        if (!even) {
            weights_.resize(piece.net);
            weights_.insert(weights_.end(), bezier.weights.begin(), bezier.weights.end());
        }
        floor.patches.push_back({s, static_cast<std::uint32_t>(bezier.degree_u + 1),
                                 static_cast<std::uint32_t>(bezier.degree_v + 1), !even,
                                 patch.u_begin, patch.u_end, patch.v_begin, patch.v_end});
        constexpr double kSame = 1e-12;
        const auto at_edge = [](double a, double b, std::uint8_t bit) {
            return std::abs(a - b) < kSame ? bit : std::uint8_t{0};
        };
        piece.border = static_cast<std::uint8_t>(
            at_edge(patch.u_begin, whole_surface.u_begin(), kFirstRow) |
            at_edge(patch.u_end, whole_surface.u_end(), kLastRow) |
            at_edge(patch.v_begin, whole_surface.v_begin(), kFirstColumn) |
            at_edge(patch.v_end, whole_surface.v_end(), kLastColumn));
        measure(piece);
        piece.cut = !floor.trims.empty() && floor.trims[s].trimmed();
        trim(piece);
        whole.push_back(piece);
        floor.lowest = std::min(floor.lowest, piece.z0);
        floor.highest = std::max(floor.highest, piece.z1);
    }
}

DropCutter::State::State(const State& other, ForThread /*tag*/)
    : tool_{other.tool_}, accuracy_{other.accuracy_}, floor_{other.floor_}
{
    take_spare_rooms();
    begin_with_whole_pieces();
}

DropCutter::State::~State()
{
    const std::lock_guard lock{floor_->guard};
    if (floor_->spare.size() < kMostSpare) {
        floor_->spare.push_back(
            {std::move(pieces_), std::move(nets_), std::move(weights_), std::move(outlines_)});
    }
}

void DropCutter::State::take_spare_rooms()
{
    const std::lock_guard lock{floor_->guard};
    if (!floor_->spare.empty()) {
        Rooms rooms = std::move(floor_->spare.back());
        floor_->spare.pop_back();
        pieces_ = std::move(rooms.pieces);
        nets_ = std::move(rooms.nets);
        weights_ = std::move(rooms.weights);
        outlines_ = std::move(rooms.outlines);
    }
}

void DropCutter::State::begin_with_whole_pieces()
{
    begin_with(floor_->pieces, pieces_);
    begin_with(floor_->nets, nets_);
    if (!floor_->weights.empty()) {
        begin_with(floor_->weights, weights_);
    }
    begin_with(floor_->outlines, outlines_);
    last_ = kRoot;
    beside_ = kRoot;
}

std::size_t DropCutter::State::bytes_of_halves() const
{
    return (pieces_.size() - floor_->pieces.size()) * sizeof(Piece) +
           (nets_.size() - floor_->nets.size()) * sizeof(Vec3d) +
           (weights_.size() - floor_->weights.size()) * sizeof(double) +
           (outlines_.size() - floor_->outlines.size()) * sizeof(Outline);
}

// Without this the halves of a long series of queries would accumulate: gigabytes for a large steep
// floor. Pieces are halved again when a later query needs them.
void DropCutter::State::forget_many_halves()
{
    if (pieces_.size() < floor_->pieces.size() + kMostHalves && bytes_of_halves() < kMostBytes) {
        return;
    }
    begin_with_whole_pieces();
}

// Makes pieces_[place], a child of `parent`, the root of a tree over the patches [first, last). A
// group is split along the longer side of its box at the median of its patches' centres.
void DropCutter::State::gather(std::uint32_t place, std::uint32_t parent, Piece* first, Piece* last)
{
    if (last - first == 1) {
        pieces_[place] = *first;
        pieces_[place].parent = parent;
        return;
    }
    Piece group{};
    group.patch = kGroup;
    group.parent = parent;
    group.x0 = group.y0 = group.z0 = kUnbounded;
    group.x1 = group.y1 = group.z1 = -kUnbounded;
    for (const Piece* piece = first; piece != last; ++piece) {
        group.x0 = std::min(group.x0, piece->x0);
        group.y0 = std::min(group.y0, piece->y0);
        group.z0 = std::min(group.z0, piece->z0);
        group.x1 = std::max(group.x1, piece->x1);
        group.y1 = std::max(group.y1, piece->y1);
        group.z1 = std::max(group.z1, piece->z1);
    }
    if (first != last) {
        const bool by_x = group.x1 - group.x0 > group.y1 - group.y0;
        Piece* const middle = first + (last - first) / 2;
        std::nth_element(first, middle, last, [by_x](const Piece& a, const Piece& b) {
            return by_x ? a.x0 + a.x1 < b.x0 + b.x1 : a.y0 + a.y1 < b.y0 + b.y1;
        });
        group.child = static_cast<std::uint32_t>(pieces_.size());
        pieces_.resize(pieces_.size() + 2);
        gather(group.child, place, first, middle);
        gather(group.child + 1, place, middle, last);
    }
    pieces_[place] = group;
}

void DropCutter::State::measure(Piece& piece)
{
    const Patch& patch = patch_of(piece);
    const std::size_t size = std::size_t{patch.rows} * patch.columns;
    if (patch.weighted) {
        unweighted_.resize(size);
        for (std::size_t i = 0; i < size; ++i) {
            unweighted_[i] = nets_[piece.net + i] / weights_[piece.net + i];
        }
    }
    const Vec3d* const points = points_of(piece);
    Vec3d low = points[0];
    Vec3d high = low;
    for (std::size_t i = 1; i < size; ++i) {
        const Vec3d& p = points[i];
        low = {std::min(p.x, low.x), std::min(p.y, low.y), std::min(p.z, low.z)};
        high = {std::max(p.x, high.x), std::max(p.y, high.y), std::max(p.z, high.z)};
    }
    piece.x0 = low.x;
    piece.y0 = low.y;
    piece.z0 = low.z;
    piece.x1 = high.x;
    piece.y1 = high.y;
    piece.z1 = high.z;
    measure_plane(piece);
    piece.outline = 0;
    piece.outlined = false;
    if (!piece.cut) {  // trim() measures the outline of one that is
        measure_outline(piece);
    }
}

void DropCutter::State::measure_plane(Piece& piece) const
{
    const Patch& patch = patch_of(piece);
    const Vec3d* const points = points_of(piece);
    const std::size_t last = std::size_t{patch.rows} * patch.columns - 1;
    const Vec3d c00 = points[0];
    const Vec3d c01 = points[patch.columns - 1];
    const Vec3d c10 = points[last + 1 - patch.columns];
    const Vec3d c11 = points[last];
    Vec3d normal = cross((c10 - c00) + (c11 - c01), (c01 - c00) + (c11 - c10));
    normal = normal.z < 0.0 ? -normal : normal;
    piece.graph = normal.z * kSteepest > norm(normal);
    piece.uphill = {0.0, 0.0};
    if (!piece.graph) {
        measure_wall(piece, normal);
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
    const double run = 1.0 + g.x * g.x;
    double low = kUnbounded;
    double high = -kUnbounded;
    std::array<double, 4> ends{kUnbounded, -kUnbounded, kUnbounded, -kUnbounded};
    for (const Vec3d* p = points; p != points + last + 1; ++p) {
        const double z_at_origin = p->z - g.x * p->x - g.y * p->y;
        low = std::min(z_at_origin, low);
        high = std::max(z_at_origin, high);
        const double first = p->x + g.x * p->z;
        const double second = run * p->y + g.y * (p->z - g.x * p->x);
        ends = {std::min(first, ends[0]), std::max(first, ends[1]), std::min(second, ends[2]),
                std::max(second, ends[3])};
    }
    const double along = 1.0 / std::sqrt(run);
    const double aside = along / piece.secant;
    piece.lateral = {along * ends[0], along * ends[1], aside * ends[2], aside * ends[3]};
    piece.z_at_origin = high;
    piece.thickness = high - low;
}

// normal  across its corners, of any length
void DropCutter::State::measure_wall(Piece& piece, Vec3d normal) const
{
    const double level = elementary::hypot(normal.x, normal.y);
    if (!(level > 0.0)) {
        return;
    }
    const Patch& patch = patch_of(piece);
    const Vec3d* const points = points_of(piece);
    const Vec3d* const end = points + std::size_t{patch.rows} * patch.columns;
    const Vec3d n = normal / norm(normal);
    const Vec2d uphill{-normal.x / level, -normal.y / level};
    double most = -kUnbounded;
    std::array<double, 4> ends{kUnbounded, -kUnbounded, kUnbounded, -kUnbounded};
    for (const Vec3d* p = points; p != end; ++p) {
        const double forth = uphill.x * p->x + uphill.y * p->y;
        const double aside = uphill.x * p->y - uphill.y * p->x;
        most = std::max(most, dot(n, *p));
        ends = {std::min(forth, ends[0]), std::max(forth, ends[1]), std::min(aside, ends[2]),
                std::max(aside, ends[3])};
    }
    piece.uphill = uphill;
    piece.lateral = ends;
    piece.z_at_origin = most;
    piece.rise = n.z;
}

void DropCutter::State::halve(std::uint32_t index)
{
    ++halvings_;
    const Piece piece = pieces_[index];
    const Patch& patch = patch_of(piece);
    const std::size_t rows = patch.rows;
    const std::size_t columns = patch.columns;
    const std::size_t size = rows * columns;
    const auto place = [&](std::size_t i) {
        const std::size_t at = piece.net + i;
        return patch.weighted ? nets_[at] / weights_[at] : nets_[at];
    };
    // Halved along the longer side, measured between the corners.
    const double long_u =
        norm(place((rows - 1) * columns) - place(0)) + norm(place(size - 1) - place(columns - 1));
    const double long_v =
        norm(place(columns - 1) - place(0)) + norm(place(size - 1) - place((rows - 1) * columns));
    const bool by_u = columns == 1 || (rows > 1 && long_u > long_v);
    // Along u all columns are halved at once.
    const std::size_t lines = by_u ? 1 : rows;
    const std::size_t count = by_u ? rows : columns;
    const std::size_t stride = by_u ? columns : 1;
    const std::size_t base = nets_.size();
    make_room(nets_, size);
    nets_.resize(base + size);
    if (patch.weighted) {
        make_room(weights_, base + size - weights_.size());
        weights_.resize(base + size);
    }
    for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t from = line * count * stride;
        halve_line(&nets_[piece.net + from], &nets_[base + from], count, stride);
        if (patch.weighted) {
            halve_line(&weights_[piece.net + from], &weights_[base + from], count, stride);
        }
    }
    const auto child = static_cast<std::uint32_t>(pieces_.size());
    pieces_[index].child = child;
    make_room(pieces_, 2);
    pieces_.insert(pieces_.end(), 2, piece);
    Piece& first = pieces_[child];
    Piece& second = pieces_[child + 1];
    first.parent = second.parent = index;
    second.net = static_cast<std::uint32_t>(base);
    (by_u ? first.u : first.v)[1] = (by_u ? second.u : second.v)[0] =
        by_u ? 0.5F * (piece.u[0] + piece.u[1]) : 0.5F * (piece.v[0] + piece.v[1]);
    first.border &= static_cast<std::uint8_t>(by_u ? ~kLastRow : ~kLastColumn);
    second.border &= static_cast<std::uint8_t>(by_u ? ~kFirstRow : ~kFirstColumn);
    for (Piece* half : {&first, &second}) {
        measure(*half);
        trim(*half);
    }
}

}  // namespace cusp::drop_cutter
