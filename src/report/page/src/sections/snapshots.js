// Charts of a run at one time, as a table: histograms, profiles and correlations.
import { numbers, rowOf } from "../data.js";
import { laws, overBins, poisson } from "./laws.js";

const axes = ["x", "y", "z"];

/** Each: the group, what it says, the datasets of its curves with their names, and where x comes
 * from: `borders` of bins, `places` of values, or neither for whole numbers from `first` on. A dataset
 * [samples][3][...] has a curve for each axis. Histograms are divided by their sum and the widths of
 * their bins. */
const snapshots = [
  {
    group: "distributions", title: "Needles in a cell", x: "needles", y: "share of the cells", histogram: true,
    datasets: [["needles_in_cell", "cells"]], first: 0, law: "poisson", untilEmpty: true,
    caption: "A Poisson law for random positions.",
  },
  {
    group: "distributions", title: "Components of the velocity", x: "v_a / √(T_tr/m)", y: "probability density",
    histogram: true, datasets: [["velocity", "v"]], borders: "velocity_borders", law: "normal", log: "y",
    caption: "The component along each axis in thermal units.",
  },
  {
    group: "distributions", title: "Energy of translation", x: "energy / T_tr", y: "probability density",
    histogram: true, datasets: [["energy_tr", "needles"]], borders: "energy_borders", law: "energyOfTranslation", log: "y",
    caption: "Of each needle, in units of the translational temperature.",
  },
  {
    group: "distributions", title: "Energy of rotation", x: "energy / T_rot", y: "probability density",
    histogram: true, datasets: [["energy_rot", "needles"]], borders: "energy_borders", law: "energyOfRotation", log: "y",
    caption: "Of each needle, in units of the rotational temperature.",
  },
  {
    group: "alignment", title: "Alignment with the velocity", x: "Q = 3 cos² − 1", y: "probability density",
    histogram: true, datasets: [["along_velocity", "needles"]], borders: "borders", law: "randomDirectors", log: "y",
    caption: "Q is −1 for needles that fly sideways and 2 for those that fly along themselves.",
  },
  {
    group: "alignment", title: "Alignment with the axes", x: "Q = 3 cos² − 1", y: "probability density",
    histogram: true, datasets: [["along_axes", "along"]], borders: "borders", law: "randomDirectors", log: "y",
    caption: "Of the angle between the needles and each axis of the box.",
  },
  ...["density", "thermal_tr", "thermal_rot"].map((name) => ({
    group: "profiles", title: `Profile: ${{ density: "density", thermal_tr: "thermal energy of translation", thermal_rot: "thermal energy of rotation" }[name]}`,
    x: "position", y: name === "density" ? "needles per volume" : "energy",
    datasets: [[name, "along"]], places: "position", caption: "Means over slabs across each axis.",
  })),
  {
    group: "profiles", title: "Profile: flow", x: "position", y: "length / time", datasets: [["flow", "along"]],
    places: "position", component: "lateral",
    caption: "Size of the mean velocity parallel to the slabs across each axis: shear flow shows here.",
  },
  {
    group: "pair_correlation", title: "Pair correlation", x: "distance", y: "g", datasets: [["g", "g"]],
    borders: "borders", level: [1, "random positions"],
    caption: "Pairs of centres by distance, divided by that of random positions.",
  },
  {
    group: "pair_correlation", title: "Orientation of pairs", x: "distance", y: "⟨(3 cos² − 1)/2⟩", datasets: [["p2", "P₂"]],
    borders: "borders", level: [0, "random directors"],
    caption: "Of the angle between the needles of pairs at this distance.",
  },
  {
    group: "structure_factor", title: "Structure factor", x: "wave number", y: "S(k)", datasets: [["s", "along"]],
    places: "k", level: [1, "random positions"], caption: "Density fluctuations along each axis.",
  },
  {
    group: "collision_statistics", title: "Place of the contacts", x: "distance from the centre / length",
    y: "probability density", histogram: true, datasets: [["arms", "contacts"]], borders: "arms_borders",
    caption: "Along the needle, for the collisions since the sample before.",
  },
  {
    group: "collision_statistics", title: "Angle at contact", x: "angle between the needles", y: "probability density",
    histogram: true, datasets: [["angle", "collisions"]], borders: "angle_borders", law: "angle",
    caption: "For the collisions since the sample before; the law is (2/π) sin².",
  },
  {
    group: "collision_statistics", title: "Normal velocity at contact", x: "normal velocity / thermal one",
    y: "probability density", histogram: true, datasets: [["normal_velocity", "collisions"]],
    borders: "normal_velocity_borders", law: "normalVelocity",
    caption: "For the collisions since the sample before; the law is x exp(−x²/2).",
  },
  {
    group: "collision_statistics", title: "Chains of collisions", x: "length of the chain", y: "share of the chains",
    histogram: true, datasets: [["chains", "chains"]], first: 1, log: "y", untilEmpty: true,
    caption: "Collisions of one pair between which neither needle collided with another.",
  },
];

