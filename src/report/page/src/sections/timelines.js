// Charts of a run over time, as a table: what each shows of which datasets.
import { column, numbers } from "../data.js";
import { pairNames } from "./facts.js";
import { compact, divided, isGeometric, totals } from "./series.js";
import { wallTimelines } from "./wall_timelines.js";

// Where a run has needles, each of these is a function of its groups. A chart is shown if the group
// it is about is in the file.
function theoryOf(groups, name) {
  const dataset = groups.theory?.datasets[name];
  return dataset && { x: numbers(groups.theory.time), y: column(dataset) };
}

function withTheory(groups, name, curve) {
  const theory = theoryOf(groups, name);
  const scaled = theory && { ...theory, y: theory.y.map((value) => value * (curve.factor ?? 1)) };
  return [curve, scaled && { ...scaled, name: `${curve.name}, theory`, colour: -1, dashed: true }];
}

function cooling({ groups }) {
  const { t, of } = totals(groups);
  const energy = of("energy");
  const factor = 1 / energy[0];
  const curve = { name: "E/E(0)", x: t, y: energy.map((e) => e * factor), colour: 0, points: true, factor };
  return withTheory(groups, "energy", curve);
}

function temperatures({ groups }) {
  const { t, of } = totals(groups);
  return ["t_tr", "t_rot"].flatMap((name, colour) =>
    withTheory(groups, name, { name: name === "t_tr" ? "T_tr" : "T_rot", x: t, y: of(name), colour, points: true }),
  );
}

function ratio({ groups, scene }) {
  const { t, of } = totals(groups);
  const tr = theoryOf(groups, "t_tr");
  const rot = theoryOf(groups, "t_rot");
  const late = scene?.ratio_of_theory;
  return [
    { name: "T_tr/T_rot", x: t, y: divided(of("t_tr"), of("t_rot")), colour: 0, points: true },
    tr && rot && { name: "theory", x: tr.x, y: divided(tr.y, rot.y), colour: -1, dashed: true },
    late && { name: "theory, late", x: t, y: t.map(() => late), colour: 1, faint: true },
  ];
}

function deviation({ groups }) {
  if (!groups.theory) return [];
  const { t, of } = totals(groups);
  return [
    ["energy", "E"],
    ["t_tr", "T_tr"],
    ["t_rot", "T_rot"],
  ].map(([name, text], n) => {
    const theory = theoryOf(groups, name);
    return theory && { name: text, x: t, y: divided(of(name), theory.y), colour: n };
  });
}

function collisions({ groups, count }) {
  const { t, of } = totals(groups);
  return [
    { name: "all", x: t, y: of("collisions").map((c) => (2 * c) / count), colour: 0, points: true },
    of("tc_collisions").at(-1) > 0 && {
      name: "elastic by the t_c rule",
      x: t,
      y: of("tc_collisions").map((c) => (2 * c) / count),
      colour: 1,
    },
  ];
}

// Between a sample and the one before it.
function rateOfCollisions({ groups, count }) {
  const { t, of } = totals(groups);
  const made = of("collisions");
  const t_tr = of("t_tr");
  const rate = t.map((time, n) =>
    n ? ((2 / count) * (made[n] - made[n - 1])) / (time - t[n - 1]) / Math.sqrt((t_tr[n] + t_tr[n - 1]) / 2) : NaN,
  );
  return [{ name: "rate / √T_tr", x: t, y: rate, colour: 0, points: true }];
}

// Along the axes along which nothing from outside acts: walls and gravity do along theirs, a thermostat
// and fixed bodies along all. Kicks leave the total as it is.
function momentum({ groups, count, scene, frames }) {
  const all = scene?.driving.andersen || scene?.species.some(({ fixed }) => fixed);
  const free = all ? [] : [0, 1, 2].filter((axis) => frames.periodic[axis] && !scene?.gravity[axis]);
  if (free.length === 0) return [];
  const { t, of } = totals(groups);
  const mass = scene?.mass ?? 1;
  const components = free.map((axis) => of("momentum", axis));
  const thermal = of("t_tr").map((temperature) => Math.sqrt(count * mass * temperature));
  const drift = t.map((_, n) => Math.hypot(...components.map((values) => values[n] - values[0])) / thermal[0]);
  return [{ name: "|P − P(0)| / √(N m T_tr(0))", x: t, y: drift, colour: 0 }];
}

/** Curves of datasets [samples] of one group. */
function plain(group, fields) {
  return ({ groups }) =>
    fields.map(([name, text], n) => ({
      name: text,
      x: numbers(groups[group].time),
      y: column(groups[group].datasets[name]),
      colour: n,
      points: true,
    }));
}

