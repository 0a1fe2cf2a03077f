// A side of the stock is given by its place or by a margin of the part, not by both.
#include "host_tools/import/stock_table.hpp"

#include "host_tools/import/known_keys.hpp"
#include "host_tools/import/placing_reader.hpp"
#include "host_tools/import/stock_top.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Job;

namespace {

constexpr double kDefaultClearance = 5.0;  // mm
const toml::table kNoStock;

}  // namespace

std::vector<std::string> read_programs(JobTable& table,
                                       const char* key,
                                       const std::filesystem::path& folder)
{
    std::vector<std::string> files;
    const auto names = table.texts(key);
    for (const std::string& name : names.value_or(std::vector<std::string>{})) {
        files.push_back(path_in(folder, name));
        if (!std::filesystem::is_regular_file(files.back())) {
            table.refuse(key, fmt::format("names {}, which is no file", files.back()));
        }
    }
    if (names && names->empty()) {
        table.refuse(key, "names no program");
    }
    return files;
}

StockTable::StockTable(const toml::table* table,
                       const std::string& file,
                       const std::filesystem::path& folder,
                       double millimetres,
                       Job& job)
    : keys_{table == nullptr ? kNoStock : *table, file, "stock", stock_keys()}, unit_{millimetres}
{
    top_ = keys_.length("top", kAnyNumber, unit_);
    job.stock_top = top_.value_or(0.0);
    job.clearance = keys_.length("clearance", kPositive, unit_).value_or(kDefaultClearance);
    job.stock_bottom = keys_.length("bottom", kAnyNumber, unit_);
    job.least_floor = keys_.length("least_floor", kNotNegative, unit_).value_or(job::kLeastFloor);
    job.stock_x = keys_.extent("x", unit_);
    job.stock_y = keys_.extent("y", unit_);
    read_margin();
    margin_top_ = keys_.length("margin_top", kNotNegative, unit_);
    margin_bottom_ = keys_.length("margin_bottom", kNotNegative, unit_);
    job.stock_programs = read_programs(keys_, "program", folder);
    const auto refuse_both = [&](bool both, const char* margin, const char* place) {
        if (both) {
            keys_.refuse(margin, fmt::format("is given beside {}: one of them", place));
        }
    };
    refuse_both(margin_ && job.stock_x, "margin", "x");
    refuse_both(margin_ && job.stock_y, "margin", "y");
    refuse_both(margin_top_ && top_, "margin_top", "top");
    refuse_both(margin_bottom_ && job.stock_bottom, "margin_bottom", "bottom");
    keys_.check_all_read();
}

void StockTable::read_margin()
{
    const auto values = keys_.one_or_more("margin", kNotNegative);
    if (!values) {
        return;
    }
    if (values->empty() || values->size() > 2) {
        keys_.refuse("margin", fmt::format("has {} numbers: one for all sides, or [in x, in y]",
                                           values->size()));
    }
    margin_ = std::array{values->front() * unit_, values->back() * unit_};
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
