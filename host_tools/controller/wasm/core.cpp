// The C ABI of the core as a WebAssembly module: text in, numbers out. host_tools/judge/view/web/src/core/core.ts calls it.
//
// A run: cusp_text(), bytes written there, cusp_run_begin(); cusp_run_advance() until it returns 0, reading
// cusp_set_points() between; then cusp_figures() and cusp_errors(). One run at a time.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/base/assert.hpp"
#include "firmware/machine/settings.hpp"
#include "host_tools/controller/dialect/line_source.hpp"
#include "host_tools/controller/program_run/motion_profile.hpp"
#include "host_tools/controller/program_run/program_run.hpp"
#include "host_tools/controller/program_run/settings_lines.hpp"
#include "host_tools/controller/wasm/wasm.hpp"

void cusp::fault(const char* /*expression*/, const char* /*file*/, int /*line*/) noexcept
{
    __builtin_trap();
}

namespace {

using namespace cusp;
using program_run::MotionProfile;
using program_run::ProfileStretch;
using program_run::ProgramRun;
using program_run::RunError;
using program_run::RunOptions;
using program_run::RunResult;
using program_run::SetPoint;

// One servo tick as the page takes it.
struct SetPointRow {
    double x_mm, y_mm, z_mm;
    double line;
};

// Figures of a run, in the order that core.ts expects.
constexpr std::size_t kFigures = 26;

struct Run {
    std::string program;
    std::string settings;
    std::optional<dialect::LineSource> source;
    RunOptions options;
    std::unique_ptr<ProgramRun> run;
    std::vector<SetPointRow> rows;
    MotionProfile profile;
    std::vector<double> profile_rows;
    std::array<double, kFigures> figures{};
    std::string errors;
};

Run& the_run()
{
    static Run run;
    return run;
}

// "s" or "p" (settings, program), line, code and text, parted by tabs.
std::string error_line(char origin, std::uint64_t line, int code, const std::string& text)
{
    return origin + std::string{"\t"} + std::to_string(line) + "\t" + std::to_string(code) + "\t" +
           text + "\n";
}

void take_figures(Run& run)
{
    const RunResult& result = run.run->result();
    const Vec3d end = xyz(to_millimetres(result.end));
    const auto whole = [](auto number) {
        return static_cast<double>(number);
    };
    run.figures = {result.duration_s,
                   result.total_s,
                   whole(result.lines),
                   whole(result.edges_crc32),
                   whole(result.steps[0]),
                   whole(result.steps[1]),
                   whole(result.steps[2]),
                   end.x,
                   end.y,
                   end.z,
                   result.length_mm,
                   result.max_velocity.x,
                   result.max_velocity.y,
                   result.max_velocity.z,
                   result.max_acceleration.x,
                   result.max_acceleration.y,
                   result.max_acceleration.z,
                   result.max_jerk.x,
                   result.max_jerk.y,
                   result.max_jerk.z,
                   whole(result.moves.rapid),
                   whole(result.moves.line),
                   whole(result.moves.arc),
                   whole(result.moves.nurbs),
                   whole(result.pauses),
                   whole(result.alarm)};
    for (const RunError& error : result.errors) {
        run.errors += error_line('p', error.line, error.code, fault_text(result, error));
    }
}

}  // namespace

std::string& cusp::wasm::text_of_caller()
{
    static std::string text;
    return text;
}

// Allocates a text of this size, which the caller fills and the next call reads.
CUSP_EXPORT(cusp_text) char* cusp_text(std::uint32_t size)
{
    std::string& text = wasm::text_of_caller();
    text.resize(size);
    return text.data();
}

// The text is the settings of the next run.
CUSP_EXPORT(cusp_take_settings) void cusp_take_settings()
{
    the_run().settings.swap(wasm::text_of_caller());
}

