#!/usr/bin/env python3
"""Shows that the comparisons of the target tests see the differences they look for."""
import array
import pathlib
import tempfile
import unittest
import zlib

import budgets
import golden
import pins
import ram_map
from qemu import RunFailed

DUMP = """$timescale 1 us $end
$scope module mill $end
$var wire 1 a step_x $end
$var wire 1 b dir_x $end
$var wire 1 c step_y $end
$var wire 1 d dir_y $end
$var wire 1 e step_z $end
$var wire 1 f dir_z $end
$var wire 1 g spindle $end
$upscope $end
$enddefinitions $end
#0
$dumpvars
0a
0b
0c
0d
0e
0f
0g
$end
#10
1b
1g
#15
1a
1e
#17
0a
0e
#20
"""


class Comparisons(unittest.TestCase):
    def read_dump(self, text):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.vcd"
            file.write_text(text)
            return golden.read_dump(file)

    def test_a_dump_becomes_the_boards_list_of_edges(self):
        self.assertEqual(list(self.read_dump(DUMP)),
                         [10 << 8 | 0x08, 15 << 8 | 0x0D, 17 << 8 | 0x08])

    def test_a_finer_timescale_gives_the_same_ticks(self):
        fine = DUMP.replace("1 us", "100 ns")
        for tick in ("10", "15", "17", "20"):
            fine = fine.replace(f"#{tick}\n", f"#{tick}0\n")
        self.assertEqual(self.read_dump(fine), self.read_dump(DUMP))

    def test_a_dump_without_its_wires_is_refused(self):
        with self.assertRaises(RunFailed):
            self.read_dump(DUMP.replace("step_z", "other"))

    def test_a_tick_a_level_or_a_missing_edge_is_seen(self):
        edges = array.array("Q", [256, 513, 1024])
        self.assertIsNone(golden.first_difference(edges, array.array("Q", edges)))
        for other in ([256, 769, 1024], [256, 512, 1024], [256, 513]):
            self.assertIsNotNone(golden.first_difference(edges, array.array("Q", other)))

    def test_the_checksum_of_edges_sees_each_of_them(self):
        edges = array.array("Q", [10 << 8 | 0x08, 15 << 8 | 0x0D, 17 << 8 | 0x08])
        listed = [(10, 1, 1), (15, 0, 1), (15, 4, 1), (17, 0, 0), (17, 4, 0)]
        bytes_of = b"".join(tick.to_bytes(8, "little") + bytes([wire, level]) for tick, wire, level in listed)
        self.assertEqual(golden.edges_crc32(edges), f"{zlib.crc32(bytes_of):08x}")
        self.assertEqual(golden.edges_crc32([]), "00000000")
        self.assertNotEqual(golden.edges_crc32(edges), golden.edges_crc32(edges[:2]))

    def read_pins(self, *lines):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "pins.log"
            file.write_text("".join(line + "\n" for line in lines))
            return pins.read_pins(file)

    def test_pins_follow_the_stores_to_the_port(self):
        write = "GPIOC: unimplemented device write (size 4, offset 0x018, value 0x{:08x})".format
        other = "GPIOB: unimplemented device write (size 4, offset 0x018, value 0x00000004)"
        found = self.read_pins(write(8), "pin 10", other, write(8), "pin 20", write(1), "pin 30",
                               write(0x00010000), "pin 40")
        self.assertEqual([list(part) for part in found], [[10, 30, 40], [8, 9, 8]])
        self.assertIsNone(pins.first_difference([10 << 8 | 8, 15 << 8 | 9, 17 << 8 | 8], found))
        for wrong in ([10 << 8 | 8, 15 << 8 | 1, 17 << 8 | 8], [10 << 8 | 8, 15 << 8 | 9]):
            self.assertIsNotNone(pins.first_difference(wrong, found))
        with self.assertRaises(RunFailed):
            self.read_pins("pin 10")
        with self.assertRaises(RunFailed):
            self.read_pins(write(8), write(1), "pin 10")

    def test_budgets_see_more_and_less_than_two_per_cent(self):
        record = {"tick": (1000, 2000, "-")}
        self.assertEqual(list(budgets.compare({"tick": (1020, 1960)}, record)), [])
        self.assertEqual(len(list(budgets.compare({"tick": (1025, 2000)}, record))), 1)
        self.assertEqual(len(list(budgets.compare({"tick": (1000, 1900)}, record))), 1)
        self.assertEqual(len(list(budgets.compare({}, record))), 1)
        self.assertEqual(len(list(budgets.compare({"new": (1, 1)}, {}))), 1)

    def test_a_map_of_the_memory_that_is_not_true_is_refused(self):
        wanted = ["| bytes | what |", "|---:|---|", "| 10000 | stack |", "| 90000 | image.queue |"]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "a.md"

            def found(lines):
                file.write_text("\n".join(["text", ram_map.BEGIN, *lines, ram_map.END, ""]))
                return ram_map.differences(file, wanted)
            self.assertEqual(found(wanted), [])
            self.assertEqual(found([*wanted[:3], "| 91000 | image.queue |"]), [])
            self.assertEqual(len(found([*wanted[:3], "| 99000 | image.queue |"])), 1)
            self.assertEqual(len(found([*wanted[:3], "| 90000 | image.ring |"])), 1)
            self.assertEqual(len(found(wanted[:3])), 1)
            self.assertEqual(len(found([*wanted, "| 9000 | more |"])), 1)
            file.write_text("no marks")
            self.assertEqual(len(ram_map.differences(file, wanted)), 1)


if __name__ == "__main__":
    unittest.main()
