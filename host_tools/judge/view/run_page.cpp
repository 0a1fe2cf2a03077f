// Reads, verifies and runs the program, and inserts the results into the page.
#include "host_tools/judge/view/run_page.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "host_tools/judge/view/left_map.hpp"
#include "host_tools/judge/view/page_text.hpp"
#include "host_tools/judge/view/program_reading.hpp"
#include "host_tools/judge/view/run_facts.hpp"
#include "host_tools/judge/view/run_record.hpp"
#include "host_tools/judge/view/stock_frames.hpp"

#include "fmt/format.h"

namespace cusp::view {

using program_run::SetPoint;
using simulate::SimulationOptions;
using simulate::SimulationResult;
using verify::HeightGrid;
using verify::Verification;

namespace {

// Distance of tool positions in pitches of the stock's grid.
constexpr double kSpacingShare = 0.4;
// Batches of set points that wait to be encoded: some 13 MB.
constexpr std::size_t kMostWaiting = 16;

using Blocks = std::vector<RunBlock>;

std::string element(const std::string& id, const char* type, std::string_view text)
{
    return fmt::format("<script type=\"{}\" id=\"{}\">{}</script>\n", type, id, text);
}

Blocks program_blocks(const ProgramReading& reading)
{
    return {{"data-program", deflated(reading.text)},
            {"data-rapid", deflated(std::string(reading.rapid.begin(), reading.rapid.end()))}};
}

Blocks record_blocks(RunRecord& record)
{
    Blocks blocks{{"data-samples", record.samples().finish().text()},
                  {"data-lines", deflated(record.line_runs().text())},
                  {"data-path", deflated(record.vertices().finish().text())}};
    if (record.engagement()) {
        blocks.push_back({"data-engagement", deflated(record.engagement()->finish().text())});
    }
    return blocks;
}

// Set points are encoded, and their deviation is measured, while the program runs.
SimulationResult run(const std::string& program,
                     const RunPageOptions& options,
                     RunRecord& record,
                     parallel::TaskQueue& encoding)
{
    constexpr std::size_t kBatch = 16384;
    RunPiece batch;
    const auto hand_over = [&] {
        encoding.add([&record, full = std::exchange(batch, {})] { record.add(full); });
    };
    SimulationOptions simulation = options.simulation;
    simulation.measures_deviation = false;
    simulation.path = [&](const path::Move* move) {
        batch.path.push_back(
            {batch.points.size(), move != nullptr ? std::optional{*move} : std::nullopt});
    };
    simulation.set_point = [&](const SetPoint& point) {
        if (batch.points.empty()) {
            batch.points.reserve(kBatch);
        }
        batch.points.push_back(point);
        if (batch.points.size() == kBatch) {
            hand_over();
        }
    };
    SimulationResult result = simulate::simulate(program, simulation);
    hand_over();
    encoding.finish();
    result.max_deviation_mm = record.deviation().greatest();
    result.max_deviation_line = record.deviation().line();
    return result;
}

// No value where a line is refused; `why` is the reason.
std::optional<Verification> cut(const std::string& program,
                                const RunPageOptions& options,
                                std::string& why)
{
    try {
        verify::VerifySettings settings;
        settings.engagement = true;
        return verify::verify(*options.job, program, settings, options.verifying);
    } catch (const InputError& error) {
        why = error.what();
        return std::nullopt;
    }
}

std::string verdict_of(const SimulationResult& run, const Verification* verification)
{
    std::string text = fmt::format("{:.3f} s in motion, {:.1f} mm", run.duration_s, run.length_mm);
    if (!run.errors.empty()) {
        text += fmt::format("; line {}: {}", run.errors.front().line, run.errors.front().text);
    }
    if (verification != nullptr) {
        text += verification->broken.empty() ? "; all bounds hold"
                                             : "; " + verification->broken.front();
    }
    return text;
}

// Replaces a line of the page's template by text.
void fill(std::string& page, std::string_view place, const std::string& text)
{
    const std::size_t at = page.find(place);
    if (at == std::string::npos) {
        throw std::logic_error{"the page of cusp view has no place for its data"};
    }
    page.replace(at, place.size(), text);
}

}  // namespace

RunData run_data(const std::string& program, const RunPageOptions& options)
{
    std::optional<Verification> own;
    std::string why;
    if (options.job != nullptr && options.verification == nullptr) {
        own = cut(program, options, why);
    }
    const Verification* cut_part = own ? &*own : options.verification;
    const HeightGrid grid = cut_part != nullptr ? coarse_grid(cut_part->grid) : HeightGrid{};
    ProgramReading reading;
    Blocks of_program;
    RunRecord record{reading, cut_part != nullptr ? kSpacingShare * grid.pitch
                                                  : std::numeric_limits<double>::infinity()};
    if (cut_part != nullptr && cut_part->figures.engagement) {
        record.follow_engagement(*cut_part);
    }
    parallel::TaskQueue encoding{kMostWaiting};
    encoding.add([&] {
        reading = read_program_lines(program);
        of_program = program_blocks(reading);
    });
    SimulationResult result = run(program, options, record, encoding);

    RunFacts facts{std::filesystem::path{program}.filename().string(),
                   reading,
                   result,
                   options.simulation.settings.limits(),
                   record.ticks(),
                   record.start(),
                   record.farthest(),
                   options.job,
                   cut_part,
                   why,
                   {}};
    RunData data;
    data.blocks = record_blocks(record);
    std::move(of_program.begin(), of_program.end(), std::back_inserter(data.blocks));
    if (cut_part != nullptr) {
        facts.worst = worst_places(*cut_part, options.job->stock_top);
        data.blocks.push_back(
            {"data-stock", stock_frames(record.path(), *options.job, grid).text()});
        data.blocks.push_back({"data-left", left_map(*cut_part, grid).text()});
    }
    data.facts = facts_json(facts);
    data.ticks = record.ticks();
    data.refused = reading.refused_count;
    data.good = result.good() && reading.refused_count == 0 &&
                (cut_part == nullptr ? why.empty() : cut_part->broken.empty());
    data.verdict = verdict_of(result, cut_part);
    data.run = std::move(result);
    return data;
}

RunPage run_page(const std::string& program, const RunPageOptions& options)
{
    RunPage page;
    static_cast<RunData&>(page) = run_data(program, options);
    std::string elements;
    for (const RunBlock& block : std::exchange(page.blocks, {})) {
        elements += element(block.id, "text/plain", seven_bit_text(block.bytes));
    }
    page.html = page_text(Page::kView);
    fill(page.html, kFactsPlace, element("facts", "application/json", page.facts));
    fill(page.html, kDataPlace, elements);
    return page;
}

}  // namespace cusp::view
