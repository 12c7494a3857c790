// Charts of a run at one time, as a table: histograms, profiles and correlations.
import { openSides } from "../boundaries.js";
import { numbers, rowOf } from "../data.js";
import { rotationsOf } from "./facts.js";
import { energyOf, laws, overBins, poisson } from "./laws.js";
import { isGeometric } from "./series.js";
import { largestEigenvalue } from "./timelines.js";

const axes = ["x", "y", "z"];

// What is drawn of vectors and tensors, one for each place: of how many numbers, and which of them.
const lateral = { width: 3, of: (vector, axis) => Math.hypot(...vector.map((value, n) => (n === axis ? 0 : value))) };
const nematic = { width: 9, of: largestEigenvalue };

/** Each: the group, what it says, the datasets of its curves with their names, and where x comes
 * from: `borders` of bins, `places` of values, or neither for whole numbers from `first` on. A dataset
 * [samples][3][...] has a curve for each axis, or for each axis with walls if the group says which
 * these are. Histograms are divided by their sum and the widths of their bins. Where samples have one
 * distance, `averaged` adds the mean over their later half, weighted by the density. `robust` is that of
 * curvesChart. */
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
    group: "profiles", title: "Profile: flow", x: "position", y: "length / time", datasets: [["flow", "along", lateral]],
    places: "position",
    caption: "Size of the mean velocity parallel to the slabs across each axis: shear flow shows here.",
  },
  {
    group: "wall_profiles", title: "Between walls: density", x: "position", y: "needles per volume",
    datasets: [["density", "along"]], places: "position", averaged: true,
    caption: "Of centres, in slabs across each axis with walls. Where a side is open, the axis ends with the needles; there are slabs beyond.",
  },
  {
    group: "wall_profiles", title: "Between walls: temperatures", x: "position", y: "energy",
    datasets: [["t_tr", "T_tr"], ["t_rot", "T_rot"], ["t_normal", "T along the axis"]], places: "position", averaged: true,
    robust: true,
    caption: "Of translation, of rotation, and of the motion along the axis alone.",
  },
  {
    group: "wall_profiles", title: "Between walls: flow", x: "position", y: "length / time",
    datasets: [["flow", "along"]], places: "position", averaged: true, robust: true,
    caption: "Mean velocity along the axis.",
  },
  {
    group: "wall_profiles", title: "Between walls: order", x: "position", y: "order",
    datasets: [["p2", "P₂ along"], ["order_tensor", "nematic order", nematic]], places: "position", averaged: true,
    level: [0, "random directors"],
    caption: "P₂ = ⟨(3 cos² − 1)/2⟩ of the angle to the axis: 1 along it, −1/2 across it. The nematic order is the largest eigenvalue of ⟨(3 u u − 1)/2⟩; of n needles at random it is of the order 1/√n.",
  },
  {
    group: "wall_profiles", title: "Between walls: angle to the wall", x: "position", y: "⟨cos²⟩",
    datasets: [["cos2", "along"]], places: "position", averaged: true, level: [1 / 3, "random directors"],
    caption: "Mean square cosine of the angle between needle and axis: 0 for needles that lie along the wall.",
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

/** The charts at one time that a run has: {group, chart, curvesAt(row), rangeAt(row)}, the range of x
 * where it is not that of the curves. */
export function snapshotsOf(run) {
  // Of a mixture each is of each species, or of each two.
  const parts = (run.parts ?? []).flatMap((part) =>
    snapshotsOfGroups({ groups: part.groups, frames: run.frames }, rotationsOf(run.scene, part.name)).map((one) => ({
      ...one, chart: { ...one.chart, title: `${one.chart.title}: ${part.name}` },
    })),
  );
  return [...snapshotsOfGroups(run, rotationsOf(run.scene)), ...parts];
}

// A histogram in which nothing was ever counted is left out, as that of rotation of smooth spheres.
function isThere({ group, datasets: [[name]], histogram }, groups) {
  const dataset = groups[group]?.datasets[name];
  return dataset && !(histogram && numbers(dataset).every((count) => !(count > 0)));
}

function snapshotsOfGroups(run, rotations) {
  return snapshots
    .filter((spec) => isThere(spec, run.groups))
    .map((spec) => {
      const group = run.groups[spec.group];
      const log = spec.log ?? "";
      const means = meansOf(spec, group);
      return {
        group,
        chart: {
          group: spec.group,
          title: spec.title,
          caption: spec.caption,
          robust: spec.robust,
          x: { label: spec.x, log: log.includes("x") },
          y: { label: spec.y, log: log.includes("y") },
        },
        curvesAt: (row) => curvesAt(spec, group, row, means, rotations),
        rangeAt: (row) => (spec.averaged ? rangeOfLayer(group, row, run.frames) : undefined),
      };
    });
}

function curvesAt(spec, group, row, means, rotations) {
  const curves = curvesOfRow(spec, group, (dataset) => rowOf(dataset, row));
  const law = lawOf(spec, group, curves, rotations);
  const drawn = means.length ? curves.map((curve) => ({ ...curve, points: "alone" })) : curves;
  const all = [...drawn, ...means, law].filter(Boolean);
  return spec.untilEmpty ? all.map((curve) => shortened(curve, lastFilled(curves) + 2)) : all;
}

// Of the needles: how many may be beyond the end of an axis at an open side.
const shareBeyond = 1e-3;

// Of x, from wall to wall. At an open side slabs reach far beyond most layers, and the axis ends with
// the layer, at this sample and in the mean.
function rangeOfLayer(group, row, frames) {
  const { density, thickness } = group.datasets;
  const walled = axesOf(group);
  const densities = [rowOf(density, row), isSteady(group) ? meanOfLaterHalf(group, density) : null].filter(Boolean);
  const ends = walled.flatMap((name, n) => {
    const slabs = densities[0].length / walled.length;
    const open = openSides(frames).find(({ axis }) => axes[axis] === name);
    const reached = densities.map((values) => {
      const part = partOf(values, n, walled);
      return endOfLayer(open?.high ? part : part.toReversed());
    });
    const [first, last] = [open && !open.high ? slabs - Math.max(...reached) : 0, open?.high ? Math.max(...reached) : slabs];
    const begin = placesOf({ places: "position" }, group, slabs, n)[0] - numbers(thickness)[n] / 2;
    return [first, last].map((slab) => begin + slab * numbers(thickness)[n]);
  });
  return [Math.min(...ends), Math.max(...ends)];
}

// The number of slabs up to where only this share of all is beyond; 1 at least.
function endOfLayer(densities) {
  const sum = densities.reduce((a, b) => a + b, 0);
  let beyond = 0;
  const last = densities.findLastIndex((value) => (beyond += value) > shareBeyond * sum);
  return Math.max(last + 1, 1);
}

function isSteady(group) {
  return group.rows >= 4 && !isGeometric(numbers(group.time));
}

// Curves of the mean over the later half of the samples.
function meansOf(spec, group) {
  if (!spec.averaged || !isSteady(group)) return [];
  return curvesOfRow(spec, group, (dataset) => meanOfLaterHalf(group, dataset)).map((curve) => (
    { ...curve, name: `${curve.name}, mean of the later half`, points: false }
  ));
}

// Of a dataset of slabs, weighted by the density.
function meanOfLaterHalf(group, dataset) {
  const weights = group.datasets.density;
  const slabs = rowOf(weights, 0).length;
  const width = rowOf(dataset, 0).length / slabs;
  const sum = new Float64Array(slabs * width);
  const total = new Float64Array(slabs);
  const first = Math.floor(group.rows / 2);
  for (let row = first; row < group.rows; ++row) {
    const [values, weight] = [rowOf(dataset, row), rowOf(weights, row)];
    for (let n = 0; n < slabs; ++n) {
      total[n] += weight[n];
      // Without needles a slab has no values.
      for (let k = n * width; weight[n] > 0 && k < (n + 1) * width; ++k) sum[k] += values[k] * weight[n];
    }
  }
  if (dataset === weights) return total.map((value) => value / (group.rows - first));
  return sum.map((value, k) => value / total[Math.floor(k / width)]);
}

function lastFilled(curves) {
  return Math.max(...curves.map((curve) => curve.y.findLastIndex((value) => value > 0)));
}

function shortened(curve, length) {
  const borders = curve.borders?.slice(0, length + 1);
  return { ...curve, x: curve.x.slice(0, length), y: curve.y.slice(0, length), borders };
}

// Of the values that a dataset has.
function curvesOfRow(spec, group, valuesOf) {
  const inFile = spec.datasets.filter(([name]) => group.datasets[name]);
  return inFile.flatMap(([name, text, reduced], number) => {
    const dataset = group.datasets[name];
    const values = valuesOf(dataset);
    const parts = dataset.shape.length > 2 ? axesOf(group) : [""];
    return parts.map((axis, n) => {
      const part = partOf(values, n, parts, reduced);
      const x = placesOf(spec, group, part.length, n, valuesOf);
      return {
        name: `${text} ${axis}`.trim(), x, y: ordinates(spec, group, part), colour: number * parts.length + n,
        borders: spec.histogram && bordersOf(spec, group, x), points: Boolean(spec.places),
      };
    });
  });
}

function axesOf({ datasets }) {
  return datasets.axis ? Array.from(numbers(datasets.axis), (n) => axes[n]) : axes;
}

// The part of a row that belongs to axis n.
function partOf(values, n, parts, reduced) {
  const size = values.length / parts.length;
  const part = values.subarray(n * size, (n + 1) * size);
  if (!reduced) return part;
  const { width, of } = reduced;
  const axis = axes.indexOf(parts[n]);
  return Float64Array.from({ length: size / width }, (_, place) => of([...part.subarray(place * width, (place + 1) * width)], axis));
}

// Where walls with a velocity move the box, places have a row for each sample.
function placesOf(spec, group, length, n, valuesOf) {
  if (spec.borders) return middles(numbers(group.datasets[spec.borders]));
  if (spec.places) {
    const dataset = group.datasets[spec.places];
    const places = dataset.has_rows ? valuesOf(dataset) : numbers(dataset);
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

function lawOf(spec, group, curves, rotations) {
  const { x, y } = curves[0];
  const line = { x, colour: -1, dashed: true, beside: true };
  if (spec.level) return { ...line, beside: false, name: spec.level[1], y: x.map(() => spec.level[0]) };
  if (spec.law === "poisson") {
    const mean = y.reduce((sum, share, n) => sum + share * x[n], 0);
    return { ...line, name: "Poisson", y: poisson(mean, x.length) };
  }
  if (!spec.law) return null;
  const law = spec.law === "energyOfRotation" ? energyOf(rotations) : laws[spec.law];
  return law && { ...line, name: law.name, y: overBins(numbers(group.datasets[spec.borders]), law) };
}
