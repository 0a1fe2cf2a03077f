// A rate comes from the operation, the tool or [cutting], in this order; its error names the one that gave it.
#include "host_tools/job/import/job_rates.hpp"

#include <algorithm>

#include "host_tools/job/import/clearing_keys.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/machine_reader.hpp"
#include "host_tools/job/import/material_reader.hpp"
#include "host_tools/job/import/tool_reader.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Job;
using job::MachineLimit;
using job::MachineTool;
using job::Operation;
using toolpath::Tool;

namespace {

const toml::table& cutting_in(JobTable& top, bool needed)
{
    static const toml::table kNothing;
    const toml::table* table = top.table("cutting");
    if (table == nullptr && needed) {
        top.refuse("cutting", "is missing: a table [cutting] with at least feed");
    }
    return table == nullptr ? kNothing : *table;
}

// The machine's bound of this key's rate.
std::optional<MachineLimit> most_of(const MachineTool& machine, const std::string& key)
{
    return key == "spindle"       ? machine.most_spindle
           : key == "plunge_feed" ? machine.most_plunge_feed()
                                  : machine.most_feed();
}

}  // namespace

JobRates::JobRates(JobTable& top,
                   const std::filesystem::path& folder,
                   const std::string& machine,
                   JobTools& tools,
                   Job& job)
    : tools_{tools}, job_{job}
{
    const auto named = top.text("machine");
    if (!machine.empty()) {
        job_.machine = read_machine(machine, "");
    } else if (named) {
        job_.machine = top.blamed("machine", [&] { return read_machine(*named, folder); });
    }
    if (const auto name = top.text("material")) {
        material_ = top.blamed("material", [&] { return read_material(*name, folder); });
    }
    read_cutting(top);
}

void JobRates::read_cutting(JobTable& top)
{
    const bool needed = !tools_.has_feeds() && !material_;
    cutting_.emplace(cutting_in(top, needed), job_.file, "cutting", cutting_table().keys,
                     top.unit());
    cutting_->check();
    if (needed && !cutting_->has("feed")) {
        cutting_->refuse("feed", "is missing: not all tools have one");
    }
    job_.feed = cutting_->number("feed").value_or(0);
    // cutter makers recommend a quarter of the feed for plunging where they give no figure
    job_.plunge_feed = cutting_->number("plunge_feed").value_or(job_.feed / 4);
    job_.spindle = cutting_->number_or_default("spindle");
    cutting_->check_all_read();
}

// The table that gives the tool this rate; null where none does.
const JobTable* JobRates::giver_of(const JobTable& table, const Tool& tool, const char* key) const
{
    for (const JobTable* const place : {&table, &tools_.table_of(tool.number), &*cutting_}) {
        if (place->has(key)) {
            return place;
        }
        if (std::string{key} == "plunge_feed" && place->has("feed")) {
            return nullptr;  // it is a quarter of that feed
        }
    }
    return nullptr;
}

// The rate within the machine's limits: lowered where nobody gave it, else refused with the key that did.
double JobRates::bounded(const JobTable* giver, const char* key, double value) const
{
    const bool is_speed = std::string{key} == "spindle";
    const char* const unit = is_speed ? "rpm" : "mm/min";
    const auto refuse = [&](const MachineLimit& limit, const char* side) {
        const std::string words =
            fmt::format("the {:.6g} {} of {}", limit.value, unit, limit.place);
        giver->refuse(key, fmt::format("is {:.6g} {}, {} {}", value, unit, side, words), words);
    };
    const auto most = most_of(job_.machine, key);
    const auto& least = job_.machine.least_spindle;
    if (most && value > most->value) {
        if (giver != nullptr) {
            refuse(*most, "above");
        }
        return most->value;
    }
    if (is_speed && least && value > 0 && value < least->value && giver != nullptr) {
        refuse(*least, "below");
    }
    return value;
}

void JobRates::check(const JobTable& table, Tool& tool) const
{
    const toolpath::CuttingRates rates = rates_of(job_, tool);
    const auto checked = [&](const char* key, double value) {
        return bounded(giver_of(table, tool, key), key, value);
    };
    checked("feed", rates.feed);
    checked("spindle", *rates.spindle);
    if (const double plunge = checked("plunge_feed", rates.plunge_feed);
        plunge < rates.plunge_feed) {
        tool.rates.plunge_feed = plunge;
    }
}

// Gives the tool what neither it nor the job has. A note says whence.
void JobRates::fill_in(Tool& tool) const
{
    const bool lacks_feed = !(rates_of(job_, tool).feed > 0);
    const bool lacks_spindle = !tool.rates.spindle && !cutting_->has("spindle");
    if (!material_ || (!lacks_feed && !lacks_spindle)) {
        return;
    }
    job::RatedTool rated{tool, tools_.facts_of(tool.number).flutes};
    if (!lacks_spindle) {
        rated.spindle = rates_of(job_, tool).spindle;
    }
    const job::MaterialRates found = rates_in(*material_, rated, job_.machine);
    const std::string note =
        fmt::format("tool {}: {}", tool.number, words_of(*material_, rated, found));
    if (std::find(job_.notes.begin(), job_.notes.end(), note) == job_.notes.end()) {
        job_.notes.push_back(note);
    }
    if (lacks_spindle) {
        tool.rates.spindle = found.rates.spindle;
    }
    if (lacks_feed) {
        tool.rates.feed = found.rates.feed;
    }
    if (!(rates_of(job_, tool).plunge_feed > 0)) {
        tool.rates.plunge_feed = found.rates.plunge_feed;
    }
}

void JobRates::choose_tools(JobTable& table, Operation& operation) const
{
    operation.tool = tools_.tool(table);
    operation.tools = tools_.tools(table);
    if (operation.tools.empty()) {
        operation.tools.push_back(operation.tool);
    }
    const auto finish = [&](Tool& tool) {
        read_rates(table, tool);
        fill_in(tool);
        check(table, tool);
    };
    finish(operation.tool);
    std::for_each(operation.tools.begin(), operation.tools.end(), finish);
}

void JobRates::read_load(JobTable& table, Operation& operation) const
{
    read_chip_load(table, operation);
    if (!operation.passes.chip_load) {
        return;
    }
    const auto& [least, greatest] = *operation.passes.chip_load;
    for (const auto& [key, value] :
         {std::pair{"feed_min", least}, std::pair{"feed_max", greatest}}) {
        if (value) {
            bounded(&table, key, *value);
        }
    }
}

}  // namespace cusp::import
