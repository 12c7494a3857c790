// A chart of curves over one axis: of time, of the bins of a histogram, of a parameter.
import * as Plot from "@observablehq/plot";
import { element, onWidth, toggle } from "../dom.js";
import { logTicks, logTickText, numberText } from "../numbers.js";
import { colourOf } from "./colours.js";
import { figureOf } from "./figure.js";
import { makeReader } from "./reader.js";

/**
 * `chart`: title, caption, x and y {label, log}, and curves {name, x, y, colour, dashed, faint,
 * points, low, high, steps}: numbers of equal lengths. `steps` draws bins, whose middles are x.
 * Returns a figure with `update(curves)`.
 */
export function curvesChart(chart) {
  let curves = chart.curves;
  const logs = { x: chart.x.log ?? false, y: chart.y.log ?? false };
  const area = element("div", { class: "plot" });
  const reader = makeReader(area, chart);
  const redraw = onWidth(area, (width) => {
    const plot = draw(chart, curves, logs, width);
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
  figure.dataset.points = curves.map((curve) => curve.x.length).join(" ");
  figure.update = (changed) => {
    curves = changed;
    redraw();
    figure.refreshTable();
  };
  return figure;
}

function draw(chart, curves, logs, width) {
  const domains = { x: domainOf(curves, "x", logs.x), y: domainOf(curves, "y", logs.y) };
  const axis = (name) => {
    const log = logs[name];
    return {
      type: log ? "log" : "linear",
      domain: domains[name],
      nice: !log && name === "y",
      label: null,
    };
  };
  const ticks = (name) =>
    logs[name]
      ? { ticks: logTicks(domains[name], name === "x" && width < 420 ? 5 : 7), tickFormat: logTickText }
      : { ticks: name === "x" ? Math.max(3, Math.round(width / 90)) : 5, tickFormat: (x) => numberText(x, 6) };
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
      Plot.gridX({ ...ticks("x"), stroke: "var(--grid)", strokeOpacity: 1 }),
      Plot.gridY({ ...ticks("y"), stroke: "var(--grid)", strokeOpacity: 1 }),
      Plot.axisX({ ...ticks("x"), label: chart.x.label, labelAnchor: "center", labelArrow: "none" }),
      Plot.axisY({ ...ticks("y"), label: chart.y.label, labelAnchor: "top", labelArrow: "none" }),
      ...curves.flatMap((curve) => marksOf(curve, logs)),
    ],
  });
}

// Logarithms are of positive numbers; others leave gaps.
function drawable(values, log) {
  return Float64Array.from(values, (v) => (Number.isFinite(v) && (!log || v > 0) ? v : NaN));
}

function marksOf(curve, logs) {
  const x = drawable(curve.x, logs.x);
  const y = drawable(curve.y, logs.y);
  const stroke = colourOf(curve.colour);
  const length = { length: x.length };
  const marks = [];
  if (curve.low) {
    const range = { x, y1: drawable(curve.low, logs.y), y2: drawable(curve.high, logs.y) };
    marks.push(
      curve.points === "alone"
        ? Plot.ruleX(length, { ...range, stroke, strokeWidth: 1.5 })
        : Plot.areaY(length, { ...range, fill: stroke, fillOpacity: 0.18 }),
    );
  }
  if (curve.points !== "alone") {
    marks.push(
      Plot.lineY(length, {
        x,
        y,
        stroke,
        strokeWidth: curve.faint ? 1 : 1.75,
        strokeOpacity: curve.faint ? 0.45 : 1,
        strokeDasharray: curve.dashed ? "5 4" : undefined,
        curve: curve.steps ? "step" : "linear",
      }),
    );
  }
  if (curve.points) marks.push(Plot.dot(length, { x, y, fill: stroke, r: curve.points === "alone" ? 2.5 : 2 }));
  return marks;
}

function domainOf(curves, axis, log) {
  let low = Infinity;
  let high = -Infinity;
  const take = (values) => {
    for (const value of values ?? []) {
      if (!Number.isFinite(value) || (log && value <= 0)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  };
  for (const curve of curves) {
    take(curve[axis]);
    if (axis === "y") {
      take(curve.low);
      take(curve.high);
    }
  }
  if (low > high) return log ? [1, 10] : [0, 1];
  if (log) return axis === "y" || low === high ? [low / 1.15, high * 1.15] : [low, high];
  if (low === high) return [low - Math.abs(low || 1) * 0.1, high + Math.abs(high || 1) * 0.1];
  const margin = axis === "y" ? 0.04 * (high - low) : 0;
  return [low - (low >= 0 && low < margin ? low : margin), high + margin];
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
