// Reads the TOML job: every key with its range, inches to millimetres, the parts it names.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/geometry/part_model/model_intersection.hpp"
#include "host_tools/job/import/clearing_keys.hpp"
#include "host_tools/job/import/fixture_reader.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/job_rates.hpp"
#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/job_tools.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/import/placing_reader.hpp"
#include "host_tools/job/import/post_reader.hpp"
#include "host_tools/job/import/prismatic_reader.hpp"
#include "host_tools/job/import/setup_reader.hpp"
#include "host_tools/job/import/stock_table.hpp"
#include "host_tools/job/import/text_reader.hpp"
#include "host_tools/job/import/trim_loops.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::CutDirection;
using job::EntryKind;
using job::Job;
using job::Key;
using job::Operation;
using job::OutputForm;
using job::Strategies;
using job::Strategy;
using job::ToleranceSide;
using job::Traversal;
using nurbs::Curve;
using nurbs::Surface;
using part_model::intersection_of;

namespace {

// Refuses keys of the table.
job::Refuse refuse_in(const JobTable& table)
{
    return [&table](const char* key, const std::string& reason) {
        table.refuse(key, reason);
    };
}

class JobReader {
public:
    // job  its folder is the base of relative paths
    JobReader(const JobText& job, const Strategies& strategies, PartFiles& parts)
        : text_{job.text},
          file_{job.name},
          folder_{job.folder},
          machine_{job.machine},
          strategies_{strategies},
          all_keys_{job::all_keys(strategies)},
          parts_{parts}
    {
        job_.file = file_;
    }

    // setup  the place among the set-ups of the one to read; counts them
    Job read(std::size_t setup, std::size_t& setups);

private:
    void read_operation(const toml::table& table, std::size_t index);
    std::optional<std::string> read_boundary(JobTable& table, const Operation& operation);
    std::vector<Operation> read_pockets(JobTable& table,
                                        const DrawingChoice& choice,
                                        Operation operation);
    void read_common(JobTable& table, Operation& operation);
    void read_rest(JobTable& table, Operation& operation);
    void read_depths(JobTable& table, Operation& operation);
    void read_strategy_keys(JobTable& table, const Strategy& strategy, Operation& operation);
    static bool takes_mesh(const Strategy& strategy, const std::vector<std::string>& floor);
    const std::vector<Surface>& surfaces_of(const std::string& path, double floor_tolerance);
    void intersect(JobTable& table, const std::vector<std::string>& bodies, Operation& operation);
    void read_parts(JobTable& table, const Strategy& strategy, Operation& operation);
    void place_files(JobTable& top,
                     const std::vector<const toml::table*>& operations,
                     const std::string& outline);
    void use_tools(const toml::table& table, std::size_t index);
    std::string path_of(const std::string& name) const { return path_in(folder_, name); }

