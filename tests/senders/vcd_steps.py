"""Steps from a VCD file, which may be unfinished."""


def read_steps_in_time(vcd):
    """(microseconds, place in steps from the start), one a step."""
    names, place, levels, now, unit = {}, [0, 0, 0], {}, 0, 1.0
    with open(vcd, encoding="ascii") as file:
        for line in file:
            first = line[:1]
            if first == "$":
                words = line.split()
                if words[0] == "$var":
                    names[words[3]] = words[4]
                elif words[0] == "$timescale":
                    unit = {"us": 1.0, "ns": 0.001, "ms": 1000.0}[words[2]] * float(words[1])
            elif first == "#":
                now = int(line[1:])
            elif first in "01" and line[1:].strip() in names:
                name = names[line[1:].strip()]
                risen = first == "1" and levels.get(name) != "1"
                levels[name] = first
                if name.startswith("step_") and risen:
                    axis = "xyz".index(name[-1])
                    place[axis] += 1 if levels.get("dir_" + name[-1]) == "1" else -1
                    yield int(now * unit), tuple(place)


def read_steps(vcd):
    """The places alone."""
    return [(0, 0, 0)] + [place for _, place in read_steps_in_time(vcd)]