/** The charts at one time that a run has: {chart, rows, curvesAt(row)}. */
export function snapshotsOf(run) {
  // Of a mixture each is of each species, or of each two.
  const parts = (run.parts ?? []).flatMap((part) =>
    snapshotsOf({ groups: part.groups }).map((one) => ({
      ...one, chart: { ...one.chart, title: `${one.chart.title}: ${part.name}` },
    })),
  );
  return [...snapshotsOfGroups(run), ...parts];
}

function snapshotsOfGroups(run) {
  return snapshots
    .filter(({ group, datasets }) => run.groups[group]?.datasets[datasets[0][0]])
    .map((spec) => {
      const group = run.groups[spec.group];
      const log = spec.log ?? "";
      return {
        group,
        chart: {
          title: spec.title,
          caption: spec.caption,
          x: { label: spec.x, log: log.includes("x") },
          y: { label: spec.y, log: log.includes("y") },
        },
        curvesAt: (row) => curvesAt(spec, group, row),
      };
    });
}

function curvesAt(spec, group, row) {
  const curves = curvesOfRow(spec, group, row);
  const law = lawOf(spec, group, curves);
  const all = law ? [...curves, law] : curves;
  return spec.untilEmpty ? all.map((curve) => shortened(curve, lastFilled(curves) + 2)) : all;
}

function lastFilled(curves) {
  return Math.max(...curves.map((curve) => curve.y.findLastIndex((value) => value > 0)));
}

function shortened(curve, length) {
  const borders = curve.borders?.slice(0, length + 1);
  return { ...curve, x: curve.x.slice(0, length), y: curve.y.slice(0, length), borders };
}

function curvesOfRow(spec, group, row) {
  return spec.datasets.flatMap(([name, text]) => {
    const dataset = group.datasets[name];
    const values = rowOf(dataset, row);
    const perAxis = dataset.shape.length > 2;
    const parts = perAxis ? axes : [""];
    return parts.map((axis, n) => {
      const part = partOf(spec, dataset, values, n, parts.length);
      const x = placesOf(spec, group, part.length, n);
      return {
        name: `${text} ${axis}`.trim(), x, y: ordinates(spec, group, part), colour: n,
        borders: spec.histogram && bordersOf(spec, group, x), points: Boolean(spec.places),
      };
    });
  });
}

// The part of a row that belongs to axis n, and of vectors the size of what lies across that axis.
function partOf(spec, dataset, values, n, parts) {
  const size = values.length / parts;
  const part = values.subarray(n * size, (n + 1) * size);
  if (spec.component !== "lateral") return part;
  return Float64Array.from({ length: size / 3 }, (_, slab) => {
    const vector = [...part.subarray(3 * slab, 3 * slab + 3)];
    vector[n] = 0;
    return Math.hypot(...vector);
  });
}

function placesOf(spec, group, length, n) {
  if (spec.borders) return middles(numbers(group.datasets[spec.borders]));
  if (spec.places) {
    const places = numbers(group.datasets[spec.places]);
    return places.length === length ? places : places.subarray(n * length, (n + 1) * length);
  }
  return Float64Array.from({ length }, (_, k) => k + spec.first);
}

function bordersOf(spec, group, x) {
  if (spec.borders) return numbers(group.datasets[spec.borders]);
  return Float64Array.from({ length: x.length + 1 }, (_, n) => n + spec.first - 0.5);
}

function middles(borders) {
  return Float64Array.from({ length: borders.length - 1 }, (_, n) => (borders[n] + borders[n + 1]) / 2);
}

function ordinates(spec, group, values) {
  if (!spec.histogram) return values;
  const sum = values.reduce((a, b) => a + b, 0);
  const borders = spec.borders && numbers(group.datasets[spec.borders]);
  return Float64Array.from(values, (value, n) => value / sum / (borders ? borders[n + 1] - borders[n] : 1));
}

function lawOf(spec, group, curves) {
  const { x, y } = curves[0];
  const line = { x, colour: -1, dashed: true, beside: true };
  if (spec.level) return { ...line, beside: false, name: spec.level[1], y: x.map(() => spec.level[0]) };
  if (spec.law === "poisson") {
    const mean = y.reduce((sum, share, n) => sum + share * x[n], 0);
    return { ...line, name: "Poisson", y: poisson(mean, x.length) };
  }
  if (!spec.law) return null;
  const law = laws[spec.law];
  return { ...line, name: law.name, y: overBins(numbers(group.datasets[spec.borders]), law) };
}
