// Sorts lines into runs and others, and writes fitted moves for the runs.
#include "host_tools/controller/program_fit/program_fit.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "firmware/gcode/interpreter.hpp"
#include "firmware/segmenter/arc_fitter.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"
#include "host_tools/controller/dialect/refusal.hpp"
#include "host_tools/controller/program_fit/fit_check.hpp"
#include "host_tools/controller/program_fit/fitted_line.hpp"

namespace cusp::program_fit {

using dialect::refusal;

namespace {

using gcode::Command;
using gcode::Group;
using gcode::ModalState;
using gcode::Motion;
using gcode::NonModal;

// A line that may belong to a run: the words are N, G1, X, Y, Z and F, each at most once.
struct PlainLine {
    std::string_view text;
    std::string_view number;
    std::string_view feed;
    unsigned axes{0};  // one bit each, X in bit 0
    bool names_motion{false};
};

constexpr bool is_number_part(char c)
{
    return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
}

std::optional<PlainLine> as_plain(std::string_view text)
{
    PlainLine line{};
    line.text = text;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == ' ' || c == '\t') {
            ++i;
            continue;
        }
        std::size_t end = i + 1;
        while (end < text.size() && is_number_part(text[end])) {
            ++end;
        }
        const std::string_view value = text.substr(i + 1, end - i - 1);
        const char upper = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        if (upper >= 'X' && upper <= 'Z') {
            line.axes |= 1U << static_cast<unsigned>(upper - 'X');
        } else if (upper == 'G' && (value == "1" || value == "01")) {
            line.names_motion = true;
        } else if (upper == 'F') {
            line.feed = value;
        } else if (upper == 'N') {
            line.number = value;
        } else {
            return std::nullopt;
        }
        i = end;
    }
    return line.axes != 0 ? std::optional<PlainLine>{line} : std::nullopt;
}

segmenter::FitSettings settings_for(double tolerance, bool inches)
{
    segmenter::FitSettings settings;
    settings.left = tolerance;
    settings.right = tolerance;
    settings.centre_step = centre_step(inches);
    return settings;
}

class Fitter {
public:
    Fitter(const std::string& name, double tolerance)
        : name_{name}, tolerance_{tolerance}, buffer_(kBuffer), fitter_{make_fitter(false)}
    {
    }

    void read(std::string_view text);
    // True if the line read last ends the program.
    bool ended() const { return ended_; }
    // rest  of the program, after its end: as it is
    FittedProgram finish(std::string_view rest);

private:
    static constexpr std::size_t kBuffer = 4096;

    segmenter::ArcFitter make_fitter(bool inches)
    {
        return {settings_for(tolerance_, inches), {buffer_.data(), buffer_.size()}};
    }
    bool try_plain(const PlainLine& line, Position before, const ModalState& modal_before);
    void begin_run(Position start);
    void add_to_run(const PlainLine& line);
    void end_run();
    void take_moves();
    void write(const segmenter::FittedMove& move);
    void copy(std::string_view text, const ModalState& modal_before);
    void note_what_is_known(const Command& command);
    void end_line()
    {
        out_ += '\n';
        ++written_lines_;
    }
    [[noreturn]] void refuse(Error error, std::string_view line) const;

    std::string name_;
    double tolerance_;
    bool ended_{false};
    gcode::Interpreter interpreter_;
    std::vector<gcode::Action> actions_;
    std::vector<Vec3d> buffer_;
    segmenter::ArcFitter fitter_;
    FitReport report_;
    std::string out_;
    std::size_t read_lines_{0};
    std::size_t written_lines_{0};

    // All vertices of all runs, for the check; the run at hand begins at run_begin_.
    std::vector<Position> vertices_;
    std::vector<PlainLine> sources_;  // of the run at hand: sources_[i] ends at its vertex i + 1
    std::vector<Replacement> replacements_;
    bool in_run_{false};
    // A run is written when the line after it has been read, which may have changed these.
    ModalState run_modal_;
    Position run_offset_;
    std::size_t run_begin_{0};
    std::size_t next_source_{0};

    // The state of the written program where it may differ from that of the read one.
    Motion written_motion_{Motion::kRapid};
    path::Plane written_plane_{path::Plane::kXY};
    // Axes whose place in the program's coordinates is known; a run moves no other.
    unsigned known_axes_{0};
};

