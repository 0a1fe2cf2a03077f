// Lines of `$$`, `$#`, `$N`, `$I` and `$G`.
#include "firmware/machine/listing.hpp"

#include "firmware/machine/enumerations.hpp"
#include "firmware/machine/report_units.hpp"

namespace cusp::machine {
namespace {

using protocol::PlaceForm;
using protocol::ReplyQueue;

bool write_setting(unsigned index, const Settings& settings, ReplyQueue& out) noexcept
{
    if (index >= kSettingCount) {
        return false;
    }
    const SettingEntry& entry = setting_entry(index);
    if (entry.since == kLayoutWithRotary && !settings.has_rotary()) {
        return true;
    }
    (void)out.character('$').number(entry.number).character('=');
    (void)out.decimal(protocol::scaled(settings.value_at(index), entry.decimals), entry.decimals);
    (void)out.end_line();
    return true;
}

void write_named_position(std::string_view name,
                          Position at,
                          PlaceForm form,
                          ReplyQueue& out) noexcept
{
    (void)out.character('[').text(name).character(':');
    write_position(out, at, form);
    (void)out.character(']').end_line();
}

// As grblHAL: offsets of the axes, then a radius. Nothing for a tool that was not entered.
void write_tool(unsigned tool,
                const gcode::ToolTable& tools,
                PlaceForm form,
                ReplyQueue& out) noexcept
{
    if (!tools.has(tool)) {
        return;
    }
    (void)out.text("[T:").number(tool).character('|');
    write_position(out, {0, 0, tools.length_nm(tool)}, form);
    (void)out.character('|');
    write_length(out, 0, form.inches);
    (void)out.character(']').end_line();
}

bool write_parameter(unsigned index, const ListingSource& source, ReplyQueue& out) noexcept
{
    const gcode::Parameters& parameters = source.parameters;
    const PlaceForm form = place_form(source.stored.settings);
    if (index < gcode::kCoordinateSystems) {
        write_named_position(gcode::kCoordinateSystemNames[index], parameters.work_offsets[index],
                             form, out);
        return true;
    }
    constexpr unsigned kTools = gcode::ToolTable::kTools;
    constexpr unsigned kBeforeTools = 3;
    const unsigned item = index - gcode::kCoordinateSystems;
    if (item >= kBeforeTools && item < kBeforeTools + kTools) {
        write_tool(item - kBeforeTools + 1, parameters.tools, form, out);
        return true;
    }
    switch (item < kBeforeTools ? item : item - kTools) {
        case 0:
            write_named_position("G28", parameters.home, form, out);
            return true;
        case 1:
            write_named_position("G30", parameters.second_home, form, out);
            return true;
        case 2:
            write_named_position("G92", parameters.coordinate_offset, form, out);
            return true;
        case 3:
            (void)out.text("[TLO:");
            write_length(out, parameters.tool_length_offset_nm, form.inches);
            (void)out.character(']').end_line();
            return true;
        case 4:
            write_probe(source.probe, form, out);
            return true;
        default:
            return false;
    }
}

bool write_build(unsigned index, const ListingSource& source, ReplyQueue& out) noexcept
{
    // gSender knows a controller by the word in the user's text.
    constexpr std::string_view kStandardText = "Grbl cusp";
    const std::string_view text = source.stored.build.view();
    switch (index) {
        case 0:
            (void)out.text("[VER:1.1h.20241121:").text(text.empty() ? kStandardText : text);
            (void)out.character(']').end_line();
            return true;
        case 1:
            (void)out.text("[OPT:V,").number(source.planner_blocks).character(',');
            (void)out.number(source.receive_bytes).character(']').end_line();
            return true;
        case 2:
            if (source.glitches == 0) {
                return false;
            }
            (void)out.text("[MSG:Input glitches filtered: ").number(source.glitches);
            (void)out.character(']').end_line();
            return true;
        default:
            return false;
    }
}

std::string_view word_of(gcode::Motion motion) noexcept
{
    using gcode::Motion;
    switch (motion) {
        case Motion::kRapid:
            return "G0";
        case Motion::kLine:
            return "G1";
        case Motion::kArcClockwise:
            return "G2";
        case Motion::kArcCounterClockwise:
            return "G3";
        case Motion::kUniformNurbs:
            return "G5.2";
        case Motion::kNurbs:
            return "G6.2";
        case Motion::kProbeTowards:
            return "G38.2";
        case Motion::kProbeTowardsQuietly:
            return "G38.3";
        case Motion::kProbeAway:
            return "G38.4";
        case Motion::kProbeAwayQuietly:
            return "G38.5";
        case Motion::kNone:
            return "G80";
        case Motion::kDrill:
            return "G81";
        case Motion::kDrillWithDwell:
            return "G82";
        case Motion::kDrillPecking:
            return "G83";
        case Motion::kDrillChipBreaking:
            return "G73";
        case Motion::kBore:
            return "G85";
        case Motion::kBoreStopping:
            return "G86";
        case Motion::kBoreWithDwell:
            return "G89";
    }
    return "";
}

std::string_view word_of(path::Plane plane) noexcept
{
    switch (plane) {
        case path::Plane::kXY:
            return " G17";
        case path::Plane::kZX:
            return " G18";
        case path::Plane::kYZ:
            return " G19";
    }
    return "";
}

}  // namespace

void write_probe(const ProbeResult& probe, PlaceForm form, ReplyQueue& out) noexcept
{
    (void)out.text("[PRB:");
    write_position(out, probe.at, form);
    (void)out.text(probe.found ? ":1]" : ":0]").end_line();
}

bool write_listing_line(Listing listing,
                        unsigned index,
                        const ListingSource& source,
                        ReplyQueue& out) noexcept
{
    switch (listing) {
        case Listing::kSettings:
            return write_setting(index, source.stored.settings, out);
        case Listing::kParameters:
            return write_parameter(index, source, out);
        case Listing::kStartupLines:
            if (index >= kStartupLineCount) {
                return false;
            }
            (void)out.text("$N").number(index).character('=');
            (void)out.text(source.stored.startup[index].view()).end_line();
            return true;
        case Listing::kBuild:
            return write_build(index, source, out);
        case Listing::kSettingDescriptions:
            return write_setting_description(index, source.stored.settings.axes(), out);
        case Listing::kSettingGroups:
            return write_setting_group(index, source.stored.settings.axes(), out);
        case Listing::kErrorCodes:
            return write_error_code(index, out);
        case Listing::kAlarmCodes:
            return write_alarm_code(index, out);
    }
    return false;
}

void write_modal_state(const gcode::ModalState& modal,
                       const Settings& settings,
                       ReplyQueue& out) noexcept
{
    (void)out.text("[GC:")
        .text(word_of(modal.motion))
        .character(' ')
        .text(gcode::kCoordinateSystemNames[modal.coordinate_system]);
    (void)out.text(word_of(modal.plane)).text(modal.inches ? " G20" : " G21");
    (void)out.text(modal.incremental ? " G91" : " G90").text(modal.inverse_time ? " G93" : " G94");
    switch (modal.spindle) {
        case gcode::SpindleMode::kOff:
            (void)out.text(" M5");
            break;
        case gcode::SpindleMode::kClockwise:
            (void)out.text(" M3");
            break;
        case gcode::SpindleMode::kCounterClockwise:
            (void)out.text(" M4");
            break;
    }
    if (modal.mist) {
        (void)out.text(" M7");
    }
    if (modal.flood) {
        (void)out.text(" M8");
    }
    if (!modal.mist && !modal.flood) {
        (void)out.text(" M9");
    }
    (void)out.text(" T").number(modal.tool).text(" F");
    const bool inches = settings.on(Setting::kReportInches) && !modal.inverse_time;
    const float feed = inches ? modal.feed / kMillimetresPerInch : modal.feed;
    (void)out.decimal(protocol::scaled(feed, inches ? 1 : 0), inches ? 1 : 0);
    (void)out.text(" S").decimal(protocol::scaled(modal.spindle_speed, 0), 0);
    (void)out.character(']').end_line();
}

}  // namespace cusp::machine
