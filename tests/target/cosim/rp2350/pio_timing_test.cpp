// Small programs on the model of a PIO block, cycle by cycle, as chapter 11 of RP2350's data sheet tells them.
#include <utility>

#include "tests/target/cosim/rp2350/pio_bench.hpp"

namespace cusp::cosim::rp2350 {

TEST_GROUP_BASE(PioTiming, PioBench){};

TEST(PioTiming, DelaysComeAfterTheInstruction)
{
    map(0, 1);
    load({with(set(kPins, 1), 2), set(kPins, 0)});
    start();
    check("111011101110", 0);
}

TEST(PioTiming, AWholeDivisorIsAPeriod)
{
    map(0, 1);
    divide(3);
    load({set(kPins, 1), set(kPins, 0)});
    start();
    check("001110001110001110", 0);
}

TEST(PioTiming, AFractionLengthensSomePeriods)
{
    map(0, 1);
    divide(2, 128);
    load({set(kPins, 1), set(kPins, 0)});
    start();
    // Ticks in cycles 2, 5, 7, 10, 12, 15.
    check("011100111001110", 0);
}

TEST(PioTiming, ADivisorOfZeroIsTheLargest)
{
    map(0, 1);
    divide(0);
    load({set(kPins, 1), jmp(1)});
    start();
    run(65534);
    check("011", 0);
}

TEST(PioTiming, AutopullFeedsABitStreamThatStallsWithTheClockLow)
{
    // The data sheet's example: out pins, 1 side 0 [1]; nop side 1 [1], four bits a word.
    map(1, 0, 1);
    shift(kAutopull | kRight | 4U << 25U);
    load({with(out(kPins, 1), 1), with(nop(), 16 | 1)});
    send(0x5);
    send(0x3);
    start();
    // A cycle to fill the OSR, then four cycles a bit.
    check(
        "0"
        "1111000011110000"
        "1111111100000000"
        "0000",
        0);
    CHECK_EQUAL(1U << 24U, pio.read(0x08));
    send(0x1);
    check("01111000", 0);
}

TEST(PioTiming, TheClockOfABitStreamIsSideSet)
{
    map(1, 0, 1);
    shift(kAutopull | kRight | 4U << 25U);
    load({with(out(kPins, 1), 1), with(nop(), 16 | 1)});
    send(0x5);
    start();
    check(
        "0"
        "0011001100110011"
        "00000",
        8);
}

TEST(PioTiming, ManualPullLoopsOverItsBits)
{
    // set x, 2; pull side 1 [1]; out pins, 1 side 0 [1]; jmp x-- side 1 [1]; out pins, 1 side 0
    map(1, 0, 2);
    shift(kRight);
    load({set(kX, 2), with(pull(), 24 | 1), with(out(kPins, 1), 16 | 1),
          with(jmp(2, kXMinus), 24 | 1), with(out(kPins, 1), 16)});
    pio.write(machine(0, 0x04), 4U << 12U | 1U << 30U);
    send(0xA);
    start();
    check(
        "0"
        "11"
        "0011"
        "0011"
        "0011"
        "00"
        "1111",
        8);
    CHECK_EQUAL(8U, 8U & pio.read(0x3C) >> 5U);
}

TEST(PioTiming, ASideSetComesThoughTheInstructionWaits)
{
    map(0, 0, 1);
    load({with(pull(), 16), with(nop(), 0)});
    start();
    check("1111", 8);
    send(1);
    // The word is seen in the next cycle, the delay and the next instruction follow.
    check("10", 8);
}

TEST(PioTiming, TheDelayOfAnInstructionThatWaitedBeginsAtItsEnd)
{
    map(0, 1);
    load({with(wait(true, 2, 0), 3), set(kPins, 1), jmp(2)});
    start();
    run(5);
    pio.write(0x34, 1);
    check("000011", 0);
    CHECK_EQUAL(0U, pio.read(0x30));
}

TEST(PioTiming, AWordAmidADelayCostsNoCycle)
{
    map(1, 0);
    shift(kAutopull | kRight | 1U << 25U);
    load({with(out(kPins, 1), 4)});
    send(1);
    start();
    check("0111", 0);
    send(0);
    check("110", 0);
}

TEST(PioTiming, AWordInTheCycleOfAnOutCostsOne)
{
    map(1, 0);
    shift(kAutopull | kRight | 1U << 25U);
    load({with(out(kPins, 1), 4)});
    send(1);
    start();
    check("011111", 0);
    send(0);
    check("100000", 0);
}

TEST(PioTiming, TheLastBitIsOutAsTheNextWordComes)
{
    map(1, 0);
    shift(kAutopull | kRight | 1U << 25U);
    load({out(kPins, 1)});
    for (const std::uint32_t word : {1U, 0U, 1U, 0U}) {
        send(word);
    }
    start();
    check("01010", 0);
}

TEST(PioTiming, AnyInstructionBetweenTwoOutsLetsAWordIn)
{
    map(1, 0);
    shift(kAutopull | kRight | 1U << 25U);
    load({out(kPins, 1), nop(), nop(), nop()});
    send(1);
    start();
    check("011", 0);
    send(0);
    check("110", 0);
}

TEST(PioTiming, JumpsByScratchRegisters)
{
    map(0, 5);
    load({set(kX, 0), set(kY, 1), jmp(4, kNotX), set(kPins, 31), jmp(6, kNotY), set(kPins, 1),
          jmp(8, kXIsNotY), set(kPins, 2), jmp(10, kYMinus), set(kPins, 4), jmp(12, kYMinus),
          set(kPins, 8), jmp(12)});
    start();
    run(20);
    // Past !X and X != Y and the first Y--; not past !Y and the second Y--.
    CHECK_EQUAL(8U, pio.out());
}

TEST(PioTiming, ACountdownTakesATickARound)
{
    map(0, 1);
    load({set(kX, 3), jmp(1, kXMinus), set(kPins, 1), jmp(3)});
    start();
    check("0000011", 0);
}

TEST(PioTiming, JumpsByAPinSeeItTwoCyclesLater)
{
    map(0, 1);
    load({jmp(0, kPin), set(kPins, 1), jmp(2)});
    levels = 1U << 5U;
    pio.inputs_changed();
    pio.write(machine(0, 0x04), 5U << 24U | 2U << 12U);
    run(4);
    start();
    run(4);
    levels = 0;
    pio.inputs_changed();
    check("0011", 0);
}

TEST(PioTiming, JumpsWhileTheOsrHoldsBits)
{
    map(0, 1);
    shift(kRight | 8U << 25U);
    load({pull(), out(kX, 3), jmp(1, kOsrNotEmpty), set(kPins, 1), jmp(4)});
    send(0xFF);
    start();
    // Three rounds until eight bits are out.
    check("00000001", 0);
}

TEST(PioTiming, WrapsFromItsTopToItsBottom)
{
    map(0, 1);
    load({nop(), set(kPins, 1), set(kPins, 0), nop()});
    pio.write(machine(0, 0x04), 2U << 12U | 1U << 7U);
    start();
    check("0101010", 0);
    CHECK(pio.read(machine(0, 0x0C)) <= 2);
}

TEST(PioTiming, PinsThatAreMappedWrapAfterTheLast)
{
    pio.write(machine(0, 0x14), 4U << 20U | 30U);
    shift(kAutopull | kRight);
    load({out(kPins, 4)});
    send(0x9);
    start();
    run(2);
    CHECK_EQUAL(0x40000002U, pio.out());
}

TEST(PioTiming, TheHighestMachineWinsAPin)
{
    map(0, 1, 0, 0);
    map(0, 1, 0, 2);
    load({set(kPins, 1), jmp(1)}, 0, 0);
    load({set(kPins, 0), jmp(5)}, 2, 4);
    start(5);
    check("00", 0);
}

TEST(PioTiming, ShiftsToTheLeftGiveTheHighBitsFirst)
{
    map(4, 0);
    shift(0);
    load({pull(), out(kPins, 4), jmp(1)});
    send(0xA5000000);
    start();
    run(2);
    CHECK_EQUAL(0xAU, pio.out());
    run(2);
    CHECK_EQUAL(0x5U, pio.out());
}

TEST(PioTiming, AForcedInstructionMindsNoDivider)
{
    map(0, 3);
    divide(1000);
    pio.write(machine(0, 0x10), set(4, 5));
    pio.write(machine(0, 0x10), set(kPins, 4));
    CHECK_EQUAL(5U, pio.directions());
    CHECK_EQUAL(4U, pio.out());
}

TEST(PioTiming, FlagsAreSeenInTheNextCycle)
{
    map(0, 1, 0, 0);
    load({irq(4), set(kPins, 0), set(kPins, 1), jmp(3)}, 0, 0);
    map(0, 2, 0, 1);
    load({wait(true, 2, 4), set(kPins, 2), jmp(6)}, 1, 4);
    start(3);
    // Set in cycle 1, seen in cycle 2, the pin in cycle 3.
    check("001", 1);
    CHECK_EQUAL(0U, pio.read(0x30));
}

TEST(PioTiming, RelativeFlagsAddTheNumberOfTheMachine)
{
    load({irq(0x13), jmp(1)}, 2, 0);
    start(4);
    run(2);
    CHECK_EQUAL(1U << 1U, pio.read(0x30));
}

TEST(PioTiming, AnIrqThatWaitsGoesOnOnceItIsCleared)
{
    map(0, 1);
    load({irq(3, 1), set(kPins, 1), jmp(2)});
    pio.write(0x170, 1U << 11U);
    start();
    check("0000", 0);
    CHECK(circuit.interrupt_lines[15]);
    CHECK_EQUAL(8U, pio.read(0x30));
    pio.write(0x30, 8);
    CHECK(!circuit.interrupt_lines[15]);
    check("01", 0);
}

TEST(PioTiming, JoinedFifosHoldEightWords)
{
    shift(kRight | kJoinSent);
    for (std::uint32_t i = 0; i < 8; ++i) {
        CHECK(pio.wants(0));
        send(i);
    }
    CHECK(!pio.wants(0));
    CHECK_EQUAL(8U, pio.read(0x0C) & 15U);
    CHECK_EQUAL(1U << 16U, pio.read(0x04) & 1U << 16U);
}

TEST(PioTiming, StatusTellsTheLevelOfAFifo)
{
    shift(kRight);
    load({mov(kX, 5), in(kX, 32), push(), jmp(3)});
    pio.write(machine(0, 0x04), 3U << 12U | 1U);
    start();
    run(3);
    CHECK_EQUAL(0xFFFFFFFFU, receive());
}

TEST(PioTiming, AFifoThatIsStorageIsReadByPlace)
{
    shift(kRight | 1U << 15U);
    load({set(kX, 9), mov(kIsr, kX), static_cast<Code>(0x8018 | 2), jmp(3)});
    start();
    run(4);
    CHECK_EQUAL(9U, pio.read(0x128 + 8));
}

TEST(PioTiming, AMachineThatIsStoppedAmidADelayEndsItLater)
{
    map(0, 1);
    load({with(set(kPins, 1), 9), set(kPins, 0), jmp(2)});
    start();
    run(4);
    pio.write(0x00, 0);
    check("1111111111111111", 0);
    pio.write(0x00, 1);
    check("1111110", 0);
}

TEST(PioTiming, AskForWordsEachTimeOneIsTaken)
{
    map(1, 0);
    shift(kAutopull | kRight);
    load({out(kPins, 32)});
    send(1);
    send(0);
    start();
    const unsigned before = requests;
    run(4);
    CHECK_EQUAL(2U, requests - before);
}

}  // namespace cusp::cosim::rp2350
