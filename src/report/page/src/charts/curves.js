// A chart of curves over one axis: of time, of the bins of a histogram, of a parameter.
import * as Plot from "@observablehq/plot";
import { element, onWidth, toggle } from "../dom.js";
import { logTicks, logTickText, numberText, powerOfTen } from "../numbers.js";
import { colourOf } from "./colours.js";
import { figureOf } from "./figure.js";
import { makeReader } from "./reader.js";

/**
 * `chart`: title, caption, the group that it is about, x and y {label, log}, and curves {name, x, y,
 * colour}: numbers of equal lengths. Also of a curve: `low` and `high`, its errors; `dashed` or `faint`; `points`: true, or
 * "alone" without a line; `borders`: those of the bins whose middles are x; `beside`: a logarithmic
 * axis does not have to show all of it. With `robust`, the y axis leaves out rare values that are far
 * from all others; `range` is where x begins and ends, if not where the curves do. Returns a figure with
 * `update(curves, range)`.
 */
export function curvesChart(chart) {
  let { curves, range } = chart;
  const logs = { x: chart.x.log ?? false, y: chart.y.log ?? false };
  const area = element("div", { class: "plot" });
  const reader = makeReader(area, chart);
  const redraw = onWidth(area, (width) => {
    const plot = draw(chart, curves, range, logs, width);
    reader.attach(plot, curves);
  });
  const tools = ["x", "y"]
    .filter((axis) => chart[axis].canBeLog ?? true)
    .map((axis) => {
      const button = toggle(`log ${axis}`, logs[axis], (pressed) => {
        logs[axis] = pressed;
        redraw();
      });
      button.setAttribute("aria-label", `${chart.title}: logarithmic ${axis} axis`);
      return button;
    });
  const figure = figureOf(chart, {
    tools,
    body: element("div", {}, area, reader.legend),
    columns: () => columnsOf(chart, curves),
  });
  if (chart.group) figure.dataset.group = chart.group;
  figure.dataset.points = curves.map((curve) => curve.x.length).join(" ");
  figure.update = (changed, changedRange) => {
    curves = changed;
    range = changedRange;
    redraw();
    figure.refreshTable();
  };
  return figure;
}

function draw(chart, curves, range, logs, width) {
  const domains = { x: (!logs.x && range) || domainOf(curves, "x", logs.x), y: domainOf(curves, "y", logs.y, chart.robust) };
  const axis = (name) => {
    const log = logs[name];
    return {
      type: log ? "log" : "linear",
      domain: domains[name],
      nice: !log && name === "y",
      label: null,
    };
  };
  const axes = { x: ticksOf("x", domains.x, logs.x, width), y: ticksOf("y", domains.y, logs.y, width) };
  const labels = { x: `${chart.x.label}${axes.x.factor}`, y: `${chart.y.label}${axes.y.factor}` };
  return Plot.plot({
    width,
    height: Math.round(Math.min(340, Math.max(220, width * 0.56))),
    marginLeft: 56,
    marginRight: 16,
    marginTop: 26,
    marginBottom: 40,
    style: { background: "none", color: "var(--ink)", fontSize: "12px", overflow: "visible" },
    x: axis("x"),
    y: axis("y"),
    marks: [
      Plot.gridX({ ticks: axes.x.ticks, stroke: "var(--grid)", strokeOpacity: 1 }),
      Plot.gridY({ ticks: axes.y.ticks, stroke: "var(--grid)", strokeOpacity: 1 }),
      Plot.axisX({ ...axes.x, label: labels.x, labelAnchor: "center", labelArrow: "none" }),
      Plot.axisY({ ...axes.y, label: labels.y, labelAnchor: "top", labelArrow: "none" }),
      ...curves.flatMap((curve) => marksOf(curve, logs)),
    ],
  });
}

// Numbers far from 1 have their power of ten beside the label of the axis. `text` and not `tickFormat`,
// of which Plot leaves some out on logarithmic axes.
function ticksOf(name, domain, log, width) {
  const count = name === "x" ? Math.max(3, Math.round(width / 90)) : 5;
  if (log) {
    return { ticks: logTicks(domain, name === "x" && width < 420 ? 5 : 7), text: logTickText, factor: "" };
  }
  const size = Math.max(Math.abs(domain[0]), Math.abs(domain[1]));
  const exponent = size >= 1e5 || size < 1e-2 ? Math.floor(Math.log10(size)) : 0;
  const factor = exponent ? ` (${powerOfTen(exponent)})` : "";
  return { ticks: count, text: (x) => numberText(x / 10 ** exponent, 5), factor };
}