// The text is the program; the run begins. with_set_points: whether they are kept for cusp_set_points().
// Returns 0 where the settings are refused; cusp_errors() gives the reason.
CUSP_EXPORT(cusp_run_begin) int cusp_run_begin(int with_set_points)
{
    Run& run = the_run();
    run.run.reset();
    run.errors.clear();
    run.rows.clear();
    run.profile = {};
    run.figures = {};
    run.program.swap(wasm::text_of_caller());
    run.options = {};
    run.options.measures_deviation = false;
    auto lines = dialect::LineSource::of_text("settings", run.settings);
    if (const auto refusal = program_run::read_settings(lines, run.options.settings)) {
        run.errors = error_line('s', refusal->line, 0, refusal->text);
        return 0;
    }
    if (with_set_points != 0) {
        run.options.set_point = [&run](const SetPoint& point) {
            run.profile.add(point.at, point.line);
            const Vec3d at = xyz(to_millimetres(point.at));
            run.rows.push_back({at.x, at.y, at.z, static_cast<double>(point.line)});
        };
    }
    run.source.emplace(dialect::LineSource::of_text("program", run.program));
    run.run = std::make_unique<ProgramRun>(*run.source, run.options);
    return 1;
}

// Advances at most so many servo ticks. Returns 0 at the end of the run. Discards the set points of the previous call.
CUSP_EXPORT(cusp_run_advance) int cusp_run_advance(std::uint32_t ticks)
{
    Run& run = the_run();
    run.rows.clear();
    for (std::uint32_t tick = 0; run.run && tick < ticks; ++tick) {
        if (!run.run->advance()) {
            take_figures(run);
            return 0;
        }
    }
    return run.run ? 1 : 0;
}

CUSP_EXPORT(cusp_run_fraction) double cusp_run_fraction()
{
    return the_run().run ? the_run().run->fraction() : 0.0;
}
CUSP_EXPORT(cusp_run_line) double cusp_run_line()
{
    return the_run().run ? static_cast<double>(the_run().run->line()) : 0.0;
}
CUSP_EXPORT(cusp_run_seconds) double cusp_run_seconds()
{
    return the_run().run ? the_run().run->seconds() : 0.0;
}

// Four doubles a set point: x, y, z in mm, and the line of the program.
CUSP_EXPORT(cusp_set_points) const SetPointRow* cusp_set_points() { return the_run().rows.data(); }
CUSP_EXPORT(cusp_set_point_count) std::uint32_t cusp_set_point_count()
{
    return static_cast<std::uint32_t>(the_run().rows.size());
}

// The profile of the run, where set points are kept: twelve doubles a stretch of time. Greatest speed; velocity,
// acceleration and jerk of X, Y and Z; first line; seconds from the start of the run.
CUSP_EXPORT(cusp_profile) const double* cusp_profile()
{
    Run& run = the_run();
    run.profile_rows.clear();
    double start = 0;
    for (const ProfileStretch& stretch : run.profile.stretches()) {
        run.profile_rows.push_back(stretch.speed);
        for (const Vec3d& of_axes :
             {xyz(stretch.velocity), xyz(stretch.acceleration), xyz(stretch.jerk)}) {
            run.profile_rows.insert(run.profile_rows.end(), {of_axes.x, of_axes.y, of_axes.z});
        }
        run.profile_rows.push_back(static_cast<double>(stretch.first_line));
        run.profile_rows.push_back(start);
        start += run.profile.seconds_each();
    }
    return run.profile_rows.data();
}
CUSP_EXPORT(cusp_profile_count) std::uint32_t cusp_profile_count()
{
    return static_cast<std::uint32_t>(the_run().profile.stretches().size());
}

CUSP_EXPORT(cusp_figures) const double* cusp_figures() { return the_run().figures.data(); }

CUSP_EXPORT(cusp_errors) const char* cusp_errors() { return the_run().errors.data(); }
CUSP_EXPORT(cusp_errors_size) std::uint32_t cusp_errors_size()
{
    return static_cast<std::uint32_t>(the_run().errors.size());
}

// Five doubles a setting: number, default, least, most, decimals.
CUSP_EXPORT(cusp_settings) const double* cusp_settings()
{
    static std::array<double, 5 * machine::kSettingCount> table;
    const machine::Settings defaults;
    for (std::size_t i = 0; i < machine::kSettingCount; ++i) {
        const machine::SettingEntry& entry = machine::setting_entry(i);
        const std::array<double, 5> row{
            static_cast<double>(entry.number), static_cast<double>(defaults.value_at(i)),
            static_cast<double>(entry.least), static_cast<double>(entry.most),
            static_cast<double>(entry.decimals)};
        std::copy(row.begin(), row.end(), table.begin() + static_cast<std::ptrdiff_t>(5 * i));
    }
    return table.data();
}
CUSP_EXPORT(cusp_setting_count) std::uint32_t cusp_setting_count()
{
    return machine::kSettingCount;
}
