// The section of a sweep: results over the varied keys, and series of each point.
import { element } from "../dom.js";
import { column, numbers } from "../data.js";
import { curvesChart } from "../charts/curves.js";
import { numberText } from "../numbers.js";
import { factList, sourceName, textBehind } from "./facts.js";
import { compact, divided } from "./series.js";

const results = [
  ["time", "Time at the end", "time"],
  ["collisions_per_needle", "Collisions per needle", "collisions per needle"],
  ["collision_rate", "Collision rate", "1 / time"],
  ["energy_ratio", "Energy at the end", "E/E(0)"],
  ["t_tr", "Translational temperature at the end", "energy"],
  ["t_rot", "Rotational temperature at the end", "energy"],
];

// Those of each wall, of each effect that gives energy, and of bodies that grow: of a name the first
// that it matches, in which the last part is in words.
const families = [
  [/^hits_(.)_(low|high)$/, "Hits on the wall at $1 $2", "hits"],
  [/^pressure_(.)_(low|high)$/, "Pressure on the wall at $1 $2", "energy / volume"],
  [/^budget_(.)_(low|high)$/, "Energy put in: wall at $1 $2", "energy per needle"],
  [/^budget_(.+)$/, "Energy put in: $1", "energy per needle"],
  [/^growth_(.+)$/, "Growth: $1"],
  [/^network_(.+)$/, "Network: $1"],
];

/** All results that have charts: [name, title, label]. */
function chartedResults(sweep) {
  const more = Object.keys(sweep.results).flatMap((name) => {
    const family = families.find(([pattern]) => pattern.test(name));
    if (!family) return [];
    const [pattern, title, label] = family;
    const [, word, side] = name.match(pattern);
    const text = sourceName(word);
    return [[name, title.replace("$1", text).replace("$2", side), label ?? text]];
  });
  return [...results.filter(([name]) => sweep.results[name]), ...more];
}

/** Elements of the section. */
export function sweepSection(sweep) {
  const keys = Object.keys(sweep.parameters);
  const axis = axisOf(sweep);
  const members = sweep.members.reduce((a, b) => a + b, 0);
  return [
    factList(
      [
        ["Points of the grid", sweep.members.length],
        ["Runs in the means", members],
        ["Varied", keys.join(", ") || "nothing but the seed"],
        ["Version", sweep.version],
      ],
      "facts",
    ),
    textBehind("Grid", sweep.grid),
    textBehind("Scene", sweep.scene),
    resultsTable(sweep),
    ...(axis ? [element("h3", {}, "Results over the grid"), element("div", { class: "charts" }, resultCharts(sweep, axis))] : []),
    element("h3", {}, "Over time"),
    element("div", { class: "charts" }, seriesCharts(sweep)),
  ];
}

function labelOf(sweep, point, without) {
  const parts = Object.entries(sweep.parameters)
    .filter(([key]) => key !== without)
    .map(([key, values]) => `${key.split(".").at(-1)} = ${typeof values[point] === "number" ? numberText(values[point]) : values[point]}`);
  return parts.join(", ") || "all";
}

// The varied key with the most values that are numbers.
function axisOf(sweep) {
  const candidates = Object.entries(sweep.parameters)
    .filter(([, values]) => values.every((value) => typeof value === "number"))
    .map(([key, values]) => [key, new Set(values).size])
    .filter(([, size]) => size > 1)
    .sort((a, b) => b[1] - a[1]);
  return candidates[0]?.[0];
}

function estimatesOf(quantity) {
  const y = column(quantity.mean);
  const error = column(quantity.standard_error).map((e) => (Number.isNaN(e) ? 0 : e));
  return { y, low: y.map((v, n) => v - error[n]), high: y.map((v, n) => v + error[n]) };
}

function resultCharts(sweep, axis) {
  const values = sweep.parameters[axis];
  return chartedResults(sweep)
    .map(([name, title, label]) => {
      const { y, low, high } = estimatesOf(sweep.results[name]);
      const curves = new Map();
      values.forEach((_, point) => {
        const family = labelOf(sweep, point, axis);
        curves.set(family, [...(curves.get(family) ?? []), point]);
      });
      return curvesChart({
        title,
        caption: "Means over the seeds with their standard errors.",
        x: { label: axis },
        y: { label },
        curves: [...curves].map(([family, points], n) => {
          const sorted = points.sort((a, b) => values[a] - values[b]);
          const pick = (array) => Float64Array.from(sorted, (point) => array[point]);
          return { name: family === "all" ? title : family, x: pick(values), y: pick(y), low: pick(low), high: pick(high), colour: n, points: "alone" };
        }),
      });
    });
}

function seriesCharts(sweep) {
  const scaled = ({ quantities }) => {
    const { y, low, high } = estimatesOf(quantities.energy);
    const share = (values) => values.map((v) => v / y[0]);
    return { y: share(y), low: share(low), high: share(high) };
  };
  const ratio = ({ quantities }) => ({ y: divided(column(quantities.t_tr.mean), column(quantities.t_rot.mean)) });
  const curves = (valuesOf) =>
    sweep.series.map((series, point) => ({
      name: labelOf(sweep, point), x: numbers(series.time), ...valuesOf(series), colour: point,
    }));
  const ratios = compact(curves(ratio));
  return [
    curvesChart({
      title: "Cooling curves", caption: "Mean energy per needle at each point, divided by that at the start, with standard errors.",
      x: { label: "time", log: true }, y: { label: "E/E(0)", log: true }, curves: curves(scaled),
    }),
    ratios.length > 0 && curvesChart({
      title: "Ratios of the temperatures", caption: "Mean T_tr divided by mean T_rot at each point.",
      x: { label: "time", log: true }, y: { label: "T_tr/T_rot", log: true }, curves: ratios,
    }),
  ];
}

function resultsTable(sweep) {
  const names = Object.keys(sweep.results);
  const keys = Object.keys(sweep.parameters);
  const cell = (name, point) => {
    const { mean, standard_error: error } = sweep.results[name];
    const [value, spread] = [column(mean)[point], column(error)[point]];
    return Number.isNaN(spread) ? numberText(value) : `${numberText(value)} ± ${numberText(spread, 2)}`;
  };
  return element(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": "Results at each point" },
    element(
      "table",
      {},
      element("caption", {}, "Means at the ends of the runs, with standard errors"),
      element(
        "thead",
        {},
        element("tr", {}, [...keys, "runs", ...names].map((name) => element("th", { scope: "col" }, name.replaceAll("_", " ")))),
      ),
      element(
        "tbody",
        {},
        sweep.members.map((count, point) =>
          element(
            "tr",
            {},
            keys.map((key) => element("th", { scope: "row" }, typeof sweep.parameters[key][point] === "number" ? numberText(sweep.parameters[key][point]) : sweep.parameters[key][point])),
            element("td", {}, String(count)),
            names.map((name) => element("td", {}, cell(name, point))),
          ),
        ),
      ),
    ),
  );
}
