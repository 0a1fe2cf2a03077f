// A side of the stock is given by its place or by a margin of the part, not by both.
#include "host_tools/job/import/stock_table.hpp"

#include <algorithm>

#include "host_tools/base/files/file_set.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/placing_reader.hpp"
#include "host_tools/job/import/stock_top.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::crossing_of;
using job::encloses;
using job::Job;
using job::loop_polyline;

namespace {

constexpr double kOutlineGap = 0.02;  // mm: between ends of curves, that is closed
const toml::table kNoStock;

// Beside the middle of each side of a counter-clockwise polyline, inside.
std::vector<Vec2d> places_inside(const std::vector<Vec2d>& closed)
{
    constexpr double kInside = 0.01;  // mm
    std::vector<Vec2d> places;
    for (std::size_t i = 0; i + 1 < closed.size(); ++i) {
        const Vec2d side = closed[i + 1] - closed[i];
        if (const double size = norm(side); size > 0) {
            places.push_back(0.5 * (closed[i] + closed[i + 1]) +
                             (kInside / size) * Vec2d{-side.y, side.x});
        }
    }
    return places;
}

// True if there is stock inside the loop. The loop may run along the stock's edge.
bool has_stock(const job::Loop& loop, const std::vector<job::Loop>& stock)
{
    constexpr double kChord = 1e-3;  // mm
    const std::vector<Vec2d> pocket = loop_polyline(loop, kChord);
    std::vector<std::vector<Vec2d>> edges;
    for (const job::Loop& edge : stock) {
        edges.push_back(loop_polyline(edge, kChord));
    }
    const auto is_stock = [&](Vec2d p) {
        return encloses(edges.front(), p) &&
               std::none_of(edges.begin() + 1, edges.end(),
                            [&](const std::vector<Vec2d>& hole) { return encloses(hole, p); });
    };
    const std::vector<Vec2d> of_pocket = places_inside(pocket);
    const std::vector<Vec2d> of_stock = places_inside(edges.front());
    edges.push_back(pocket);
    const bool crosses = crossing_of(edges).has_value();
    edges.pop_back();
    return crosses || std::any_of(of_pocket.begin(), of_pocket.end(), is_stock) ||
           std::any_of(of_stock.begin(), of_stock.end(),
                       [&](Vec2d p) { return encloses(pocket, p); });
}

}  // namespace

std::vector<std::string> read_programs(JobTable& table,
                                       const char* key,
                                       const std::filesystem::path& folder)
{
    std::vector<std::string> programs;
    const auto names = table.texts(key);
    for (const std::string& name : table.all_texts(key)) {
        programs.push_back(path_in(folder, name));
        if (!files::is_file(programs.back())) {
            table.refuse(key, fmt::format("names {}, which is no file", programs.back()));
        }
    }
    if (names && names->empty()) {
        table.refuse(key, "names no program");
    }
    return programs;
}

StockTable::StockTable(const toml::table* table,
                       const std::string& file,
                       const std::filesystem::path& folder,
                       double millimetres,
                       Job& job)
    : keys_{table == nullptr ? kNoStock : *table, file, "stock", stock_table().keys, millimetres}
{
    keys_.check();
    top_ = keys_.number("top");
    job.stock_top = top_.value_or(0.0);
    job.clearance = keys_.number_or_default("clearance");
    job.stock_bottom = keys_.number("bottom");
    job.least_floor = keys_.number_or_default("least_floor");
    job.stock_x = keys_.extent("x");
    job.stock_y = keys_.extent("y");
    if (const auto outline = keys_.text("outline")) {
        outline_ = path_in(folder, *outline);
    }
    if (const auto margin = keys_.numbers("margin")) {
        margin_ = std::array{margin->front(), margin->back()};
    }
    margin_top_ = keys_.number("margin_top");
    margin_bottom_ = keys_.number("margin_bottom");
    job.stock_programs = read_programs(keys_, "program", folder);
    keys_.check_all_read();
}

void StockTable::read_outline(PartFiles& parts, Job& job) const
{
    if (outline_.empty()) {
        return;
    }
    const std::vector<FileLoop> loops = keys_.blamed("outline", [&] {
        return parts.loops(outline_, keys_.unit(), {kOutlineGap, std::nullopt});
    });
    job.stock_outline.clear();
    for (const FileLoop& loop : loops) {
        if (loop.depth > 1 || (loop.depth == 0) != job.stock_outline.empty()) {
            keys_.refuse("outline", fmt::format("{} bounds a second body: the stock is one, with "
                                                "or without holes",
                                                loop.name));
        }
        job.stock_outline.push_back(loop.loop);
    }
    const PartExtent box = extent_of_curves(job.stock_outline.front());
    job.stock_x = std::array{box.low.x, box.high.x};
    job.stock_y = std::array{box.low.y, box.high.y};
}

void StockTable::check_pockets(const Job& job) const
{
    for (const job::Operation& operation : job.operations) {
        if (operation.outline.boundary &&
            !has_stock(*operation.outline.boundary, job.stock_outline)) {
            const PartExtent box = extent_of_curves(*operation.outline.boundary);
            keys_.refuse(
                "outline",
                fmt::format("{} has no stock in the pocket {} of operation {}, x {:.6g} to {:.6g}, "
                            "y {:.6g} to {:.6g} mm: the stock's box is x {:.6g} to {:.6g}, y "
                            "{:.6g} to {:.6g}",
                            outline_, operation.outline.boundary_file, operation.number, box.low.x,
                            box.high.x, box.low.y, box.high.y, (*job.stock_x)[0], (*job.stock_x)[1],
                            (*job.stock_y)[0], (*job.stock_y)[1]));
        }
    }
}

void StockTable::settle_sides(Job& job) const
{
    const std::optional<PartExtent> box = plan_extent(job);
    if (!box) {
        keys_.refuse("margin", "no operation has a floor or a drawing: give x and y");
    }
    job.stock_x = std::array{box->low.x - (*margin_)[0], box->high.x + (*margin_)[0]};
    job.stock_y = std::array{box->low.y - (*margin_)[1], box->high.y + (*margin_)[1]};
}

void StockTable::settle_heights(Job& job) const
{
    const std::optional<PartExtent> floors = floors_extent(job);
    if (!floors) {
        keys_.refuse(margin_top_ ? "margin_top" : "margin_bottom",
                     "no operation has a floor: give top and bottom");
    }
    if (margin_top_) {
        job.stock_top = (job.part_top ? floors->high.z : job.stock_top) + *margin_top_;
    }
    if (margin_bottom_) {
        job.stock_bottom = floors->low.z - *margin_bottom_;
    }
}

void StockTable::settle(Job& job) const
{
    job.part_top = part_top(job);
    job.stock_top = top_ ? *top_ : default_stock_top(job);
    if (margin_) {
        settle_sides(job);
    }
    if (!outline_.empty()) {
        check_pockets(job);
    }
    if (margin_top_ || margin_bottom_) {
        settle_heights(job);
    }
    if (job.stock_bottom && !(*job.stock_bottom < job.stock_top)) {
        keys_.refuse("bottom",
                     fmt::format("is {:g} mm, not below the top at {:g} mm{}", *job.stock_bottom,
                                 job.stock_top, top_ ? "" : ", the part's"));
    }
}

}  // namespace cusp::import