// One curve for each species, beside that of theory.
function ofSpecies(name, text) {
  return ({ groups, scene }) => {
    const { datasets, time } = groups.species;
    const theory = groups.theory?.datasets[`species_${name}`];
    return (scene?.species ?? []).flatMap((species, n) => [
      { name: `${text} of ${species.name}`, x: numbers(time), y: column(datasets[name], n), colour: n, points: true },
      theory && { name: `${species.name}, theory`, x: numbers(groups.theory.time), y: column(theory, n), colour: n, dashed: true },
    ]);
  };
}

function ofPairs({ groups, scene }) {
  const { datasets, time } = groups.species;
  const names = pairNames((scene?.species ?? []).map(({ name }) => name));
  return names.map((name, n) => ({ name, x: numbers(time), y: column(datasets.collisions, n), colour: n, points: true }));
}

// That of the weight is counted, too.
function coolingCaption({ scene, groups }) {
  const whole = scene?.gravity.some((g) => g !== 0);
  const energy = whole ? "Kinetic energy and that of the weight, heights from the low edges of the box," : "Kinetic energy";
  return `${energy} per needle, divided by that at the start${groups.theory ? ", and kinetic theory of a gas that stays homogeneous" : ""}.`;
}

function cellsOf({ groups, count }) {
  const shape = groups.fields?.datasets.density.shape;
  return shape ? { cells: shape[1] * shape[2] * shape[3], needles: count } : null;
}

// With the part that the motion of the centres alone has.
function pressureOfRods({ groups, frames, count }) {
  const { datasets, time } = groups.rods;
  const { t, of } = totals(groups);
  const start = frames.box.reduce((product, edge) => product * edge, 1);
  // Walls with a velocity change the volume, by which rods are packed.
  const packed = datasets.packing_fraction;
  const volumes = packed.has_rows ? column(packed).map((share, n, all) => (start * all[0]) / share) : t.map(() => start);
  return [
    { name: "pressure", x: numbers(time), y: column(datasets.pressure), colour: 0, points: true },
    { name: "ideal gas, N T_tr / V", x: t, y: of("t_tr").map((t_tr, n) => (count * t_tr) / volumes[n]), colour: -1, dashed: true },
  ];
}

// What flights and collisions give together.
function pressureTensor({ groups }) {
  const { datasets, time } = groups.pressure_tensor;
  const sum = (indices, sign) => {
    const collisional = column(datasets[`collisional_${indices}`]);
    return column(datasets[`kinetic_${indices}`]).map((kinetic, n) => sign * (kinetic + collisional[n]));
  };
  return [["xx", 1], ["yy", 1], ["zz", 1], ["yx", -1]].map(([indices, sign], n) => ({
    name: `${sign < 0 ? "-" : ""}P_${indices}`, x: numbers(time), y: sum(indices, sign), colour: n, points: true,
  }));
}

// Since the start, and between a sample and the one before it.
function timeInContact({ groups, count }) {
  const { datasets, time } = groups.contacts;
  const x = numbers(time);
  const spent = column(datasets.time);
  const since = x.map((t, n) => (n ? ((2 / count) * (spent[n] - spent[n - 1])) / (t - x[n - 1]) : NaN));
  return [
    { name: "since the sample before", x, y: since, colour: 0, points: true },
    { name: "since the start", x, y: column(datasets.share), colour: 1, points: true },
  ];
}

// With the values that random velocities and positions have, where the grid is known.
function flowOrder(context) {
  const [translational, rotational] = plain("flow_order", [
    ["translational", "S of translation"],
    ["rotational", "S of rotation"],
  ])(context);
  const grid = cellsOf(context);
  const random = grid && grid.cells / (grid.needles - grid.cells);
  const level = random > 0 && {
    name: "random velocities",
    x: translational.x,
    y: translational.x.map(() => random),
    colour: -1,
    dashed: true,
  };
  return [translational, rotational, level];
}

function secondMoment(context) {
  const [moment] = plain("flow_order", [["second_moment", "second moment"]])(context);
  const grid = cellsOf(context);
  const random = grid && (grid.cells - 1) / grid.needles;
  return [
    moment,
    random && { name: "random positions", x: moment.x, y: moment.x.map(() => random), colour: -1, dashed: true },
  ];
}

