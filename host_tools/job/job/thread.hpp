// Screw threads by their designations: ISO metric and UN, inside and outside.
//
//     const auto form = thread_of_text("M6");     // 6 mm, a pitch of 1 mm
//     const auto inch = thread_of_text("1/4-20"); // 6.35 mm, 1.27 mm
//     form->bore();                               // 4.917 mm: the hole before the thread
#pragma once

#include <optional>
#include <string>

namespace cusp::job {

struct Operation;

// Nominal sizes, mm.
struct ThreadForm {
    double diameter;  // of the nut's grooves and the bolt's crests
    double pitch;

    // Diameters of the profile with flanks of 60 degrees: of the nut's crests, and of the bolt's grooves with rounded
    // roots. Source: ISO 68-1 and ISO 965-1; ASME B1.1 has the same for UN.
    double bore() const { return diameter - 1.082532 * pitch; }
    double root() const { return diameter - 1.226869 * pitch; }
};

// "M6" has the coarse pitch of ISO 261, "M6x0.75" its own; "1/4-20", "#10-32" and "1 1/8-7" have threads an inch. A pitch is no
// coarser than that of the coarse series of ISO 261 or ASME B1.1. No value for another text.
std::optional<ThreadForm> thread_of_text(const std::string& text);

// The keys of an operation that mills a thread.
struct Thread {
    std::string text;
    ThreadForm form{};
    double oversize{};  // mm, on the diameter
    int teeth{1};       // pitches that the mill spans
    int passes{1};
    bool left{false};
    bool outside{false};

    // mm: diameter of the grooves that are cut.
    double wall() const { return (outside ? form.root() : form.diameter) + oversize; }
    // mm: of the cylinder in which they are cut.
    double blank() const { return outside ? form.diameter : form.bore(); }
    // mm: of the circle of the tool's axis about that of the thread, when its teeth meet this diameter.
    double axis_radius(double across, double tool_radius) const
    {
        return across / 2 + (outside ? tool_radius : -tool_radius);
    }
};

// Null where the operation mills no thread.
const Thread* thread_of(const Operation& operation);

}  // namespace cusp::job