void Fitter::refuse(Error error, std::string_view line) const
{
    throw InputError(name_ + ":" + std::to_string(read_lines_) + ": error " +
                     std::to_string(static_cast<int>(error)) + ": " +
                     refusal(static_cast<int>(error), line).text);
}

void Fitter::read(std::string_view text)
{
    ++read_lines_;
    if (!text.empty() && text.back() == '\r') {
        text.remove_suffix(1);
    }
    const Position before = interpreter_.position();
    const ModalState modal_before = interpreter_.modal();
    const Status status = interpreter_.execute(text, static_cast<std::uint32_t>(read_lines_));
    if (!status) {
        refuse(status.error(), text);
    }
    actions_.clear();
    gcode::Action action;
    while (interpreter_.next(action)) {
        const auto* move = std::get_if<path::Move>(&action);
        ended_ = ended_ || std::holds_alternative<gcode::ProgramEnd>(action);
        report_.moves_in += move != nullptr && move->kind == path::MoveKind::kFeed ? 1 : 0;
        if (actions_.size() < 2) {
            actions_.push_back(action);
        }
    }
    const std::optional<PlainLine> plain = as_plain(text);
    if (plain && try_plain(*plain, before, modal_before)) {
        return;
    }
    if (in_run_ && text.find_first_not_of(" \t") == std::string_view::npos) {
        return;
    }
    end_run();
    copy(text, modal_before);
}

// Adds the line to a run where it belongs to one.
bool Fitter::try_plain(const PlainLine& line, Position before, const ModalState& modal_before)
{
    const ModalState& modal = interpreter_.modal();
    // Fitted arcs have their centres by offsets: with G90.1 lines stay lines.
    if (modal.motion != Motion::kLine || modal.inverse_time || modal.absolute_centres ||
        actions_.size() > 1) {
        return false;
    }
    const auto* move = actions_.empty() ? nullptr : std::get_if<path::Move>(&actions_[0]);
    if (!actions_.empty() && move == nullptr) {
        return false;
    }
    if (!modal.incremental && (line.axes & ~known_axes_) != 0) {
        return false;
    }
    if (in_run_ && modal.feed != modal_before.feed) {
        end_run();
    }
    if (!in_run_) {
        begin_run(before);
    }
    add_to_run(line);
    return true;
}

void Fitter::begin_run(Position start)
{
    fitter_ = make_fitter(interpreter_.modal().inches);
    in_run_ = true;
    run_modal_ = interpreter_.modal();
    run_offset_ = work_offset(run_modal_, interpreter_.parameters());
    run_begin_ = vertices_.size();
    vertices_.push_back(start);
    sources_.clear();
    next_source_ = 0;
    fitter_.start({});
}

void Fitter::add_to_run(const PlainLine& line)
{
    if (!fitter_.has_room()) {
        take_moves();
    }
    vertices_.push_back(interpreter_.position());
    sources_.push_back(line);
    fitter_.push(xyz(to_millimetres(vertices_.back() - vertices_[run_begin_])));
}

void Fitter::end_run()
{
    if (!in_run_) {
        return;
    }
    fitter_.finish();
    take_moves();
    in_run_ = false;
}

void Fitter::take_moves()
{
    segmenter::FittedMove move{};
    while (fitter_.next(move)) {
        write(move);
        next_source_ += move.lines;
    }
}

void Fitter::write(const segmenter::FittedMove& move)
{
    const std::size_t first = run_begin_ + next_source_;
    const PlainLine& last = sources_[next_source_ + move.lines - 1];
    // The feed of a run is that of its first line; feed words after it repeat it.
    const PlainLine& opening = sources_.front();
    replacements_.push_back({written_lines_, first, move.lines});
    const bool as_it_stands =
        move.lines == 1 && (last.names_motion || written_motion_ == Motion::kLine);
    const bool feed_is_new = next_source_ == 0 && !opening.feed.empty();
    if (as_it_stands) {
        out_ += last.text;
    } else {
        const bool names_plane = move.is_arc && move.plane != written_plane_;
        append_move(out_, move,
                    {last.number, feed_is_new ? opening.feed : std::string_view{}, vertices_[first],
                     vertices_[first + move.lines], run_offset_, run_modal_.inches,
                     run_modal_.incremental, names_plane});
        written_plane_ = names_plane ? move.plane : written_plane_;
    }
    end_line();
    written_motion_ = !move.is_arc     ? Motion::kLine
                      : move.clockwise ? Motion::kArcClockwise
                                       : Motion::kArcCounterClockwise;
}