function byAxis(name) {
  return ({ groups }) => {
    const { datasets, time } = groups.temperature_by_axis;
    const values = [0, 1, 2].map((axis) => column(datasets[name], axis));
    // Their mean is the temperature of the gas, or of the species.
    const all = values[0].map((_, n) => (values[0][n] + values[1][n] + values[2][n]) / 3);
    return ["x", "y", "z"].map((axis, n) => ({ name: axis, x: numbers(time), y: divided(values[n], all), colour: n }));
  };
}

/** The largest eigenvalue of a symmetric matrix of trace 0, in nine numbers. */
export function largestEigenvalue([a, b, c, , d, e, , , f]) {
  const half = (a * a + d * d + f * f) / 2 + b * b + c * c + e * e;
  if (half === 0) return 0;
  const determinant = a * (d * f - e * e) - b * (b * f - e * c) + c * (b * e - d * c);
  const cosine = (determinant / 2) * (3 / half) ** 1.5;
  return 2 * Math.sqrt(half / 3) * Math.cos(Math.acos(Math.min(1, Math.max(-1, cosine))) / 3);
}

function nematic({ groups }) {
  const { datasets, time } = groups.alignment;
  const tensor = numbers(datasets.order_tensor);
  const x = numbers(time);
  const y = Float64Array.from(x, (_, n) => largestEigenvalue(tensor.subarray(9 * n, 9 * n + 9)));
  return [{ name: "largest eigenvalue", x, y, colour: 0, points: true }];
}

function repeats({ groups }) {
  const { datasets, time } = groups.collision_statistics;
  const y = divided(column(datasets.repeats), column(datasets.collisions));
  return [{ name: "share of repeats", x: numbers(time), y, colour: 0, points: true }];
}

/** Curves of time_correlation, of which the page holds one row. */
function ofLag(fields) {
  return ({ groups }) => {
    const { datasets } = groups.time_correlation;
    return fields.map(([name, text], colour) => (
      { name: text, x: numbers(datasets.lag), y: numbers(datasets[name]), colour, points: true }
    ));
  };
}

function lagCaption(what) {
  return ({ groups }) => {
    const { mean_of_rows: rows } = groups.time_correlation;
    return `${what} ${rows ? `Mean over the ${rows} samples, as many as each lag has.` : "Between the last sample and those before it, as the samples are not evenly spaced in time."}`;
  };
}

// Since the start of the run, which is the first reference; in a steady state, whose samples have one
// distance, the means over all references of equal lag.
function overLag(fields) {
  return ({ groups }) => {
    const { datasets, time } = groups.displacement;
    const steady = !isGeometric(numbers(time));
    return fields.map(([name, text], colour) => {
      const pairs = pairsOfLag(numbers(datasets.lag), numbers(datasets[name]), steady ? 1 : datasets.lag.shape[1]);
      return { name: text, x: pairs.map(([lag]) => lag), y: pairs.map(([, mean]) => mean), colour, points: true };
    });
  };
}

// Lags are equal to nine digits.
function pairsOfLag(lags, values, stride) {
  const sums = new Map();
  for (let n = 0; n < lags.length; n += stride) {
    if (!(lags[n] > 0) || Number.isNaN(values[n])) continue;
    const key = Number(lags[n].toPrecision(9));
    const [sum, count] = sums.get(key) ?? [0, 0];
    sums.set(key, [sum + values[n], count + 1]);
  }
  return [...sums].map(([lag, [sum, count]]) => [lag, sum / count]).sort((a, b) => a[0] - b[0]);
}

/** Each: the group that it needs, what it says, its axes, and its curves. `log` names the axes that
 * are logarithmic where time spans decades, `always` those that are so in any case. */
