// A chart of named values with ranges, one line each.
import * as Plot from "@observablehq/plot";
import { element, onWidth, toggle } from "../dom.js";
import { logTicks, logTickText, numberText } from "../numbers.js";
import { figureOf } from "./figure.js";

/** `rows`: {name, low, middle, high, baseline}, all above 0. `x`: {label, log}. */
export function rangesChart(chart) {
  const { rows } = chart;
  let { log } = chart.x;
  const area = element("div", { class: "plot", role: "img" });
  area.setAttribute("aria-label", `${chart.title}: ${rows.map((row) => `${row.name} ${numberText(row.middle, 3)}`).join("; ")} ${chart.x.label}`);
  const redraw = onWidth(area, (width) => area.replaceChildren(draw(chart, log, width)));
  const button = toggle("log x", log, (pressed) => {
    log = pressed;
    redraw();
  });
  const figure = figureOf(chart, {
    tools: [button],
    body: area,
    columns: () => [
      { name: "case", values: rows.map((row) => row.name) },
      { name: `median, ${chart.x.label}`, values: rows.map((row) => row.middle) },
      { name: "least", values: rows.map((row) => row.low) },
      { name: "most", values: rows.map((row) => row.high) },
    ],
  });
  figure.dataset.points = rows.length;
  return figure;
}

function draw({ rows, x }, log, width) {
  const low = Math.min(...rows.map((row) => row.low));
  const high = Math.max(...rows.map((row) => row.high));
  const domain = log ? [low / 1.2, high * 1.2] : [0, high * 1.05];
  const ticks = log ? { ticks: logTicks(domain), text: logTickText } : { ticks: Math.max(3, Math.round(width / 110)), text: (v) => numberText(v) };
  const longest = Math.max(...rows.map((row) => row.name.length));
  // Names stand above their lines where there is no room beside them.
  const beside = longest * 6.4 + 16 < width * 0.55;
  return Plot.plot({
    width,
    height: rows.length * (beside ? 24 : 36) + 56,
    marginLeft: beside ? longest * 6.4 + 16 : 12,
    marginRight: 52,
    marginTop: beside ? 8 : 18,
    marginBottom: 40,
    style: { background: "none", color: "var(--ink)", fontSize: "12px", overflow: "visible" },
    x: { type: log ? "log" : "linear", domain, label: null },
    y: { domain: rows.map((_, n) => n), label: null, axis: null, type: "band" },
    marks: [
      Plot.gridX({ ticks: ticks.ticks, stroke: "var(--grid)", strokeOpacity: 1 }),
      Plot.axisX({ ...ticks, label: x.label, labelAnchor: "center", labelArrow: "none" }),
      Plot.ruleY(rows, { y: (_, n) => n, x1: "low", x2: "high", stroke: "var(--curve-0)", strokeWidth: 2 }),
      Plot.dot(rows, { y: (_, n) => n, x: "middle", r: 4, fill: (row) => (row.baseline ? "none" : "var(--curve-0)"), stroke: "var(--curve-0)", symbol: (row) => (row.baseline ? "times" : "circle") }),
      Plot.text(rows, { y: (_, n) => n, x: "high", text: (row) => numberText(row.middle, 3), textAnchor: "start", dx: 8, fill: "var(--ink)" }),
      Plot.text(rows, beside
        ? { y: (_, n) => n, frameAnchor: "left", text: "name", textAnchor: "end", dx: -8, fill: "var(--ink)" }
        : { y: (_, n) => n, frameAnchor: "left", text: "name", textAnchor: "start", dy: -13, fill: "var(--ink)" }),
    ],
  });
}
