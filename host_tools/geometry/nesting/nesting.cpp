// Row by row from the sheet's lower edge, each piece where its cells meet none that are taken.
#include "host_tools/geometry/nesting/nesting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "host_tools/geometry/nesting/cell_mask.hpp"

namespace cusp::nesting {

namespace {

constexpr std::array<double, 4> kTurns{0, 90, 180, 270};
constexpr double kCells = 512;  // along the sheet's longer side

struct Box {
    Vec2d low, high;
    Vec2d size() const { return high - low; }
};

Box box_of(const std::vector<Polyline>& polylines)
{
    std::optional<Box> box;
    for (const Polyline& polyline : polylines) {
        for (const Vec2d p : polyline) {
            box = box ? Box{{std::min(box->low.x, p.x), std::min(box->low.y, p.y)},
                            {std::max(box->high.x, p.x), std::max(box->high.y, p.y)}}
                      : Box{p, p};
        }
    }
    return box.value_or(Box{});
}

std::vector<Polyline> turned(std::vector<Polyline> polylines, double degrees)
{
    for (Polyline& polyline : polylines) {
        for (Vec2d& p : polyline) {
            p = quarter_turned(p, degrees);
        }
    }
    return polylines;
}

struct Nested {
    std::vector<std::vector<Place>> places;
    double used{};  // mm of the sheet, from y = 0

    std::size_t count() const
    {
        return std::accumulate(places.begin(), places.end(), std::size_t{0},
                               [](std::size_t sum, const auto& each) { return sum + each.size(); });
    }
};

// Pieces of one kind in rows of their boxes.
Nested in_rows(const Piece& piece, const Sheet& sheet, double degrees)
{
    const Box box = box_of(turned(piece.polylines, degrees));
    const auto fit = [&](double length, double each) {
        return static_cast<int>(
            std::floor((length - sheet.gap + kNestRounding) / (each + sheet.gap)));
    };
    const int columns = fit(sheet.size.x, box.size().x);
    const int rows = fit(sheet.size.y, box.size().y);
    Nested nested{{{}}};
    for (int i = 0; columns > 0 && i < std::min(piece.count, columns * std::max(rows, 0)); ++i) {
        const Vec2d corner{sheet.gap + (i % columns) * (box.size().x + sheet.gap),
                           sheet.gap + (i / columns) * (box.size().y + sheet.gap)};
        nested.places.front().push_back({degrees, corner - box.low});
        nested.used = corner.y + box.size().y;
    }
    return nested;
}

// A piece, turned: its cells, those that it keeps others from, and where the search for its next place begins.
struct TurnedPiece {
    double degrees;
    Box box;
    CellRuns cells;
    CellMask kept;
    int rows() const { return static_cast<int>(cells.rows.size()); }
    int top() const { return row + rows(); }
    int row{};
    int column{};
};

class Nest {
public:
    explicit Nest(const Sheet& sheet)
        : sheet_{sheet},
          room_{sheet.size.x - 2 * sheet.gap, sheet.size.y - 2 * sheet.gap},
          cell_{std::max(sheet.size.x, sheet.size.y) / kCells},
          margin_{static_cast<int>(std::floor(sheet.gap / cell_)) + 1},
          taken_(cells(sheet.size.x), cells(sheet.size.y))
    {
    }

    // Its places, up to its count.
    std::vector<Place> place(const Piece& piece)
    {
        std::vector<TurnedPiece> choices;
        for (const double degrees : kTurns) {
            const std::vector<Polyline> lines = turned(piece.polylines, degrees);
            const Box box = box_of(lines);
            if (box.size().x > room_.x || box.size().y > room_.y) {
                continue;  // its cells would be without number on a small sheet
            }
            const CellMask cells = filled_mask(lines, box.low, box.high, cell_);
            if (cells.columns() <= taken_.columns() && cells.rows() <= taken_.rows()) {
                CellMask kept = widened(cells, margin_, sheet_.gap, cell_);
                choices.push_back({degrees, box, cells.runs(), std::move(kept)});
            }
        }
        std::vector<Place> places;
        while (static_cast<int>(places.size()) < piece.count) {
            TurnedPiece* const best = lowest(choices);
            if (best == nullptr) {
                break;
            }
            taken_.add(best->kept, best->column - margin_, best->row - margin_);
            const Vec2d corner{sheet_.gap + best->column * cell_, sheet_.gap + best->row * cell_};
            places.push_back({best->degrees, corner - best->box.low});
            used_ = std::max(used_, corner.y + best->box.size().y);
        }
        return places;
    }

    double used() const { return used_; }

private:
    int cells(double length) const
    {
        return std::max(
            static_cast<int>(std::floor((length - 2 * sheet_.gap + kNestRounding) / cell_)), 0);
    }

    // The one whose upper edge is lowest in its next place, then the leftmost; null: none has a place.
    TurnedPiece* lowest(std::vector<TurnedPiece>& choices) const
    {
        TurnedPiece* best = nullptr;
        for (TurnedPiece& each : choices) {
            if (find_place(each) && (best == nullptr || each.top() < best->top() ||
                                     (each.top() == best->top() && each.column < best->column))) {
                best = &each;
            }
        }
        return best;
    }

    // Taken cells stay taken: the search goes on where it ended.
    bool find_place(TurnedPiece& piece) const
    {
        for (; piece.top() <= taken_.rows(); ++piece.row, piece.column = 0) {
            const int column = taken_.free_column(piece.cells, piece.column, piece.row);
            if (column >= 0) {
                piece.column = column;
                return true;
            }
        }
        return false;
    }

    Sheet sheet_;
    Vec2d room_;   // mm: within the gaps to the edges
    double cell_;  // mm
    int margin_;   // cells that a gap reaches
    CellMask taken_;
    double used_{};
};

Nested by_outline(const std::vector<Piece>& pieces, const Sheet& sheet)
{
    std::vector<std::size_t> order(pieces.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto size = [&](std::size_t i) {
        const Vec2d box = box_of(pieces[i].polylines).size();
        return box.x * box.y;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
    Nest nest{sheet};
    Nested nested{std::vector<std::vector<Place>>(pieces.size())};
    for (const std::size_t i : order) {
        nested.places[i] = nest.place(pieces[i]);
    }
    nested.used = nest.used();
    return nested;
}

}  // namespace

Vec2d quarter_turned(Vec2d p, double degrees)
{
    return degrees == kTurns[1]   ? Vec2d{-p.y, p.x}
           : degrees == kTurns[2] ? Vec2d{-p.x, -p.y}
           : degrees == kTurns[3] ? Vec2d{p.y, -p.x}
                                  : p;
}

std::vector<std::vector<Place>> nest(const std::vector<Piece>& pieces, const Sheet& sheet)
{
    std::vector<Nested> choices;
    if (pieces.size() == 1) {
        choices.push_back(in_rows(pieces.front(), sheet, kTurns[0]));
        choices.push_back(in_rows(pieces.front(), sheet, kTurns[1]));
    }
    choices.push_back(by_outline(pieces, sheet));
    return std::max_element(choices.begin(), choices.end(),
                            [](const Nested& a, const Nested& b) {
                                return a.count() != b.count() ? a.count() < b.count()
                                                              : a.used > b.used;
                            })
        ->places;
}

}  // namespace cusp::nesting
