"""SweptHeights: how low a program's feed moves cut at any points, by positions of its tools along them.

Where a part has no undercut, all above the lowest position of a tool is gone, and nothing else. It reads programs as
stock_walk.py does, and knows nothing of features, operations or offsets.
"""
import math

import numpy

from stock_walk import STEP, moves, positions

CELL = 2.0  # mm
APART_OF_CONES = 0.05  # mm: beside its tip a cone's flank is wrong by far less then


class SweptHeights:
    def __init__(self, program):
        """Of each tool the positions of its tip, in cells of the plan."""
        at = {}
        for _, tool, rapid, start, end, arc in moves(program):
            if not rapid:
                apart = APART_OF_CONES if tool.rise else STEP
                at.setdefault(tool, [start]).extend(positions(start, end, arc, apart))
        self.cells = []
        for tool, places in at.items():
            places = numpy.array(places)
            keys = numpy.floor(places[:, :2] / CELL).astype(int)
            order = numpy.lexsort((keys[:, 1], keys[:, 0]))
            places, keys = places[order], keys[order]
            ends = numpy.flatnonzero(numpy.any(numpy.diff(keys, axis=0), axis=1)) + 1
            cells = {tuple(keys[i]): part for i, part in zip([0, *ends], numpy.split(places, ends))}
            self.cells.append((tool, cells))

    @staticmethod
    def end_heights(tool, away):
        """Of the tool's lower side over its tip."""
        if tool.ball:
            return tool.radius - numpy.sqrt(numpy.maximum(0, tool.radius ** 2 - away ** 2))
        return tool.rise * away

    def at(self, x, y):
        """z of the lowest cut over the point; infinity where nothing cuts."""
        lowest = math.inf
        for tool, cells in self.cells:
            reach = math.ceil(tool.radius / CELL)
            i, j = math.floor(x / CELL), math.floor(y / CELL)
            near = [cells[a, b] for a in range(i - reach, i + reach + 1) for b in range(j - reach, j + reach + 1)
                    if (a, b) in cells]
            if near:
                places = numpy.concatenate(near)
                away = numpy.hypot(places[:, 0] - x, places[:, 1] - y)
                inside = away <= tool.radius
                if inside.any():
                    lowest = min(lowest, (places[inside, 2] + self.end_heights(tool, away[inside])).min())
        return lowest
