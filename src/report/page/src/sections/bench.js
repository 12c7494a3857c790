// The section of measured results: costs over a number that varies among the cases, or side by side.
import { element } from "../dom.js";
import { curvesChart } from "../charts/curves.js";
import { rangesChart } from "../charts/ranges.js";
import { numberText } from "../numbers.js";
import { factList } from "./facts.js";

const units = { us_per_collision: "µs per collision", ns_per_item: "ns per event or pair" };
const numbersOfCases = { n: "density n L³", N: "needles", k: "shape k", threads: "threads", size: "events in the calendar" };

/** Elements of the section. */
export function benchSection(bench) {
  const { about } = bench;
  const facts = factList(
    [
      ["Measured", about.subset ?? about.command ?? "first contacts"],
      ["Command", about.command],
      ["Machine", about.machine, about.cores ? `${about.cores} cores` : ""],
      ["Compiler", about.compiler, about.flags],
      ["Version", about.version, about.commit ? `commit ${about.commit}` : ""],
      ["Date", about.date],
      ["Repetitions", about.rounds],
      ["Accuracy", about.accuracy],
    ],
    "facts",
  );
  if (bench.families) return [facts, missesTable(bench.families)];
  return [facts, element("div", { class: "charts" }, chartsOf(bench))];
}

// "n=0.1,N=10000/capsules/auto/standard/avx512/threads:1" as its numbers and its words.
function partsOf(name) {
  const found = {};
  const words = name.split("/").map((word) =>
    word.split(",").filter((part) => {
      const [, key, value] = part.match(/^([A-Za-z]+)[=:]([0-9.e+-]+)$/) ?? (/^\d+$/.test(part) ? [part, "size", part] : []);
      if (key) found[key] = Number(value);
      return !key;
    }).join(","),
  );
  return { numbers: found, words: words.filter(Boolean) };
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const half = sorted.length / 2;
  return (sorted[Math.floor(half)] + sorted[Math.ceil(half) - 1]) / 2;
}

function chartsOf(bench) {
  const cases = bench.cases.map((one) => ({
    ...one, ...partsOf(one.name), median: median(one.values), low: Math.min(...one.values), high: Math.max(...one.values),
  }));
  const unit = units[bench.unit];
  const axis = axisOf(cases);
  return axis ? overNumber(cases, axis, unit) : sideBySide(cases, unit);
}

// The number that takes the most values, if at least three.
function axisOf(cases) {
  const sizes = Object.keys(numbersOfCases).map((key) => [key, new Set(cases.map((one) => one.numbers[key]).filter((x) => x !== undefined)).size]);
  const [key, size] = sizes.sort((a, b) => b[1] - a[1])[0];
  return size >= 3 ? key : undefined;
}

/** Words that all cases have in common say nothing in a legend. */
function shorten(lists) {
  const common = lists[0].filter((word) => lists.every((list) => list.includes(word)));
  return lists.map((list) => list.filter((word) => !common.includes(word)).join(", "));
}

// A chart for each combination of the other numbers.
function overNumber(cases, axis, unit) {
  const groups = grouped(cases, ({ numbers }) =>
    Object.entries(numbers).filter(([key]) => key !== axis && key !== "threads").map(([key, value]) => `${key} = ${numberText(value)}`).join(", "),
  );
  return [...groups].map(([title, members]) => {
    const families = grouped(members, ({ words, numbers }) =>
      [...words, ...(axis === "threads" ? [] : [numbers.threads > 1 ? `${numbers.threads} threads` : ""])].filter(Boolean).join("/"),
    );
    const names = shorten([...families.keys()].map((name) => name.split("/")));
    return curvesChart({
      title: title ? `Cost, ${title}` : `Cost over ${numbersOfCases[axis]}`,
      caption: "Median of the repetitions with their range.",
      x: { label: numbersOfCases[axis], log: true },
      y: { label: unit, log: true },
      curves: [...families.values()].map((family, n) => {
        const sorted = family.sort((a, b) => a.numbers[axis] - b.numbers[axis]);
        const pick = (key) => Float64Array.from(sorted, (one) => one[key]);
        return {
          name: (names[n] || "all") + (sorted[0].baseline ? " (baseline)" : ""),
          x: Float64Array.from(sorted, (one) => one.numbers[axis]), y: pick("median"), low: pick("low"), high: pick("high"),
          colour: n, dashed: sorted[0].baseline, points: true,
        };
      }),
    });
  });
}

// A chart for each scene, which is the first word.
function sideBySide(cases, unit) {
  const groups = grouped(cases, ({ name }) => name.split("/")[0]);
  return [...groups].map(([scene, members]) => {
    const names = shorten(members.map((one) => one.name.split("/").slice(1)));
    return rangesChart({
      title: `Cost: ${scene}`,
      caption: "Median of the repetitions with their range; a cross marks the baseline.",
      x: { label: unit },
      rows: members.map((one, n) => ({ ...one, name: names[n] || one.name, middle: one.median })),
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

function missesTable(families) {
  const columns = [
    ["pairs", "pairs"], ["contacts", "contacts"], ["missed", "missed"], ["spurious", "spurious"],
    ["near", "undecidable by double precision"], ["near_missed", "of them missed"], ["near_spurious", "of them spurious"],
    ["worst_time_error", "worst error of a time"],
  ];
  return element(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": "First contacts" },
    element(
      "table",
      {},
      element("caption", {}, "First contacts of pairs of needles, compared with the oracle"),
      element("thead", {}, element("tr", {}, ["family", ...columns.map(([, text]) => text)].map((text) => element("th", { scope: "col" }, text)))),
      element(
        "tbody",
        {},
        families.map((family) =>
          element("tr", {}, element("th", { scope: "row" }, family.name), columns.map(([key]) => element("td", {}, numberText(family[key], 3)))),
        ),
      ),
    ),
  );
}
