// Shift registers, FIFOs and scratch registers of a state machine, and what is forbidden to it.
#include <utility>

#include "tests/target/cosim/rp2350/pio_bench.hpp"

namespace cusp::cosim::rp2350 {

TEST_GROUP_BASE(PioData, PioBench){};

TEST(PioData, APullThatDoesNotBlockTakesX)
{
    map(5, 0);
    shift(kRight);
    load({set(kX, 21), pull(0), out(kPins, 5), jmp(3)});
    start();
    run(3);
    CHECK_EQUAL(21U, pio.out());
    CHECK_EQUAL(1U << 24U, pio.read(0x08));
}

TEST(PioData, APullIfEmptyLeavesBits)
{
    map(4, 0);
    shift(kRight | 8U << 25U);
    load({pull(kBlock | kIf), out(kPins, 4)});
    send(0x21);
    send(0x43);
    start();
    run(2);
    CHECK_EQUAL(1U, pio.out());
    run(2);
    CHECK_EQUAL(2U, pio.out());
    run(2);
    CHECK_EQUAL(3U, pio.out());
}

TEST(PioData, APullUnderAutopullIsABarrier)
{
    map(8, 0);
    shift(kAutopull | kRight);
    load({nop(), pull(), out(kPins, 8), jmp(3)});
    send(0x42);
    send(0x99);
    start();
    run(4);
    CHECK_EQUAL(0x42U, pio.out());
    CHECK_EQUAL(1U, pio.read(0x0C) & 15U);
}

TEST(PioData, LoopsWordsBackAWordInTwoCycles)
{
    shift(kAutopull | kAutopush | kRight);
    load({out(kX, 32), in(kX, 32)});
    for (std::uint32_t i = 0; i < 4; ++i) {
        send(100 + i);
    }
    start();
    run(9);
    CHECK_EQUAL(4U, pio.read(0x0C) >> 4U & 15U);
    for (std::uint32_t i = 0; i < 4; ++i) {
        CHECK_EQUAL(100 + i, receive());
    }
}

TEST(PioData, AFullFifoHoldsAnInUntilItIsRead)
{
    map(0, 1);
    shift(kAutopush | kRight | 8U << 20U);
    load({set(kX, 5), in(kX, 8)});
    start();
    run(30);
    CHECK_EQUAL(1U, pio.read(0x08) & 1U);
    CHECK_EQUAL(4U, pio.read(0x0C) >> 4U & 15U);
    CHECK_EQUAL(5U << 24U, receive());
    run(2);
    CHECK_EQUAL(4U, pio.read(0x0C) >> 4U & 15U);
}

TEST(PioData, InsMaskAndMapPins)
{
    levels = 0xF0F00055;
    pio.inputs_changed();
    pio.write(machine(0, 0x14), 28U << 15U);
    shift(8U | 1U << 18U);
    load({in(kPins, 32), push(), jmp(2)});
    run(3);
    start();
    run(3);
    CHECK_EQUAL(0x5FU, receive());
}

TEST(PioData, MovesInvertAndReverse)
{
    shift(kRight);
    load({pull(), mov(kX, 7), mov(kIsr, kX, 1), push(), mov(kIsr, kX, 2), push(), jmp(6)});
    send(0x00000013);
    start();
    run(7);
    CHECK_EQUAL(0xFFFFFFECU, receive());
    CHECK_EQUAL(0xC8000000U, receive());
}

TEST(PioData, AnOutExecutesDataInTheNextCycle)
{
    shift(kAutopull | kRight);
    load({out(7, 32), jmp(0)});
    send(out(kX, 32));
    send(12345678);
    send(in(kX, 32));
    send(push());
    start();
    run(20);
    CHECK_EQUAL(12345678U, receive());
}

TEST(PioData, TheProgramGoesOnBehindAnInstructionThatWasData)
{
    map(0, 2);
    shift(kAutopull | kRight);
    load({out(7, 32), set(kPins, 1), jmp(2)});
    send(with(set(kPins, 2), 1));
    start();
    // The OSR is filled, OUT, SET and its delay, SET of the program.
    check("00110", 1);
    CHECK_EQUAL(1U, pio.out());
}

TEST(PioData, AWordForAFullFifoIsForbidden)
{
    for (std::uint32_t i = 0; i < 5; ++i) {
        send(i);
    }
    expected_violations = 1;
    forbidden("finds its FIFO full");
    CHECK_EQUAL(1U << 16U, pio.read(0x08));
}

TEST(PioData, AWordThatIsNotThereIsForbidden)
{
    static_cast<void>(receive());
    expected_violations = 1;
    forbidden("is not there");
}

TEST(PioData, EncodingsThatAreReservedAreForbidden)
{
    const std::pair<Code, const char*> wrong[] = {
        {mov(kX, 4), "MOV"},         {in(4, 1), "IN from"},    {set(3, 1), "SET"},
        {push(1), "PUSH"},           {pull(1), "PULL"},        {irq(1, 4), "IRQ"},
        {wait(false, 3, 4), "WAIT"}, {irq(8), "another block"}};
    for (const auto& [code, what] : wrong) {
        pio.write(machine(0, 0x10), code);
        ++expected_violations;
        if (code == push(1) || code == pull(1)) {
            continue;
        }
        forbidden(what);
    }
}

TEST(PioData, TheOsrIsNotReadUnderAutopull)
{
    shift(kAutopull | kRight);
    pio.write(machine(0, 0x10), mov(kX, 7));
    expected_violations = 1;
    forbidden("autopull may fill it");
}

TEST(PioData, AForcedInstructionMayNotWait)
{
    pio.write(machine(0, 0x10), pull());
    expected_violations = 1;
    forbidden("has to wait");
}

TEST(PioData, FifosThatHoldWordsAreEmptiedByAnotherJoin)
{
    send(1);
    shift(kRight | kJoinSent);
    CHECK_EQUAL(0U, pio.read(0x0C));
}

TEST(PioData, FifosOfAMachineThatRunsAreNotJoined)
{
    load({nop()});
    start();
    send(1);
    shift(kRight | kJoinSent);
    expected_violations = 1;
    forbidden("joined otherwise");
}

}  // namespace cusp::cosim::rp2350
