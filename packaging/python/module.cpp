// cusp for Python: plan, verify and simulate, on data in memory. packaging/python/cusp/__init__.py is the front door.
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/controller/dialect/line_source.hpp"
#include "host_tools/controller/program_run/settings_lines.hpp"
#include "host_tools/controller/simulate/simulate.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/judge/verify/program_setup.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "host_tools/judge/verify/verify_statistics.hpp"

#include "pybind11/functional.h"
#include "pybind11/numpy.h"
#include "pybind11/pybind11.h"
#include "pybind11/stl.h"

namespace py = pybind11;

namespace cusp::python {
namespace {

using job::Job;
using plan::PlannedProgram;

// Set-ups as they were read. Planning changes tolerances, so each call reads them again.
struct JobSource {
    std::string text;  // TOML; empty: `name` is a file
    std::string name;
    std::string folder;

    std::vector<Job> read() const
    {
        if (text.empty()) {
            return import::read_setups(name, strategies::all());
        }
        return import::read_setups({text, name, folder}, strategies::all());
    }
};

// Calls Python with the share done. An exception of the callback ends the plan.
class PythonWatcher : public plan::Watcher {
public:
    explicit PythonWatcher(py::function progress) : progress_{std::move(progress)} {}

    void begin(const std::string& work) override { work_ = work; }
    void progress(const char*, double share) override
    {
        const py::gil_scoped_acquire lock;
        try {
            if (progress_ && !is_over_) {
                progress_(work_, share);
            }
        } catch (py::error_already_set& error) {
            is_over_ = true;
            error.restore();
            PyErr_Clear();
        }
    }
    // Ctrl-C, too.
    bool cancelled() override
    {
        const py::gil_scoped_acquire lock;
        return is_over_ || PyErr_CheckSignals() != 0;
    }

private:
    py::object progress_;
    std::string work_;
    bool is_over_{false};
};

struct MoveRow {
    std::uint8_t kind;   // 0 rapid, 1 plunge, 2 cut, 3 link, 4 plunging cut
    std::uint8_t shape;  // 0 line, 1 arc, 2 NURBS
    std::int32_t operation;
    std::int32_t tool;
    double x, y, z;
    double feed;  // mm/min; 0: rapid
};

py::array_t<MoveRow> moves_of(const PlannedProgram& program)
{
    std::vector<MoveRow> rows;
    for (const toolpath::PlannedOperation& planned : program.operations) {
        const toolpath::Toolpath& path = planned.path;
        for (const toolpath::ToolMove& move : path.moves) {
            const Vec3d end = end_of(move);
            const double feed = move.kind == toolpath::MoveKind::kRapid    ? 0.0
                                : move.kind == toolpath::MoveKind::kPlunge ? path.plunge_feed
                                : move.feed > 0                            ? move.feed
                                                                           : path.feed;
            rows.push_back({static_cast<std::uint8_t>(move.kind),
                            static_cast<std::uint8_t>(move.shape.index()), planned.operation,
                            path.tool.number, end.x, end.y, end.z, feed});
        }
    }
    return py::array_t<MoveRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

py::list planned(const JobSource& source, double blend, const py::object& progress)
{
    struct Result {
        std::string name, gcode, statistics;
        std::vector<std::string> warnings;
        PlannedProgram program;
    };
    std::vector<Result> results;
    {
        PythonWatcher watcher{progress.is_none() ? py::function{} : py::function{progress}};
        const py::gil_scoped_release unlocked;
        std::vector<Job> setups = source.read();
        plan_setups(
            setups, watcher,
            [&](const Job& job) {
                plan::PlanOptions options;
                options.title = "job " + job.file;
                options.name = job.setup ? job.setup->name : "program";
                options.blend = blend;
                return options;
            },
            [&](const Job& job, PlannedProgram program) {
                std::vector<std::string> warnings = job.notes;
                for (const std::string& warning : program.all_warnings()) {
                    warnings.push_back(warning);
                }
                results.push_back({job.setup ? job.setup->name : "", program.gcode,
                                   statistics_json(job, program), std::move(warnings),
                                   std::move(program)});
            });
    }
    py::list out;
    for (Result& result : results) {
        py::dict entry;
        entry["setup"] = result.name;
        entry["gcode"] = result.gcode;
        entry["statistics"] = result.statistics;
        entry["warnings"] = result.warnings;
        entry["moves"] = moves_of(result.program);
        out.append(entry);
    }
    return out;
}

py::array_t<double> map_of(const verify::HeightGrid& grid, const std::vector<double>& values)
{
    return py::array_t<double>(
        {static_cast<py::ssize_t>(grid.nx), static_cast<py::ssize_t>(grid.ny)}, values.data());
}

// programs  G-code by name: the first is judged, the others were cut before
py::dict verified(const JobSource& source,
                  const std::vector<std::pair<std::string, std::string>>& programs,
                  std::optional<double> pitch,
                  bool engagement)
{
    verify::Verification result;
    {
        const py::gil_scoped_release unlocked;
        std::vector<Job> setups = source.read();
        std::vector<std::string> after;
        for (const auto& [name, text] : programs) {
            const auto held = std::make_shared<const std::string>(text);
            for (Job& job : setups) {
                job.programs[name] = held;
            }
            after.push_back(name);
        }
        after.erase(after.begin());
        verify::VerifySettings settings;
        settings.pitch = pitch;
        settings.engagement = engagement;
        const Job job = verify::job_of_program(std::move(setups), programs.front().first, after);
        result = verify::verify(job, programs.front().first, settings, [](double) {});
    }
    py::dict out;
    out["figures"] = statistics_json(result);
    out["broken"] = result.broken;
    out["left"] = map_of(result.grid, result.left);
    out["gouge"] = map_of(result.grid, result.gouge);
    out["part"] = map_of(result.grid, result.part);
    out["grid"] = py::make_tuple(result.grid.x0, result.grid.y0, result.grid.pitch);
    return out;
}

struct SampleRow {
    double seconds;
    double x, y, z;  // mm
    std::uint32_t line;
};

py::dict simulated(const std::string& name,
                   const std::string& gcode,
                   const std::string& settings,
                   bool samples,
                   bool grbl)
{
    constexpr double kMicrosecond = 1e-6;
    std::vector<SampleRow> rows;
    simulate::SimulationResult result;
    {
        const py::gil_scoped_release unlocked;
        simulate::SimulationOptions options;
        options.stock_grbl = grbl;
        auto lines = dialect::LineSource::of_text("settings", settings);
        if (const auto refusal = program_run::read_settings(lines, options.settings)) {
            throw InputError{"settings:" + std::to_string(refusal->line) + ": " + refusal->text,
                             {"settings", refusal->line}};
        }
        if (samples) {
            options.set_point = [&rows](const simulate::SetPoint& point) {
                const Vec3d at = xyz(to_millimetres(point.at));
                rows.push_back({static_cast<double>(point.microseconds) * kMicrosecond, at.x, at.y,
                                at.z, point.line});
            };
        }
        auto program = dialect::LineSource::of_text(name, gcode);
        result = simulate::simulate(program, options);
    }
    py::dict out;
    out["statistics"] = statistics_json(result);
    out["good"] = result.good();
    std::vector<std::string> errors;
    for (const program_run::RunError& error : result.errors) {
        errors.push_back(name + ":" + std::to_string(error.line) + ": " +
                         fault_text(result, error));
    }
    out["errors"] = errors;
    out["samples"] = py::array_t<SampleRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
    return out;
}

// cusp.Error with the parts of the fault as attributes.
void raise(const InputError& error, const py::object& type)
{
    py::object raised = type(error.what());
    const InputFault& fault = error.fault();
    const auto text = [](const std::string& value) -> py::object {
        return value.empty() ? py::object{py::none()} : py::object{py::str(value)};
    };
    raised.attr("file") = text(fault.file);
    raised.attr("line") =
        fault.line == 0 ? py::object{py::none()} : py::object{py::int_(fault.line)};
    raised.attr("key") = text(fault.key);
    raised.attr("value") = text(fault.value);
    raised.attr("limit") = text(fault.limit);
    PyErr_SetObject(type.ptr(), raised.ptr());
}

}  // namespace
}  // namespace cusp::python

PYBIND11_MODULE(_cusp, module)
{
    using namespace cusp;
    using namespace cusp::python;
    PYBIND11_NUMPY_DTYPE(MoveRow, kind, shape, operation, tool, x, y, z, feed);
    PYBIND11_NUMPY_DTYPE(SampleRow, seconds, x, y, z, line);
    static py::object error_type = py::reinterpret_steal<py::object>(
        PyErr_NewException("cusp.Error", PyExc_ValueError, nullptr));
    static py::object cancelled_type = py::reinterpret_steal<py::object>(
        PyErr_NewException("cusp.Cancelled", PyExc_RuntimeError, nullptr));
    module.attr("Error") = error_type;
    module.attr("Cancelled") = cancelled_type;
    py::register_exception_translator([](std::exception_ptr held) {
        try {
            std::rethrow_exception(held);
        } catch (const InputError& error) {
            raise(error, error_type);
        } catch (const plan::Cancelled& error) {
            if (PyErr_Occurred() == nullptr) {
                PyErr_SetString(cancelled_type.ptr(), error.what());
            }
        }
    });
    py::class_<JobSource>(module, "JobSource")
        .def(py::init([](std::string text, std::string name, std::string folder) {
            return JobSource{std::move(text), std::move(name), std::move(folder)};
        }));
    module.def("plan", &planned);
    module.def("verify", &verified);
    module.def("simulate", &simulated);
    module.def("set_threads", &parallel::set_threads);
    module.attr("__version__") = CUSP_VERSION;
}
