// Names and units of the firmware's settings: those of Grbl, and of cusp.

const axes = ["X", "Y", "Z"];
const perAxis = (first: number, name: string): [number, string][] => axes.map((axis, k) => [first + k, `${axis} ${name}`]);

const names = new Map<number, string>([
  ...perAxis(110, "maximum rate, mm/min"), ...perAxis(120, "acceleration, mm/s²"), ...perAxis(800, "jerk, mm/s³"),
  [11, "path tolerance, mm"], ...perAxis(100, "steps per mm"), ...perAxis(130, "travel, mm"),
  [0, "step pulse, µs"], [29, "direction set-up, µs"], [22, "homing, 0 or 1"], [20, "soft limits, 0 or 1"], [21, "hard limits, 0 or 1"],
  [23, "homing directions, mask"], [24, "homing feed, mm/min"], [25, "homing seek, mm/min"], [26, "homing debounce, ms"],
  [27, "homing pull-off, mm"], [1, "idle lock, ms"], [2, "step invert, mask"], [3, "direction invert, mask"], [4, "enable invert"],
  [5, "limit invert"], [6, "probe invert"], [10, "status report, mask"], [12, "arc tolerance, mm"], [13, "report inches"],
  [30, "spindle maximum, rpm"], [31, "spindle minimum, rpm"], [32, "laser mode"], [341, "tool change mode, 0 to 4"],
  [342, "tool setter search, mm"], [343, "tool setter feed, mm/min"], [344, "tool setter seek, mm/min"], [790, "limit filter, ms"],
  [791, "link watchdog, ms"], [792, "stop on error"],
]);

export const settingName = (number: number): string => names.get(number) ?? "";

/** The limits of motion, which the page shows first. */
export const firstSettings = new Set([110, 111, 112, 120, 121, 122, 800, 801, 802, 11]);
