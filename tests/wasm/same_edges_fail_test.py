#!/usr/bin/env python3
"""Shows that the comparison of runs sees what it looks for."""
import copy
import unittest

import same_edges

RUN = {"edges_crc32": "01234567", "duration_s": 1.5, "total_s": 2.0, "lines": 3, "moves": {"rapid": 1, "line": 0, "arc": 0, "nurbs": 0},
       "steps": [1, 2, 3], "end_mpos_mm": [0.1, 0, 0], "length_mm": 4.0, "max_velocity": [1, 1, 1], "max_acceleration": [1, 1, 1],
       "max_jerk": [1, 1, 1], "pauses": 0, "alarm": None, "errors": [{"line": 3, "code": 20, "text": "a"}]}


class Comparison(unittest.TestCase):
    def test_equal_runs_have_no_difference(self):
        self.assertIsNone(same_edges.difference(RUN, copy.deepcopy(RUN)))

    def test_each_figure_is_seen(self):
        for key, value in {"edges_crc32": "01234568", "duration_s": 1.5000000000000002, "steps": [1, 2, 4], "alarm": 5,
                           "end_mpos_mm": [0.1, 0, 1e-9], "errors": [], "max_jerk": [1, 1, 2]}.items():
            self.assertIn(key, same_edges.difference(RUN, {**RUN, key: value}))

    def test_another_line_of_an_error_is_seen(self):
        other = {**RUN, "errors": [{"line": 4, "code": 20, "text": "a"}]}
        self.assertIn("errors", same_edges.difference(RUN, other))


if __name__ == "__main__":
    unittest.main()
