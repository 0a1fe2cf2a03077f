// A side of the stock is given by its place or by a margin of the part, not by both.
#include "host_tools/import/stock_table.hpp"

#include "host_tools/import/known_keys.hpp"
#include "host_tools/import/stock_top.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Job;

namespace {

constexpr double kDefaultClearance = 5.0;  // mm
const toml::table kNoStock;

}  // namespace

StockTable::StockTable(const toml::table* table,
                       const std::string& file,
                       double millimetres,
                       Job& job)
    : keys_{table == nullptr ? kNoStock : *table, file, "stock", stock_keys()}, unit_{millimetres}
{
    top_ = length("top", kAnyNumber);
    job.clearance = length("clearance", kPositive).value_or(kDefaultClearance);
    job.stock_bottom = length("bottom", kAnyNumber);
    job.stock_x = interval("x");
    job.stock_y = interval("y");
    read_margin();
    margin_top_ = length("margin_top", kNotNegative);
    margin_bottom_ = length("margin_bottom", kNotNegative);
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

std::optional<double> StockTable::length(const char* key, Range range)
{
    const auto value = keys_.number(key, range);
    return value ? std::optional{*value * unit_} : std::nullopt;
}

std::optional<std::array<double, 2>> StockTable::interval(const char* key)
{
    const auto values = keys_.numbers(key, kAnyNumber);
    if (!values) {
        return std::nullopt;
    }
    if (values->size() != 2 || !((*values)[0] < (*values)[1])) {
        keys_.refuse(key, "two numbers [min, max] are needed, min below max");
    }
    return std::array{(*values)[0] * unit_, (*values)[1] * unit_};
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

void StockTable::settle_box(Job& job) const
{
    const PartExtent parts = extent_of_job(job);
    if (margin_) {
        job.stock_x = std::array{parts.low.x - (*margin_)[0], parts.high.x + (*margin_)[0]};
        job.stock_y = std::array{parts.low.y - (*margin_)[1], parts.high.y + (*margin_)[1]};
    }
    if (margin_top_) {
        job.stock_top = (job.part_top ? parts.high.z : job.stock_top) + *margin_top_;
    }
    if (margin_bottom_) {
        job.stock_bottom = parts.low.z - *margin_bottom_;
    }
}

void StockTable::settle(Job& job) const
{
    job.part_top = part_top(job);
    job.stock_top = top_ ? *top_ : default_stock_top(job);
    if (margin_ || margin_top_ || margin_bottom_) {
        settle_box(job);
    }
    if (job.stock_bottom && !(*job.stock_bottom < job.stock_top)) {
        keys_.refuse("bottom",
                     fmt::format("is {:g} mm, not below the top at {:g} mm{}", *job.stock_bottom,
                                 job.stock_top, top_ ? "" : ", the part's"));
    }
}

}  // namespace cusp::import