    const std::string& text_;
    std::string file_;
    std::filesystem::path folder_;
    std::string machine_;  // in place of the job's
    const Strategies& strategies_;
    std::vector<Key> all_keys_;
    PartFiles& parts_;
    double unit_{1.0};  // mm, of the job
    Job job_;
    std::optional<JobTools> tools_;
    std::optional<JobRates> rates_;
    // Keys: files of the floor, files it was intersected with, tolerance.
    using Names = std::vector<std::string>;
    std::map<std::tuple<Names, Names, double>, std::vector<Surface>> intersections_;
};

void JobReader::read_common(JobTable& table, Operation& operation)
{
    operation.output =
        *table.chosen("output", {OutputForm::kLines, OutputForm::kArcs, OutputForm::kNurbs});
    operation.tolerance.plan = table.number_or_default("plan_tolerance");
    operation.tolerance.join_gaps = table.number("join_gaps");
    operation.tolerance.floor = table.number_or_default("floor_tolerance");
    operation.tolerance.side =
        *table.chosen("tolerance_side", {ToleranceSide::kOutside, ToleranceSide::kBoth});
    operation.tolerance.scallop = table.number("scallop");
    if (operation.tolerance.scallop && operation.tolerance.side == ToleranceSide::kOutside &&
        *operation.tolerance.scallop <= operation.tolerance.floor) {
        table.refuse("scallop",
                     fmt::format("is {:g} mm, not above the floor_tolerance of {:g} mm that it "
                                 "includes; raise it or set tolerance_side = \"both\"",
                                 *operation.tolerance.scallop, operation.tolerance.floor));
    }
    operation.passes.direction_of_cut =
        *table.chosen("direction_of_cut", {CutDirection::kClimb, CutDirection::kConventional});
    operation.passes.entry = *table.chosen(
        "entry", {EntryKind::kAuto, EntryKind::kHelix, EntryKind::kRamp, EntryKind::kPlunge});
    operation.passes.traversal =
        *table.chosen("traversal", {Traversal::kZigzag, Traversal::kOneWay});
    operation.passes.allowance = table.number_or_default("allowance");
}

void JobReader::read_rest(JobTable& table, Operation& operation)
{
    operation.rest.after = read_programs(table, "after", folder_);
    operation.may_open = table.flag_or_default("may_open");
    operation.rest.tolerance = table.number("rest_tolerance");
    if (operation.rest.tolerance && operation.rest.after.empty() && job_.stock_programs.empty() &&
        !job_.setup) {
        table.refuse("rest_tolerance", "needs after, or program in [stock], or a set-up");
    }
}

void JobReader::read_depths(JobTable& table, Operation& operation)
{
    operation.levels.max_depth = table.number("max_depth");
    operation.levels.min_depth = table.number("min_depth");
    if (operation.levels.max_depth && operation.levels.min_depth &&
        *operation.levels.min_depth > *operation.levels.max_depth) {
        table.refuse("min_depth",
                     fmt::format("is {:g} mm, above the max_depth of {:g} mm",
                                 *operation.levels.min_depth, *operation.levels.max_depth));
    }
    double above = 0;
    for (const double depth : table.numbers("layers").value_or(std::vector<double>{})) {
        if (depth <= above) {
            table.refuse("layers", "depths below stock.top must grow from layer to layer");
        }
        above = depth;
        operation.levels.layers.push_back(above);
    }
}

void JobReader::read_strategy_keys(JobTable& table, const Strategy& strategy, Operation& operation)
{
    operation.passes.roughing = table.flag_or_default("roughing");
    if (strategy.parameters != nullptr) {
        operation.parameters =
            strategy.parameters(table.values(strategy.own), operation, refuse_in(table));
    }
    operation.passes.step_over = table.number("step_over");
    read_clearing(table, strategy, operation);
    rates_->read_load(table, operation);
}

// True if the strategy plans on the triangles themselves, without a height field.
bool JobReader::takes_mesh(const Strategy& strategy, const std::vector<std::string>& floor)
{
    return strategy.traits.takes_mesh && std::all_of(floor.begin(), floor.end(), is_mesh_file);
}

const std::vector<Surface>& JobReader::surfaces_of(const std::string& path, double floor_tolerance)
{
    // half of the floor tolerance is the budget of a mesh's height field
    return parts_.surfaces(path, unit_, floor_tolerance / 2);
}

// Intersects the floor with every one of `bodies`.
void JobReader::intersect(JobTable& table,
                          const std::vector<std::string>& bodies,
                          Operation& operation)
{
    for (const std::string& name : bodies) {
        operation.part.intersect_files.push_back(path_of(name));
    }
    const auto [found, is_new] = intersections_.try_emplace(
        {operation.part.floor_files, operation.part.intersect_files, operation.tolerance.floor});
    std::vector<Surface>& floor = found->second;
    if (is_new) {
        std::vector<std::vector<Surface>> models{operation.part.floor};
        for (const std::string& file : operation.part.intersect_files) {
            models.push_back(surfaces_of(file, operation.tolerance.floor));
        }
        floor = intersection_of(models);
        for (Surface& surface : floor) {
            std::vector<Curve> trims;
            for (const std::vector<Curve>& loop : surface.trims) {
                trims.insert(trims.end(), loop.begin(), loop.end());
            }
            surface.trims = trim_loops(trims, surface, file_ + ": intersect");
        }
    }
    if (floor.empty()) {
        table.refuse("intersect", "leaves nothing of the floor: in plan they do not overlap");
    }
    operation.part.floor = floor;
}

void JobReader::read_parts(JobTable& table, const Strategy& strategy, Operation& operation)
{
    const std::vector<std::string> floor = table.all_texts("floor");
    const std::vector<std::string> bodies = table.all_texts("intersect");
    const bool mesh = bodies.empty() && takes_mesh(strategy, floor);
    for (const std::string& name : floor) {
        operation.part.floor_files.push_back(path_of(name));
        if (mesh) {
            const Triangles& triangles = parts_.mesh(operation.part.floor_files.back(), unit_);
            operation.part.mesh.insert(operation.part.mesh.end(), triangles.begin(),
                                       triangles.end());
        } else {
            const std::vector<Surface>& surfaces =
                surfaces_of(operation.part.floor_files.back(), operation.tolerance.floor);
            operation.part.floor.insert(operation.part.floor.end(), surfaces.begin(),
                                        surfaces.end());
        }
    }
    if (mesh) {
        parts_.close_mesh(operation.part.floor_files, operation.part.mesh);
    }
    if (operation.part.floor.empty() && operation.part.mesh.empty()) {
        table.refuse("floor", "is missing: files with the surfaces to cut");
    }
    if (!bodies.empty()) {
        intersect(table, bodies, operation);
    }
}

// The file of the loops or curves that are cut, or what the operation spells in its place.
std::optional<std::string> JobReader::read_boundary(JobTable& table, const Operation& operation)
{
    const auto file = table.text("boundary");
    const bool spells = find_key(keys_of(*operation.strategy), "text") != nullptr;
    const auto text = spells ? read_text(table, folder_, operation, parts_) : std::nullopt;
    return text ? text : file ? std::optional{path_of(*file)} : std::nullopt;
}

// One operation for each pocket; the operation itself where it has no boundary.
std::vector<Operation> JobReader::read_pockets(JobTable& table,
                                               const DrawingChoice& choice,
                                               Operation operation)
{
    const auto loops_of = [&](const std::string& file) {
        return parts_.loops(file, unit_, {operation.tolerance.plan, operation.tolerance.join_gaps});
    };
    std::vector<FileLoop> islands;
    for (const std::string& name : table.all_texts("islands")) {
        for (const FileLoop& loop : loops_of(path_of(name))) {
            if (loop.depth == 0) {
                islands.push_back(loop);
            }
        }
    }
    if (const auto name = read_boundary(table, operation)) {
        operation.outline.boundary_file = *name;
        const auto loops = without_circles(loops_of(*name), choice.except_diameters);
        return pockets_of(operation, loops, islands);
    }
    for (const FileLoop& island : islands) {
        operation.outline.islands.push_back(island.loop);
        operation.outline.island_files.push_back(island.name);
    }
    return {std::move(operation)};
}

// Once: parts that were read before the job was lie where it puts them.
//
// outline  the drawing of the stock; may be empty
void JobReader::place_files(JobTable& top,
                            const std::vector<const toml::table*>& operations,
                            const std::string& outline)
{
    const auto placings = read_placings(top, folder_);
    if (parts_.is_placed()) {
        return;
    }
    PlacedFiles files = files_of_operations(operations, folder_);
    if (!outline.empty()) {
        files.drawings.push_back(outline);
    }
    try {
        place_parts(placings, files, unit_, parts_);
    } catch (const PlacingError& error) {  // others name the file
        top.refuse("placing", error.what());
    }
}

// Tools of other set-ups' operations: their programs may name them by their numbers alone.
void JobReader::use_tools(const toml::table& table, std::size_t index)
{
    JobTable keys{table, file_, fmt::format("operation {}", index), all_keys_};
    tools_->tool(keys);
    tools_->tools(keys);
}

void JobReader::read_operation(const toml::table& entry, std::size_t index)
{
    const std::string place = fmt::format("operation {}", index);
    JobTable any{entry, file_, place, all_keys_};
    Operation operation;
    operation.number = static_cast<int>(index);
    const Strategy& strategy = strategy_of(any, strategies_);
    operation.strategy = &strategy;
    JobTable table{entry, file_, place, keys_of(strategy), unit_, all_keys_};
    table.check();
    table.leave({"strategy", "setup"});
    read_rest(table, operation);
    rates_->choose_tools(table, operation);
    read_common(table, operation);
    read_depths(table, operation);
    read_strategy_keys(table, strategy, operation);
    read_prismatic_keys(table, strategy, operation);
    const DrawingChoice choice = read_drawing_choice(table, operation);
    if (operation.prismatic) {
        if (table.has("floor")) {  // of an engraving
            read_parts(table, strategy, operation);
        }
        table.leave({"floor", "intersect", "islands"});
    } else {
        read_parts(table, strategy, operation);
    }
    if (operation.prismatic && !strategy.traits.pocket) {
        operation.prismatic->file = read_boundary(table, operation).value_or("");
        check_operation(strategy, operation, refuse_in(table));
        read_drawing(table, choice, parts_, operation);
        job_.operations.push_back(std::move(operation));
    } else {
        for (Operation& pocket : read_pockets(table, choice, std::move(operation))) {
            read_reliefs(table, parts_, pocket);
            check_operation(strategy, pocket, refuse_in(table));
            job_.operations.push_back(std::move(pocket));
        }
    }
    table.check_all_read();
}

Job JobReader::read(std::size_t setup, std::size_t& setups)
{
    const toml::table document = parsed_toml(text_, file_);
    JobTable top{document, file_, "", job_table().keys};
    top.take_unit();
    top.check();
    unit_ = top.unit();
    job_.inch = top.choice_or_default("units") == "inch";
    tools_.emplace(top, folder_);
    rates_.emplace(top, folder_, machine_, *tools_, job_);
    const StockTable stock{top.table("stock"), file_, folder_, unit_, job_};
    const SetupTables tables{top, file_, all_keys_};
    setups = tables.all().size();
    job_.fixtures = read_fixtures(top, tables, setup);
    const auto named_post = top.text("post");
    const std::string post = named_post                  ? *named_post
                             : job_.machine.post.empty() ? "cusp"
                                                         : job_.machine.post;
    job_.post =
        top.blamed(named_post ? "post" : "machine", [&] { return read_post(post, folder_); });
    job_.group_by_tool = top.flag_or_default("group_by_tool");
    const auto operations = top.tables("operation");
    place_files(top, operations, stock.outline());
    top.check_all_read();
    tables.check_used(operations);
    stock.read_outline(parts_, job_);
    if (setups > 0) {
        job_.setup = tables.all()[setup];
        parts_.turn_all(tables.turn_of(*job_.setup, job_, stock.has_top()));
        stock.read_outline(parts_, job_);
    }
    for (std::size_t i = 0; i < operations.size(); ++i) {
        if (tables.place_of(*operations[i], i + 1) == setup) {
            read_operation(*operations[i], i + 1);
        } else {
            use_tools(*operations[i], i + 1);
        }
    }
    tools_->store(job_);
    stock.settle(job_);
    check_sheet(job_);
    settle_levels(job_);
    // files that several operations name say the same again
    for (const std::string& note : parts_.notes()) {
        if (std::find(job_.notes.begin(), job_.notes.end(), note) == job_.notes.end()) {
            job_.notes.push_back(note);
        }
    }
    rise_over_fixtures(job_);
    return std::move(job_);  // meshes are large
}

}  // namespace

std::vector<Job> read_setups(const std::string& file,
                             const Strategies& strategies,
                             const std::string& machine)
{
    const std::filesystem::path path{file};
    return read_setups({files::text_of_file(file), file, path.parent_path(), machine}, strategies);
}

std::vector<Job> read_setups(const JobText& job, const Strategies& strategies)
{
    std::vector<Job> jobs;
    std::size_t setups = 1;
    for (std::size_t place = 0; place < std::max<std::size_t>(1, setups); ++place) {
        PartFiles parts;
        jobs.push_back(JobReader{job, strategies, parts}.read(place, setups));
    }
    return jobs;
}

Job read_job(const std::string& file, const Strategies& strategies)
{
    std::vector<Job> jobs = read_setups(file, strategies);
    if (const std::size_t count = jobs.size(); count > 1) {
        throw InputError(fmt::format("{}: has {} set-ups, only one can be read here", file, count));
    }
    return std::move(jobs.front());  // meshes are large
}

Job read_job(const JobText& job, const Strategies& strategies, PartFiles& parts)
{
    std::size_t setups = 1;
    return JobReader{job, strategies, parts}.read(0, setups);
}

}  // namespace cusp::import
