// The section of measured results: costs over a number that varies among the cases, or side by side.
import { element } from "../dom.js";
import { curvesChart } from "../charts/curves.js";
import { rangesChart } from "../charts/ranges.js";
import { numberText } from "../numbers.js";

const units = { us_per_collision: "µs per collision", ns_per_item: "ns per event or pair" };

/** Numbers in the names of cases, in the order in which they are tried as an axis. */
const axes = {
  n: "density n L³",
  N: "needles",
  size: "events in the calendar",
  radius: "radius of the capsules / length",
  side: "side of the cells / length",
  k: "shape k",
  threads: "threads",
};

const mostCurves = 8;

/** The heading of the section. */
export function benchTitle({ about, families, file }) {
  if (families) return "First contacts";
  return about.subset ?? file.split("/").at(-1).replace(/\.json$/, "");
}

/** Elements of the section. */
export function benchSection(bench) {
  const { about } = bench;
  const origin = [
    about.command,
    about.machine && `${about.machine}, ${about.cores} cores`,
    about.compiler && `${about.compiler} ${about.flags ?? ""}`,
    about.version && `version ${about.version}`,
    about.commit && `commit ${about.commit}`,
    about.date,
    about.rounds && `${about.rounds} repetitions`,
    about.accuracy && `accuracy: ${about.accuracy}`,
  ];
  const text = element("p", { class: "source" }, origin.filter(Boolean).join(" · "));
  if (bench.families) return [text, missesTable(bench.families)];
  return [text, element("h3", {}, "Costs"), element("div", { class: "charts few" }, chartsOf(bench))];
}

// "n=0.1,N=10000/capsules/auto/standard/avx512/threads:1" as its numbers and its words.
function partsOf(name, unit) {
  const numbers = {};
  const words = [];
  for (const part of name.split(/[/,]/)) {
    const [, key, value] = part.match(/^([A-Za-z]+)[=:]([0-9.e+-]+)$/) ?? [];
    if (key in axes) numbers[key] = Number(value);
    else if (unit === "ns_per_item" && /^\d+$/.test(part)) numbers.size = Number(part);
    else words.push(part);
  }
  return { numbers, words };
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const half = sorted.length / 2;
  return (sorted[Math.floor(half)] + sorted[Math.ceil(half) - 1]) / 2;
}

function chartsOf({ cases, unit }) {
  let left = cases.map((one) => ({
    ...one,
    ...partsOf(one.name, unit),
    middle: median(one.values),
    low: Math.min(...one.values),
    high: Math.max(...one.values),
  }));
  const charts = [];
  for (const axis of Object.keys(axes)) {
    const families = familiesOver(left, axis);
    const used = new Set(families.flatMap((family) => family.members));
    left = left.filter((one) => !used.has(one));
    charts.push(...split(families).map((few) => overNumber(few, axis, units[unit])));
  }
  return [...charts, ...sideBySide(left, units[unit])];
}

// Cases that differ in this number alone, where there are at least three of them.
function familiesOver(cases, axis) {
  const having = cases.filter((one) => axis in one.numbers);
  const families = grouped(having, (one) => JSON.stringify([one.words, { ...one.numbers, [axis]: 0 }]));
  return [...families.values()]
    .filter((members) => members.length >= 3)
    .map((members) => ({
      members: members.sort((a, b) => a.numbers[axis] - b.numbers[axis]),
      labels: labelsOf(members[0], axis),
    }));
}

// What tells a family from others: its words and its other numbers.
function labelsOf({ words, numbers }, axis) {
  const texts = Object.entries(numbers)
    .filter(([key]) => key !== axis)
    .map(([key, value]) => (key === "threads" ? `${value} threads` : `${key} = ${numberText(value)}`));
  return [...texts, ...words];
}

// Into charts of not too many curves, by the first label that they do not share.
function split(families) {
  if (families.length === 0) return [];
  if (families.length <= mostCurves) return [families];
  const place = families[0].labels.findIndex((label, n) => families.some((family) => family.labels[n] !== label));
  if (place < 0) return [families];
  return [...grouped(families, (family) => family.labels[place]).values()].flatMap(split);
}

function common(lists) {
  return lists[0].filter((label, n) => lists.every((list) => list[n] === label));
}

function overNumber(families, axis, unit) {
  const shared = common(families.map((family) => family.labels));
  const interesting = shared.filter((label) => label.includes("=") || !["auto", "standard", "1 threads"].includes(label));
  const nameOf = (labels) => labels.filter((label) => !shared.includes(label)).join(", ");
  return curvesChart({
    title: interesting.length ? interesting.join(", ") : `Cost by ${axes[axis]}`,
    caption: "Median of the repetitions with their range.",
    x: { label: axes[axis], log: true },
    y: { label: unit, log: true },
    curves: families.map(({ members, labels }, n) => {
      const pick = (key) => Float64Array.from(members, (one) => one[key]);
      return {
        name: (nameOf(labels) || unit) + (members[0].baseline ? " (baseline)" : ""),
        x: Float64Array.from(members, (one) => one.numbers[axis]),
        y: pick("middle"),
        low: pick("low"),
        high: pick("high"),
        colour: n,
        dashed: members[0].baseline,
        points: true,
      };
    }),
  });
}

// A chart for each scene, which the name begins with; one for all scenes of few cases.
function sideBySide(cases, unit) {
  if (!cases.length) return [];
  const spread = Math.max(...cases.map((one) => one.high)) / Math.min(...cases.map((one) => one.low));
  const sceneOf = ({ name }) => name.split("/")[0];
  const scenes = grouped(cases, sceneOf);
  const charts = grouped(cases, (one) => (scenes.get(sceneOf(one)).length < 3 ? "Other cases" : sceneOf(one)));
  return [...charts].map(([title, members]) => {
    const lists = members.map(({ name }) => name.split("/").slice(title === "Other cases" ? 0 : 1));
    const nameOf = (list) => list.filter((word, n) => !lists.every((other) => other[n] === word)).join("/");
    return rangesChart({
      title,
      caption: `Median of the repetitions with their range${members.some((one) => one.baseline) ? "; a cross marks the baseline" : ""}.`,
      x: { label: unit, log: spread > 20 },
      rows: members.map((one, n) => ({ ...one, name: nameOf(lists[n]) || one.name })),
    });
  });
}

function grouped(items, keyOf) {
  const groups = new Map();
  for (const item of items) {
    const key = keyOf(item);
    groups.set(key, [...(groups.get(key) ?? []), item]);
  }
  return groups;
}

const countsOfContacts = {
  pairs: "pairs",
  contacts: "contacts",
  missed: "missed",
  spurious: "spurious",
  near: "inside the condition limit",
  near_missed: "of these missed",
  near_spurious: "of these spurious",
  worst_time_error: "greatest error of a time",
};

function missesTable(families) {
  const heads = ["family", ...Object.values(countsOfContacts)];
  const row = (family) =>
    element(
      "tr",
      {},
      element("th", { scope: "row" }, family.name),
      Object.keys(countsOfContacts).map((key) => element("td", {}, numberText(family[key], 3))),
    );
  return element(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": "First contacts" },
    element(
      "table",
      {},
      element("caption", {}, "First contacts of pairs of needles, compared with the oracle"),
      element("thead", {}, element("tr", {}, heads.map((text) => element("th", { scope: "col" }, text)))),
      element("tbody", {}, families.map(row)),
    ),
  );
}