const timelines = [
  {
    group: "totals", title: "Cooling curve", y: "E/E(0)", log: "xy", curves: cooling,
    caption: coolingCaption,
  },
  {
    group: "totals", title: "Temperatures", y: "energy", log: "xy", curves: temperatures,
    caption: ({ groups }) => `Translational and rotational temperature${groups.theory ? " with kinetic theory" : ""}.`,
  },
  {
    group: "totals", title: "Ratio of the temperatures", y: "T_tr/T_rot", log: "xy", curves: ratio,
    caption: "Equipartition is 1. A cooling gas tends to the constant ratio of theory.",
  },
  {
    group: "theory", title: "Measured over theory", y: "measured / theory", log: "x", curves: deviation,
    caption: "1 where the run follows kinetic theory. Correlations show as a departure from it.",
  },
  {
    group: "totals", title: "Collisions per needle", y: "collisions per needle", log: "xy", curves: collisions,
    caption: "Twice the number of collisions since the start, per needle.",
  },
  {
    group: "totals", title: "Collision rate", y: "1 / (time √energy)", log: "x", curves: rateOfCollisions,
    caption: "Collisions per needle and unit of time since the sample before, divided by √T_tr: constant while the gas stays homogeneous with a fixed ratio of temperatures.",
  },
  {
    group: "totals", title: "Conservation of momentum", y: "thermal momenta", log: "x", curves: momentum,
    caption: "Change of the total momentum since the start along the periodic axes without gravity, in units of its thermal size √(N m T_tr(0)). Rounding alone changes it.",
  },
  ...wallTimelines,
  {
    group: "species", title: "Translational temperature of each species", y: "energy", log: "xy",
    curves: ofSpecies("t_tr", "T_tr"), caption: "Two thirds of the mean energy of translation, with kinetic theory.",
  },
  {
    group: "species", title: "Rotational temperature of each species", y: "energy", log: "xy",
    curves: ofSpecies("t_rot", "T_rot"), caption: "Mean energy of rotation, of rough spheres two thirds of it, with kinetic theory.",
  },
  {
    group: "species", title: "Collisions of each two species", y: "collisions", log: "xy",
    curves: ofPairs, caption: "Since the start.",
  },
  {
    group: "rods", title: "Pressure", y: "energy / volume", log: "xy", curves: pressureOfRods, robust: true,
    caption: "Mean since the sample before, beside that of an ideal gas of as many centres in the box.",
  },
  {
    group: "pressure_tensor", title: "Pressure tensor", y: "energy / volume", log: "x", robust: true,
    curves: pressureTensor, caption: "By flights and collisions, means since the sample before.",
  },
  {
    group: "pressure_tensor", title: "Viscosity", y: "energy time / volume", log: "x", robust: true,
    curves: plain("pressure_tensor", [["viscosity", "-P_yx / rate"]]), // of a gas that is sheared
    caption: "Mean since the sample before.",
  },
  {
    group: "contacts", title: "Time in contact", y: "share of the time", log: "x", curves: timeInContact,
    caption: "Share of its time that a needle slides on another, the mean of all.",
  },
  {
    group: "contacts", title: "Contacts", y: "contacts", log: "xy",
    curves: plain("contacts", [
      ["entered", "entered"],
      ["ended_by_force", "ended by force"],
      ["ended_by_tip", "ended at a tip"],
      ["ended_by_strike", "ended by strikes"],
    ]),
    caption: "Since the start.",
  },
  {
    group: "growth", title: "Packing fraction", y: "packing fraction",
    curves: plain("growth", [["packing_fraction", "packing fraction"]]),
    caption: "Share of the volume of the box that bodies take up as they grow.",
  },
  {
    group: "growth", title: "Pressure of bodies that grow", y: "P V / (N T)", log: "y",
    curves: plain("growth", [["pressure", "P V / (N T)"]]),
    caption: "By the virial, over the last collisions of all bodies.",
  },
  {
    group: "contact_network", title: "Contacts per body", y: "contacts",
    curves: plain("contact_network", [["contacts", "contacts"]]),
    caption: "Mean of the bodies that are no rattlers.",
  },
  {
    group: "contact_network", title: "Rattlers", y: "bodies",
    curves: plain("contact_network", [["rattlers", "rattlers"]]),
    caption: "Bodies that too few contacts hold, taken off again and again.",
  },
  {
    group: "flow_order", title: "Order of the flow, S", y: "S", log: "xy", curves: flowOrder,
    caption: "Energy of the flow of the cells, divided by that of the motion relative to it.",
  },
  {
    group: "flow_order", title: "Inhomogeneity of the density", y: "variance / mean²", log: "xy", curves: secondMoment,
    caption: "Variance of the density over the cells of the grid, divided by its squared mean.",
  },
  {
    group: "velocity_moments", title: "Departure from Gaussian velocities", y: "cumulants and correlations", log: "x",
    robust: true,
    curves: plain("velocity_moments", [
      ["cumulant_v", "fourth cumulant of v"],
      ["cumulant_w", "fourth cumulant of ω"],
      ["speeds", "|v| with |ω|"],
      ["velocity_spin", "v along ω"],
      ["velocity_director", "v along the needle"],
    ]),
    caption: "All vanish for independent Gaussian velocities, up to 1/N. Rare values far from all others may lie beyond the axis; the table has them.",
  },
  {
    group: "temperature_by_axis", title: "T_tr by axis", y: "T_tr of the axis / T_tr", log: "x",
    curves: byAxis("t_tr"), caption: "Translational temperature along each axis. 1 in an isotropic gas.",
  },
  {
    group: "temperature_by_axis", title: "T_rot by axis", y: "T_rot of the axis / T_rot", log: "x",
    curves: byAxis("t_rot"), caption: "Rotational temperature about each axis. 1 in an isotropic gas.",
  },
  {
    group: "alignment", title: "Nematic order", y: "order parameter", log: "x", curves: nematic,
    caption: "Largest eigenvalue of ⟨(3 u u − 1)/2⟩: of the order 1/√N for random directors, 1 for parallel ones.",
  },
  {
    group: "collision_statistics", title: "Repeated collisions", y: "share of the collisions", log: "x", curves: repeats,
    caption: "Collisions whose pair was also the last to collide for both needles.",
  },
  {
    group: "displacement", title: "Mean square displacement", x: "lag", y: "length²", log: "xy", always: true,
    curves: overLag([["parallel", "along the needle"], ["perpendicular", "across it"]]),
    caption: "Since the start, along the director at that time and across it (two directions); in a steady state the mean over all reference times.",
  },
  {
    group: "displacement", title: "Memory of the orientation", x: "lag", y: "correlation", log: "x", always: true,
    curves: overLag([["p1", "⟨cos⟩"], ["p2", "⟨(3 cos² − 1)/2⟩"]]),
    caption: "Of the angle between the director and that at the start; in a steady state the mean over all reference times.",
  },
  {
    group: "time_correlation", title: "Displacement over time", x: "lag", y: "length²", log: "xy", always: true,
    curves: ofLag([["parallel", "along the needle"], ["perpendicular", "across it"]]),
    caption: lagCaption("Mean square, along the earlier director and across it (two directions)."),
  },
  {
    group: "time_correlation", title: "Correlation of directors", x: "lag", y: "correlation", log: "x", always: true,
    curves: ofLag([["p1", "⟨cos⟩"], ["p2", "⟨(3 cos² − 1)/2⟩"]]),
    caption: lagCaption("Of the angle between the directors then and now."),
  },
  {
    group: "time_correlation", title: "Correlation of velocities", x: "lag", y: "length² / time²", log: "x", always: true,
    curves: ofLag([["velocity", "velocity"], ["velocity_parallel", "along the needle"], ["velocity_perpendicular", "across it"]]),
    caption: lagCaption("Mean product of the velocities then and now; along and across the director at each time."),
  },
  {
    group: "time_correlation", title: "Correlation of angular velocities", x: "lag", y: "radians² / time²", log: "x", always: true,
    curves: ofLag([["angular_velocity", "angular velocity"]]),
    caption: lagCaption("Mean product of the angular velocities then and now."),
  },
];