// Logarithms are of positive numbers; others leave gaps.
function drawable(values, log) {
  return Float64Array.from(values, (v) => (Number.isFinite(v) && (!log || v > 0) ? v : NaN));
}

// Bins as steps; as points on a logarithmic axis, where steps cannot go down to empty bins.
function marksOf(curve, logs) {
  const steps = curve.borders && !logs.y;
  const alone = curve.points === "alone" || (curve.borders && logs.y);
  const x = drawable(curve.x, logs.x);
  const y = drawable(curve.y, logs.y);
  const stroke = colourOf(curve.colour);
  const length = { length: x.length };
  const marks = [];
  if (curve.low) {
    const range = { x, y1: drawable(curve.low, logs.y), y2: drawable(curve.high, logs.y) };
    marks.push(
      alone
        ? Plot.ruleX(length, { ...range, stroke, strokeWidth: 1.5 })
        : Plot.areaY(length, { ...range, fill: stroke, fillOpacity: 0.18 }),
    );
  }
  if (!alone) {
    marks.push(
      Plot.lineY({ length: steps ? x.length + 1 : x.length }, {
        x: steps ? drawable(curve.borders, logs.x) : x,
        y: steps ? [...y, y.at(-1)] : y,
        stroke,
        strokeWidth: curve.faint ? 1 : 1.75,
        strokeOpacity: curve.faint ? 0.6 : 1,
        strokeDasharray: curve.dashed ? "5 4" : undefined,
        curve: steps ? "step-after" : "linear",
        clip: true,
      }),
    );
  }
  if (curve.points || alone) marks.push(Plot.dot(length, { x, y, fill: stroke, r: alone ? 2.5 : 2, clip: true }));
  return marks;
}

function domainOf(curves, axis, log, robust) {
  const usable = (value) => Number.isFinite(value) && (!log || value > 0);
  const inside = curves.filter((curve) => !(log && curve.beside));
  const values = inside.flatMap((curve) => {
    const parts = axis === "x" ? [curve.borders ?? curve.x] : [curve.y, curve.low ?? [], curve.high ?? []];
    return parts.flatMap((part) => Array.from(part).filter(usable));
  });
  if (!values.length) return log ? [1, 10] : [0, 1];
  const [low, high] = robust ? withoutRare(values) : rangeOf(values);
  if (log) return axis === "y" || low === high || inside.some((curve) => curve.low) ? [low / 1.15, high * 1.15] : [low, high];
  if (low === high) return [low - Math.abs(low || 1) * 0.1, high + Math.abs(high || 1) * 0.1];
  const alone = inside.some((curve) => curve.points === "alone");
  const margin = axis === "y" || alone ? 0.05 * (high - low) : 0;
  return [low - (low >= 0 && low < margin ? low : margin), high + margin];
}

function rangeOf(values) {
  return values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
}

// The range of the middle 90 %, if that of all is more than five times as large.
function withoutRare(values) {
  const sorted = Float64Array.from(values).sort();
  const [low, high] = rangeOf(values);
  const [first, last] = [0.05, 0.95].map((share) => sorted[Math.round(share * (sorted.length - 1))]);
  const margin = 0.3 * (last - first);
  return high - low > 5 * (last - first) && last > first ? [first - margin, last + margin] : [low, high];
}

// One column of x where all curves have the same, else one before each curve.
function columnsOf(chart, curves) {
  const shared = curves.every((curve) => sameNumbers(curve.x, curves[0].x));
  const columns = shared && curves.length ? [{ name: chart.x.label, values: curves[0].x }] : [];
  for (const curve of curves) {
    if (!shared) columns.push({ name: `${chart.x.label} (${curve.name})`, values: curve.x });
    columns.push({ name: curve.name, values: curve.y });
    if (curve.low) {
      columns.push({ name: `${curve.name}, from`, values: curve.low });
      columns.push({ name: `${curve.name}, to`, values: curve.high });
    }
  }
  return columns;
}

function sameNumbers(a, b) {
  return a === b || (a.length === b.length && a.every((value, n) => value === b[n]));
}
