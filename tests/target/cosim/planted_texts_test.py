#!/usr/bin/env python3
"""Each fault of mutations.py is planted in a text that its file still has, else it would never be planted."""
import sys
import unittest

import mutations


class PlantedTexts(unittest.TestCase):
    def test_are_in_their_files(self):
        tables = [table for name, table in vars(mutations).items() if name.startswith("FAULTS")]
        gone = [f"{fault}: {file} has no {old!r}" for table in tables for fault, (file, old, _) in table.items()
                if old not in (mutations.ROOT / file).read_text()]
        self.assertGreater(sum(map(len, tables)), 40)
        self.assertEqual(gone, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
