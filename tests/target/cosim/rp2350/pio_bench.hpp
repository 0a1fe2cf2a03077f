// PioBench: a block of PIO at one cycle a microsecond, with a program loaded from an instruction's names.
#pragma once

#include <CppUTest/TestHarness.h>
#include <initializer_list>
#include <string>

#include "tests/target/cosim/rp2350/pio_model.hpp"

namespace cusp::cosim::rp2350 {

using Code = std::uint16_t;
enum Place : unsigned { kPins = 0, kX = 1, kY = 2, kNull = 3, kIsr = 6 };
enum Condition : unsigned { kAlways, kNotX, kXMinus, kNotY, kYMinus, kXIsNotY, kPin, kOsrNotEmpty };
inline constexpr Code kBlock = 1U << 5U;
inline constexpr Code kIf = 1U << 6U;

inline Code encode(unsigned kind, unsigned high, unsigned low)
{
    return static_cast<Code>(kind << 13U | high << 5U | (low & 31U));
}
inline Code jmp(unsigned to, Condition when = kAlways) { return encode(0, when, to); }
inline Code wait(bool level, unsigned source, unsigned index)
{
    return encode(1, (level ? 4U : 0U) | source, index);
}
inline Code in(unsigned source, unsigned count) { return encode(2, source, count); }
inline Code out(unsigned to, unsigned count) { return encode(3, to, count); }
inline Code push(unsigned how = kBlock) { return static_cast<Code>(0x8000U | how); }
inline Code pull(unsigned how = kBlock) { return static_cast<Code>(0x8080U | how); }
inline Code mov(unsigned to, unsigned from, unsigned operation = 0)
{
    return encode(5, to, operation << 3U | from);
}
inline Code irq(unsigned flag, unsigned how = 0) { return encode(6, how, flag); }
inline Code set(unsigned to, unsigned value) { return encode(7, to, value); }
inline Code nop() { return mov(kY, kY); }
// The field of delay and side-set.
inline Code with(Code code, unsigned field) { return static_cast<Code>(code | field << 8U); }

inline constexpr std::uint32_t kAutopull = 1U << 17U;
inline constexpr std::uint32_t kAutopush = 1U << 16U;
inline constexpr std::uint32_t kRight = 3U << 18U;
inline constexpr std::uint32_t kJoinSent = 1U << 30U;

class PioBench : public Utest {
public:
    Circuit circuit;
    std::uint32_t levels{0};
    unsigned requests{0};
    PioModel pio{
        circuit,
        "PIO0",
        {[] { return 1000000U; }, [this] { return levels; }, [] {}, [this] { ++requests; }, 15}};

    void setup() override { pio.reset(); }

    static std::uint32_t machine(unsigned number, std::uint32_t offset)
    {
        return 0xC8 + number * 0x18 + offset;
    }
    // A program from an address on, that wraps.
    void load(std::initializer_list<Code> program, unsigned number = 0, unsigned at = 0)
    {
        unsigned place = at;
        for (const Code code : program) {
            pio.write(0x48 + 4 * place++, code);
        }
        pio.write(machine(number, 0x04), (place - 1) << 12U | at << 7U);
        pio.write(machine(number, 0x10), jmp(at));
    }
    // OUT and SET to pins from 0 on, side-set to those from 8 on, IN from 0 on.
    void map(unsigned out_pins, unsigned set_pins, unsigned side = 0, unsigned number = 0)
    {
        pio.write(machine(number, 0x14),
                  side << 29U | set_pins << 26U | out_pins << 20U | 8U << 10U);
    }
    void shift(std::uint32_t value, unsigned number = 0)
    {
        pio.write(machine(number, 0x08), value);
    }
    void divide(unsigned whole, unsigned fraction = 0, unsigned number = 0)
    {
        pio.write(machine(number, 0x00), whole << 16U | fraction << 8U);
    }
    void start(unsigned machines = 1) { pio.write(0x00, machines | machines << 8U); }
    void send(std::uint32_t word, unsigned number = 0) { pio.write(0x10 + 4 * number, word); }
    std::uint32_t receive(unsigned number = 0) { return pio.read(0x20 + 4 * number); }

    void cycle()
    {
        const Picoseconds to = circuit.now + kMicrosecond;
        while (pio.due() <= to) {
            circuit.now = pio.due();
            pio.happen();
        }
        circuit.now = to;
    }
    // Levels of a pin after each of so many cycles.
    std::string trace(unsigned cycles, unsigned pin)
    {
        std::string text;
        for (unsigned i = 0; i < cycles; ++i) {
            cycle();
            text += (pio.out() >> pin & 1U) != 0 ? '1' : '0';
        }
        return text;
    }
    void check(const char* expected, unsigned pin)
    {
        const std::string seen = trace(static_cast<unsigned>(std::string{expected}.size()), pin);
        STRCMP_EQUAL(expected, seen.c_str());
    }
    void run(unsigned cycles) { trace(cycles, 0); }
    void forbidden(const char* what)
    {
        CHECK(!circuit.violations.list().empty());
        CHECK_TEXT(circuit.violations.list().back().find(what) != std::string::npos,
                   circuit.violations.list().back().c_str());
    }
    void teardown() override { CHECK_EQUAL(expected_violations, circuit.violations.list().size()); }
    std::size_t expected_violations{0};
};

}  // namespace cusp::cosim::rp2350
