"""Steps of the iron from a VCD file."""


def read_steps(vcd):
    """Places of the iron in steps from its start, one a step, from a VCD file that may be unfinished."""
    names, place, levels, places = {}, [0, 0, 0], {}, [(0, 0, 0)]
    with open(vcd, encoding="ascii") as file:
        for line in file:
            if line.startswith("$var"):
                words = line.split()
                names[words[3]] = words[4]
            elif line[:1] in "01" and line[1:].strip() in names:
                name = names[line[1:].strip()]
                risen = line[0] == "1" and levels.get(name) != "1"
                levels[name] = line[0]
                if name.startswith("step_") and risen:
                    axis = "xyz".index(name[-1])
                    place[axis] += 1 if levels.get("dir_" + name[-1]) == "1" else -1
                    places.append(tuple(place))
    return places
