// The words of a line, one after the other, as Grbl 1.1 reads them (gcode.c, step 2).
#include "firmware/gcode/command.hpp"

#include <optional>

namespace cusp::gcode {
namespace {

struct Code {
    std::int64_t number;
    std::int64_t hundredths;
};

Status claim_group(Command& command, Group group) noexcept
{
    const std::uint32_t bit = 1U << static_cast<unsigned>(group);
    if ((command.groups & bit) != 0) {
        return Error::kGcodeModalGroupViolation;
    }
    command.groups |= bit;
    return kDone;
}

Status claim_axes(Command& command, AxisUse use) noexcept
{
    if (command.axis_use != AxisUse::kNone) {
        return Error::kGcodeAxisCommandConflict;
    }
    command.axis_use = use;
    return kDone;
}

// The effect of a G number on a command. Numbers are in hundredths: G38.2 is 3820.
struct Entry {
    std::uint16_t hundredths;
    Group group;
    AxisUse axis_use;
    std::uint8_t value;  // of the enumeration that belongs to the group
};

constexpr std::uint8_t as_value(Motion motion) noexcept
{
    return static_cast<std::uint8_t>(motion);
}
constexpr std::uint8_t as_value(NonModal command) noexcept
{
    return static_cast<std::uint8_t>(command);
}
constexpr std::uint8_t as_value(path::Plane plane) noexcept
{
    return static_cast<std::uint8_t>(plane);
}
constexpr std::uint8_t as_value(ToolLength length) noexcept
{
    return static_cast<std::uint8_t>(length);
}

// Sorted by number. The entry of G5.3, kEndOfCurve, has Motion::kNone: it ends a curve.
constexpr std::uint16_t kEndOfCurve = 530;
constexpr std::uint16_t kNoMotion = 8000;  // G80
constexpr Entry kEntries[] = {
    {0, Group::kMotion, AxisUse::kMotion, as_value(Motion::kRapid)},
    {100, Group::kMotion, AxisUse::kMotion, as_value(Motion::kLine)},
    {200, Group::kMotion, AxisUse::kMotion, as_value(Motion::kArcClockwise)},
    {300, Group::kMotion, AxisUse::kMotion, as_value(Motion::kArcCounterClockwise)},
    {400, Group::kNonModal, AxisUse::kNone, as_value(NonModal::kDwell)},
    {520, Group::kMotion, AxisUse::kMotion, as_value(Motion::kUniformNurbs)},
    {kEndOfCurve, Group::kMotion, AxisUse::kNone, as_value(Motion::kNone)},
    {620, Group::kMotion, AxisUse::kMotion, as_value(Motion::kNurbs)},
    {1000, Group::kNonModal, AxisUse::kNonModal, as_value(NonModal::kSetOffset)},
    {1700, Group::kPlane, AxisUse::kNone, as_value(path::Plane::kXY)},
    {1800, Group::kPlane, AxisUse::kNone, as_value(path::Plane::kZX)},
    {1900, Group::kPlane, AxisUse::kNone, as_value(path::Plane::kYZ)},
    {2000, Group::kUnits, AxisUse::kNone, 1},
    {2100, Group::kUnits, AxisUse::kNone, 0},
    {2800, Group::kNonModal, AxisUse::kNonModal, as_value(NonModal::kGoHome)},
    {2810, Group::kNonModal, AxisUse::kNone, as_value(NonModal::kStoreHome)},
    {3000, Group::kNonModal, AxisUse::kNonModal, as_value(NonModal::kGoSecondHome)},
    {3010, Group::kNonModal, AxisUse::kNone, as_value(NonModal::kStoreSecondHome)},
    {3820, Group::kMotion, AxisUse::kMotion, as_value(Motion::kProbeTowards)},
    {3830, Group::kMotion, AxisUse::kMotion, as_value(Motion::kProbeTowardsQuietly)},
    {3840, Group::kMotion, AxisUse::kMotion, as_value(Motion::kProbeAway)},
    {3850, Group::kMotion, AxisUse::kMotion, as_value(Motion::kProbeAwayQuietly)},
    {4000, Group::kCutterRadius, AxisUse::kNone, 0},
    {4300, Group::kToolLength, AxisUse::kNone, as_value(ToolLength::kFromTable)},
    {4310, Group::kToolLength, AxisUse::kToolLength, as_value(ToolLength::kDynamic)},
    {4900, Group::kToolLength, AxisUse::kNone, as_value(ToolLength::kCancel)},
    {5200, Group::kNonModal, AxisUse::kNonModal, as_value(NonModal::kSetLocalOffset)},
    {5300, Group::kNonModal, AxisUse::kNone, as_value(NonModal::kMachineCoordinates)},
    {5400, Group::kCoordinateSystem, AxisUse::kNone, 0},
    {5500, Group::kCoordinateSystem, AxisUse::kNone, 1},
    {5600, Group::kCoordinateSystem, AxisUse::kNone, 2},
    {5700, Group::kCoordinateSystem, AxisUse::kNone, 3},
    {5800, Group::kCoordinateSystem, AxisUse::kNone, 4},
    {5900, Group::kCoordinateSystem, AxisUse::kNone, 5},
    {5910, Group::kCoordinateSystem, AxisUse::kNone, 6},
    {5920, Group::kCoordinateSystem, AxisUse::kNone, 7},
    {5930, Group::kCoordinateSystem, AxisUse::kNone, 8},
    {6100, Group::kPathControl, AxisUse::kNone, 1},
    {6110, Group::kPathControl, AxisUse::kNone, 1},
    {6400, Group::kPathControl, AxisUse::kNone, 0},
    {7300, Group::kMotion, AxisUse::kMotion, as_value(Motion::kDrillChipBreaking)},
    {kNoMotion, Group::kMotion, AxisUse::kNone, as_value(Motion::kNone)},
    {8100, Group::kMotion, AxisUse::kMotion, as_value(Motion::kDrill)},
    {8200, Group::kMotion, AxisUse::kMotion, as_value(Motion::kDrillWithDwell)},
    {8300, Group::kMotion, AxisUse::kMotion, as_value(Motion::kDrillPecking)},
    {8500, Group::kMotion, AxisUse::kMotion, as_value(Motion::kBore)},
    {8600, Group::kMotion, AxisUse::kMotion, as_value(Motion::kBoreStopping)},
    {8900, Group::kMotion, AxisUse::kMotion, as_value(Motion::kBoreWithDwell)},
    {9000, Group::kDistance, AxisUse::kNone, 0},
    {9010, Group::kArcDistance, AxisUse::kNone, 1},
    {9100, Group::kDistance, AxisUse::kNone, 1},
    {9110, Group::kArcDistance, AxisUse::kNone, 0},
    {9200, Group::kNonModal, AxisUse::kNonModal, as_value(NonModal::kSetCoordinateOffset)},
    {9210, Group::kNonModal, AxisUse::kNone, as_value(NonModal::kClearCoordinateOffset)},
    {9220, Group::kNonModal, AxisUse::kNone, as_value(NonModal::kClearCoordinateOffset)},
    {9300, Group::kFeedMode, AxisUse::kNone, 1},
    {9400, Group::kFeedMode, AxisUse::kNone, 0},
    {9700, Group::kSpindleMode, AxisUse::kNone, 0},
    {9800, Group::kReturnLevel, AxisUse::kNone, 0},
    {9900, Group::kReturnLevel, AxisUse::kNone, 1},
};

const Entry* find_entry(std::int64_t hundredths) noexcept
{
    std::size_t low = 0;
    std::size_t high = std::size(kEntries);
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (kEntries[middle].hundredths < hundredths) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < std::size(kEntries) && kEntries[low].hundredths == hundredths ? &kEntries[low]
                                                                               : nullptr;
}

void apply(Command& command, const Entry& entry) noexcept
{
    const bool flag = entry.value != 0;
    switch (entry.group) {
        case Group::kMotion:
            command.modal.motion = static_cast<Motion>(entry.value);
            command.ends_curve = entry.hundredths == kEndOfCurve;
            break;
        case Group::kNonModal:
            command.non_modal = static_cast<NonModal>(entry.value);
            break;
        case Group::kPlane:
            command.modal.plane = static_cast<path::Plane>(entry.value);
            break;
        case Group::kToolLength:
            command.tool_length = static_cast<ToolLength>(entry.value);
            break;
        case Group::kCoordinateSystem:
            command.modal.coordinate_system = entry.value;
            break;
        case Group::kUnits:
            command.modal.inches = flag;
            break;
        case Group::kDistance:
            command.modal.incremental = flag;
            break;
        case Group::kFeedMode:
            command.modal.inverse_time = flag;
            break;
        case Group::kReturnLevel:
            command.modal.return_to_clearance = flag;
            break;
        case Group::kPathControl:
            command.modal.exact_path = flag;
            command.modal.default_tolerance = !flag;
            break;
        case Group::kArcDistance:
            command.modal.absolute_centres = flag;
            break;
        case Group::kCutterRadius:
        case Group::kStop:
        case Group::kToolChange:
        case Group::kSpindle:
        case Group::kSpindleMode:
        case Group::kCoolant:
            break;
    }
}

Status apply_g(Command& command, Code code) noexcept
{
    const Entry* entry = find_entry(code.number * 100 + code.hundredths);
    if (entry == nullptr) {
        // Grbl's error is 23 for a known number with a wrong decimal, and 20 for an unknown
        // number. Families with decimals (G5, G6, G28 ...) give 20.
        const bool family = code.number == 5 || code.number == 6 || code.number == 28 ||
                            code.number == 30 || code.number == 38 || code.number == 43 ||
                            code.number == 59 || code.number == 90 || code.number == 61 ||
                            code.number == 91 || code.number == 92;
        return code.hundredths != 0 && !family && find_entry(code.number * 100) != nullptr
                   ? Error::kGcodeCommandValueNotInteger
                   : Error::kGcodeUnsupportedCommand;
    }
    if (entry->axis_use != AxisUse::kNone) {
        if (const Status status = claim_axes(command, entry->axis_use); !status) {
            return status;
        }
    }
    const bool cancels = entry->hundredths == kNoMotion;
    if (cancels && command.names(Group::kMotion) && !command.ends_curve) {
        return kDone;
    }
    if (command.cancels && entry->group == Group::kMotion && entry->hundredths != kEndOfCurve) {
        command.cancels = false;
    } else if (const Status status = claim_group(command, entry->group); !status) {
        return status;
    }
    command.cancels = command.cancels || cancels;
    apply(command, *entry);
    return kDone;
}

std::optional<Group> group_of_m(std::int64_t number) noexcept
{
    switch (number) {
        case 0:
        case 1:
        case 2:
        case 30:
            return Group::kStop;
        case 3:
        case 4:
        case 5:
            return Group::kSpindle;
        case 6:
            return Group::kToolChange;
        case 7:
        case 8:
        case 9:
            return Group::kCoolant;
        default:
            return std::nullopt;
    }
}

Status apply_m(Command& command, Code code) noexcept
{
    if (code.hundredths != 0) {
        return Error::kGcodeCommandValueNotInteger;
    }
    const std::optional<Group> group = group_of_m(code.number);
    if (!group) {
        return Error::kGcodeUnsupportedCommand;
    }
    if (const Status status = claim_group(command, *group); !status) {
        return status;
    }
    ModalState& modal = command.modal;
    switch (code.number) {
        case 0:
            command.flow = ProgramFlow::kPause;
            break;
        case 1:
            command.flow = ProgramFlow::kOptionalPause;
            break;
        case 3:
            modal.spindle = SpindleMode::kClockwise;
            break;
        case 4:
            modal.spindle = SpindleMode::kCounterClockwise;
            break;
        case 5:
            modal.spindle = SpindleMode::kOff;
            break;
        case 7:
            modal.mist = true;
            command.coolant = Coolant::kMist;
            break;
        case 8:
            modal.flood = true;
            command.coolant = Coolant::kFlood;
            break;
        case 9:
            modal.mist = false;
            modal.flood = false;
            command.coolant = Coolant::kOff;
            break;
        case 2:
        case 30:
            command.flow = ProgramFlow::kEnd;
            break;
        default:
            break;
    }
    return kDone;
}

constexpr LetterSet kValueLetters = letter('F') | letter('H') | letter('I') | letter('J') |
                                    letter('K') | letter('L') | letter('N') | letter('P') |
                                    letter('Q') | letter('R') | letter('S') | letter('T') |
                                    kLinearLetters | kRotaryLetters;
constexpr LetterSet kNeverNegative =
    letter('F') | letter('H') | letter('L') | letter('N') | letter('P') | letter('S') | letter('T');

Status apply_value(Command& command, char upper_case, Decimal value) noexcept
{
    const LetterSet bit = letter(upper_case);
    if ((bit & kValueLetters) == 0) {
        return Error::kGcodeUnsupportedCommand;
    }
    if ((command.words & bit) != 0) {
        return Error::kGcodeWordRepeated;
    }
    if ((bit & kNeverNegative) != 0 && value.is_negative()) {
        return Error::kNegativeValue;
    }
    command.words |= bit;
    command.unused |= bit;
    command.values[letter_index(upper_case)] = value;
    return kDone;
}

Status apply_word(Command& command, char upper_case, Decimal value) noexcept
{
    if (upper_case != 'G' && upper_case != 'M') {
        return apply_value(command, upper_case, value);
    }
    constexpr std::int64_t kMaxCode = 255;
    const Decimal whole{whole_part(value), 0};
    if (value.is_negative() || whole.digits > kMaxCode) {
        return Error::kGcodeUnsupportedCommand;
    }
    // Grbl rounds to hundredths. Here a number with more decimals is no code.
    Decimal scaled = value;
    std::int64_t factor = 100;
    while (factor > 1 && scaled.fraction_digits > 0) {
        --scaled.fraction_digits;
        factor /= 10;
    }
    scaled.digits *= factor;
    if (!is_whole(scaled, kMaxCode * 100 + 99)) {
        return Error::kGcodeUnsupportedCommand;
    }
    const Code code{whole.digits, whole_part(scaled) - whole.digits * 100};
    return upper_case == 'G' ? apply_g(command, code) : apply_m(command, code);
}

constexpr char to_upper(char c) noexcept
{
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

// A longer number is refused, since the character after its first part is no letter.
constexpr std::size_t kMaxNumberLength = 48;

// The significant characters of a line. A '(' opens a comment up to ')' or the end of the line.
class Characters {
public:
    explicit Characters(std::string_view line) noexcept : line_{line} {}

    // Moves to the next significant character; false at the end.
    bool skip() noexcept
    {
        for (; place_ < line_.size(); ++place_) {
            const char c = line_[place_];
            if (c == ';') {
                place_ = line_.size();
                return false;
            }
            if (c == '(') {
                const std::size_t end = line_.find(')', place_);
                place_ = end == std::string_view::npos ? line_.size() - 1 : end;
                continue;
            }
            if (c != ' ' && c != '\t' && c != '\r' && c != '/') {
                return true;
            }
        }
        return false;
    }
    char take() noexcept { return line_[place_++]; }

    // The characters of a number, without spaces and comments between them; Grbl drops those
    // before it reads anything, so `X1 0` is X10. Stops where the buffer is full.
    std::string_view number(std::array<char, kMaxNumberLength>& buffer) noexcept
    {
        std::size_t size = 0;
        while (size < buffer.size() && skip()) {
            const char c = line_[place_];
            const bool part = (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
            if (!part) {
                break;
            }
            ++place_;
            buffer[size] = c;
            ++size;
        }
        return {buffer.data(), size};
    }

private:
    std::string_view line_;
    std::size_t place_{0};
};

// Skips a program number, `O1001` or `:1001`, which means nothing to a controller that stores no
// programs. With any other word the line belongs to a subprogram and is refused.
Status skip_program_number(Characters& characters, const Command& command) noexcept
{
    std::array<char, kMaxNumberLength> buffer{};
    const std::string_view text = characters.number(buffer);
    const bool alone = command.groups == 0 && (command.words & ~letter('N')) == 0;
    bool digits = !text.empty();
    for (const char c : text) {
        digits = digits && c >= '0' && c <= '9';
    }
    return alone && digits && !characters.skip() ? Status{kDone}
                                                 : Status{Error::kGcodeUnsupportedCommand};
}

}  // namespace

Status read_command(std::string_view line, const ModalState& modal, Command& command) noexcept
{
    command = Command{};
    command.modal = modal;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (line.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
        line.remove_prefix(kByteOrderMark.size());
    }
    Characters characters{line};
    bool first = true;
    while (characters.skip()) {
        const char upper_case = to_upper(characters.take());
        if (first && upper_case == '%') {
            return kDone;
        }
        first = false;
        if (upper_case == 'O' || upper_case == ':') {
            return skip_program_number(characters, command);
        }
        if (upper_case < 'A' || upper_case > 'Z') {
            return Error::kExpectedCommandLetter;
        }
        std::array<char, kMaxNumberLength> buffer{};
        const std::string_view text = characters.number(buffer);
        std::size_t place = 0;
        const Result<Decimal> value = read_decimal(text, place);
        if (!value) {
            return value.error();
        }
        if (place != text.size()) {
            // A second sign or point, which is no letter.
            return Error::kExpectedCommandLetter;
        }
        if (const Status status = apply_word(command, upper_case, *value); !status) {
            return status;
        }
    }
    return kDone;
}

}  // namespace cusp::gcode
