// Runs lines through an interpreter and collects the resulting actions.
#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/gcode/interpreter.hpp"

namespace cusp::gcode {

class Runner {
public:
    // 0 where the line was taken, the error number where not.
    int run(std::string_view line)
    {
        ++number_;
        const Status status = interpreter.execute(line, number_);
        return finish(status);
    }
    int jog(std::string_view line) { return finish(interpreter.execute_jog(line, number_)); }

    // The moves so far; each starts where the one before ended.
    std::vector<path::Move> moves() const
    {
        std::vector<path::Move> found;
        for (const Action& action : actions) {
            if (const auto* move = std::get_if<path::Move>(&action)) {
                found.push_back(*move);
            }
        }
        return found;
    }
    const path::Move& last_move() const { return std::get<path::Move>(actions.back()); }

    Interpreter interpreter;
    std::vector<Action> actions;

private:
    int finish(const Status& status)
    {
        Action action;
        while (interpreter.next(action)) {
            actions.push_back(action);
        }
        return status ? 0 : static_cast<int>(status.error());
    }

    std::uint32_t number_{0};
};

inline void check_position(double x, double y, double z, const Position& p)
{
    LONGS_EQUAL(to_nanometres(x), p.x);
    LONGS_EQUAL(to_nanometres(y), p.y);
    LONGS_EQUAL(to_nanometres(z), p.z);
}

}  // namespace cusp::gcode