// Copies a line; before it come the modal words that it relies on and a fitted move has changed.
void Fitter::copy(std::string_view text, const ModalState& modal_before)
{
    Command command;
    const Status status = gcode::read_command(text, modal_before, command);
    if (!status) {
        refuse(status.error(), text);
    }
    if (written_plane_ != modal_before.plane && !command.is_blank()) {
        out_ += plane_word(modal_before.plane);
        end_line();
        written_plane_ = modal_before.plane;
    }
    const bool takes_motion = command.axes() != 0 && command.axis_use == gcode::AxisUse::kNone;
    if (takes_motion && written_motion_ != modal_before.motion &&
        modal_before.motion == Motion::kLine) {
        out_ += "G1 ";
    }
    if (takes_motion || command.names(Group::kMotion) || command.flow == gcode::ProgramFlow::kEnd) {
        written_motion_ = interpreter_.modal().motion;
    }
    written_plane_ = interpreter_.modal().plane;
    out_ += text;
    end_line();
    note_what_is_known(command);
}

void Fitter::note_what_is_known(const Command& command)
{
    const bool leaves =
        (command.non_modal != NonModal::kNone && command.non_modal != NonModal::kDwell) ||
        command.tool_length != gcode::ToolLength::kUnchanged ||
        command.names(Group::kCoordinateSystem) || command.names(Group::kToolChange) ||
        command.flow == gcode::ProgramFlow::kEnd || command.axis_use == gcode::AxisUse::kNonModal ||
        (!actions_.empty() && std::holds_alternative<gcode::Probe>(actions_[0]));
    if (leaves) {
        known_axes_ = 0;
        return;
    }
    if (interpreter_.modal().incremental) {
        return;
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
        known_axes_ |= command.has(static_cast<char>('X' + axis)) ? 1U << axis : 0U;
    }
}

FittedProgram Fitter::finish(std::string_view rest)
{
    end_run();
    const MeasuredFit measured = measure_fit(out_, vertices_, replacements_);
    constexpr double kRounding = 1e-6;
    if (measured.vertices > tolerance_ + kRounding ||
        measured.between > 1.1 * tolerance_ + kRounding) {
        throw std::logic_error("the fitted program leaves the tolerance: " +
                               std::to_string(measured.vertices) + " mm at a vertex, " +
                               std::to_string(measured.between) + " mm between; nothing written");
    }
    report_.lines_read = read_lines_;
    report_.lines = measured.lines;
    report_.arcs = measured.arcs;
    report_.rapids = measured.rapids;
    report_.moves_out = measured.lines + measured.arcs + measured.other_moves;
    report_.max_deviation_mm = std::max(measured.vertices, measured.between);
    report_.max_vertex_deviation_mm = measured.vertices;
    out_ += rest;
    return {std::move(out_), report_};
}

}  // namespace

FittedProgram fit_program(std::string_view program,
                          const std::string& name,
                          double tolerance,
                          const std::function<void(double)>& progress)
{
    constexpr std::size_t kProgressBytes = std::size_t{1} << 22;
    Fitter fitter{name, tolerance};
    const std::size_t size = program.size();
    std::size_t reported = 0;
    dialect::EndLine end_line;
    while (!program.empty() && !fitter.ended()) {
        const std::size_t end = program.find('\n');
        if (end_line.at(program.substr(0, end))) {
            break;
        }
        fitter.read(program.substr(0, end));
        program.remove_prefix(end == std::string_view::npos ? program.size() : end + 1);
        const std::size_t done = size - program.size();
        if (progress && done - reported >= kProgressBytes) {
            progress(static_cast<double>(done) / static_cast<double>(size));
            reported = done;
        }
    }
    return fitter.finish(program);
}

}  // namespace cusp::program_fit