// Those whose abscissa is their own, so that they need no samples of the whole gas.
const overLags = ["displacement", "time_correlation"];

/** The charts that a run has: descriptions for curvesChart, without a range of time. */
export function timelinesOf(run) {
  const whole = timelinesOfGroups(run, run.groups, run.frames.needles_in_file);
  // Of a mixture each observable is of each species, or of each two.
  const parts = (run.parts ?? []).flatMap(({ name, groups }) => {
    const count = run.scene?.species.find((species) => species.name === name)?.count ?? NaN;
    return timelinesOfGroups(run, groups, count).map((chart) => ({ ...chart, title: `${chart.title}: ${name}` }));
  });
  return [...whole, ...parts];
}

function timelinesOfGroups(run, groups, count) {
  const context = { ...run, groups, count };
  const samples = run.groups.totals;
  const overDecades = samples ? spansDecades(numbers(samples.time)) : false;
  return timelines
    .filter(({ group }) => groups[group] && (samples || overLags.includes(group)))
    .map(({ group, title, caption, x = "time", y, log = "", always, robust, curves }) => ({
      group,
      title,
      caption: typeof caption === "function" ? caption(context) : caption,
      notes: notesOf(groups[group]),
      robust,
      x: { label: x, log: (always || overDecades) && log.includes("x") },
      y: { label: y, log: (always || overDecades) && log.includes("y") },
      curves: compact(curves(context)),
    }))
    .filter((chart) => chart.curves.length > 0);
}

export function notesOf(group) {
  return group.rows < group.rows_in_file
    ? [`Shown are ${group.rows} of ${group.rows_in_file} samples, evenly chosen.`]
    : [];
}

function spansDecades(times) {
  const first = times.find((t) => t > 0);
  return first !== undefined && times.at(-1) / first > 30 && times.length > 3 && isGeometric(times);
}
