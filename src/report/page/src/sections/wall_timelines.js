// Charts over time of gases with walls, gravity and driving.
import { column, numbers } from "../data.js";
import { sideName } from "../boundaries.js";
import { numberText } from "../numbers.js";
import { areaOf, sourceName, wallsOf, weightOn } from "./facts.js";
import { byPhase } from "./phases.js";
import { totals } from "./series.js";

// Of each wall what its counter has gained since the sample before, per time and `unit`.
function ratesAtWalls(run, name, unit) {
  const { datasets, time } = run.groups.walls;
  const x = numbers(time);
  return wallsOf(run).map((wall, n) => {
    const values = column(datasets[name], n);
    const y = x.map((t, row) => (row ? (values[row] - values[row - 1]) / (t - x[row - 1]) / unit : NaN));
    return { name: sideName(wall), x, y, colour: n, points: true };
  });
}

function forces(run) {
  const x = numbers(run.groups.walls.time);
  const weight = wallsOf(run).map((wall) => weightOn(wall, run)).find(Boolean);
  return [...ratesAtWalls(run, "impulse", 1), weight && { name: "weight", x, y: x.map(() => weight), colour: -1, dashed: true }];
}

// That of the normal components alone.
function pressures(run) {
  const { datasets, time } = run.groups.walls;
  const x = numbers(time);
  const walls = wallsOf(run);
  const bearing = walls.find((wall) => weightOn(wall, run));
  const level = bearing && weightOn(bearing, run) / areaOf(bearing, run);
  return [
    ...walls.map((wall, n) => ({ name: sideName(wall), x, y: column(datasets.pressure, n), colour: n, points: true })),
    level && { name: "weight over area", x, y: x.map(() => level), colour: -1, dashed: true },
  ];
}

// What each effect has put into the energy per needle since the start.
function sourcesOfEnergy(run) {
  const { datasets } = run.groups.energy_budget;
  const { pairs, walls: ofWalls, velocities_set: ofCaller, ...effects } = datasets;
  const single = Object.entries({ pairs, ...effects, velocities_set: ofCaller })
    .filter(([, dataset]) => dataset)
    .map(([name, dataset]) => [sourceName(name), column(dataset)]);
  const walls = ofWalls ? wallsOf(run).map((wall, n) => [`wall at ${sideName(wall)}`, column(ofWalls, n)]) : [];
  return [...single, ...walls].filter(([text, values]) => text !== "velocities set" || values.some((value) => value !== 0));
}

function changeOfEnergy({ groups }) {
  const { t, of } = totals(groups);
  const energy = of("energy");
  return { t, change: energy.map((e) => e - energy[0]) };
}

function budget(run) {
  const { t, change } = changeOfEnergy(run);
  return [
    ...sourcesOfEnergy(run).map(([name, y], colour) => ({ name, x: t, y, colour, points: true })),
    { name: "change of the energy", x: t, y: change, colour: -1, dashed: true },
  ];
}

// By how much the sources miss the change of the energy, at most.
function budgetCaption(run) {
  const { change } = changeOfEnergy(run);
  const sources = sourcesOfEnergy(run);
  const off = change.map((value, n) => Math.abs(sources.reduce((sum, [, values]) => sum + values[n], -value)));
  return `Energy per needle since the start; below 0 it is taken out. The sum of all is the change of the energy${run.scene?.gravity.some((g) => g !== 0) ? ", that of the weight included" : ""}: it is met to ${numberText(Math.max(...off), 2)}.`;
}

// Since the sample before.
function powers(run) {
  const { t } = totals(run.groups);
  return sourcesOfEnergy(run).map(([name, values], colour) => ({
    name, x: t, colour, points: true,
    y: t.map((time, n) => (n ? (values[n] - values[n - 1]) / (time - t[n - 1]) : NaN)),
  }));
}

function centreOfMass({ groups }) {
  const { datasets, time } = groups.centre_of_mass;
  return Array.from(numbers(datasets.axis), (axis, n) => (
    { name: ["x", "y", "z"][axis], x: numbers(time), y: column(datasets.position, n), colour: n, points: true }
  ));
}

function temperatures({ groups }) {
  const { t, of } = totals(groups);
  return [["t_tr", "T_tr"], ["t_rot", "T_rot"]].map(([field, name], colour) => ({ name, x: t, y: of(field), colour }));
}

/** Entries of the table in timelines.js. */
export const wallTimelines = [
  {
    group: "walls", title: "Hits on walls", y: "hits per needle and time", log: "x",
    curves: (run) => ratesAtWalls(run, "hits", run.count),
    caption: "Since the sample before.",
  },
  {
    group: "walls", title: "Force on walls", y: "force", log: "x", curves: forces,
    caption: "Impulses per time since the sample before, as the sum of their magnitudes: those along the surface, which thermal walls give, count too.",
  },
  {
    group: "walls", title: "Pressure on walls", y: "energy / volume", log: "x", curves: pressures,
    caption: "Impulses along the normal since the sample before, over time and area.",
  },
  {
    group: "energy_budget", title: "Energy put in and taken out", y: "energy", log: "x", curves: budget,
    caption: budgetCaption,
  },
  {
    group: "energy_budget", title: "Power put in and taken out", y: "energy / time", log: "x", robust: true, curves: powers,
    caption: "Energy per needle and time since the sample before. In a steady state the sum is 0 in the mean.",
  },
  {
    group: "centre_of_mass", title: "Centre of mass", y: "length", log: "x", curves: centreOfMass,
    caption: "Along each axis with walls, from where the low edge of the box is at the start.",
  },
  {
    group: "walls", title: "Pressure by phase", x: "phase / 2π", y: "energy / volume", log: "",
    curves: (run) => byPhase(run, pressures(run)),
    caption: "Means over the later half of the samples, by the phase of the moving wall at each: its surface is off by the sine of it. The pressure is that since the sample before.",
  },
  {
    group: "walls", title: "Temperatures by phase", x: "phase / 2π", y: "energy", log: "",
    curves: (run) => byPhase(run, temperatures(run)),
    caption: "Means over the later half of the samples.",
  },
  {
    group: "centre_of_mass", title: "Centre of mass by phase", x: "phase / 2π", y: "length", log: "",
    curves: (run) => byPhase(run, centreOfMass(run)),
    caption: "Means over the later half of the samples.",
  },
];
