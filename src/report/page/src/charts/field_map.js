// Slices through a field across each axis as maps of colours, with the flow in the slices as arrows.
import * as Plot from "@observablehq/plot";
import { choice, element, onWidth, slider, toggle } from "../dom.js";
import { rowOf } from "../data.js";
import { numberText } from "../numbers.js";
import { gradientOf, scales } from "./colours.js";
import { figureOf } from "./figure.js";

const axes = ["x", "y", "z"];

/** What can be shown: the dataset, and for vectors how a number is made of one. */
const quantities = {
  density: { text: "density", dataset: "density", unit: "needles per volume" },
  ...partsOf("flow", "flow", "U", "length / time"),
  ...partsOf("spin", "spin", "Ω", "radians / time"),
  thermal_tr: { text: "thermal energy of translation", dataset: "thermal_tr", unit: "energy" },
  thermal_rot: { text: "thermal energy of rotation", dataset: "thermal_rot", unit: "energy" },
};

function partsOf(dataset, word, letter, unit) {
  const size = [dataset, { text: `${word} |${letter}|`, dataset, size: true, unit }];
  const components = axes.map((axis, n) => [`${dataset}_${axis}`, { text: `${word} ${letter}_${axis}`, dataset, component: n, unit }]);
  return Object.fromEntries([size, ...components]);
}

/** `group`: the group of fields; `box`: its edges. Returns a figure with `show(row)`. */
export function fieldMap(group, box, notes) {
  const cells = group.datasets.density.shape.slice(1);
  const state = { row: group.rows - 1, quantity: "density", arrows: true, layers: cells.map((n) => Math.floor(n / 2)) };
  const bar = element("div", { class: "colour-bar" });
  const field = () => fieldOf(group, cells, box, state);
  const maps = axes.map((_, across) => sliceMap(field, across, state));
  const change = (key) => (value) => {
    state[key] = value;
    redraw();
  };
  const available = Object.entries(quantities).filter(([, q]) => group.datasets[q.dataset]);
  const figure = figureOf(
    {
      title: "Fields",
      caption: "Means over the cells of the grid, in one layer of cells across each axis. Arrows show the flow within the layer.",
      notes,
      wide: true,
    },
    {
      tools: [
        choice("Field", available.map(([key, q]) => [key, q.text]), state.quantity, change("quantity")),
        toggle("arrows of the flow", true, change("arrows")),
      ],
      body: element("div", {}, element("div", { class: "maps" }, maps.map((map) => map.element)), bar),
      columns: () => columnsOf(field()),
    },
  );
  const redraw = () => {
    for (const map of maps) map.redraw();
    fillBar(bar, field());
    figure.refreshTable();
  };
  fillBar(bar, field());
  figure.show = change("row");
  return figure;
}

// One slice with the slider that moves it.
function sliceMap(field, across, state) {
  const area = element("div", { class: "plot", role: "img" });
  const redraw = onWidth(area, (width) => {
    const now = field();
    const slice = sliceOf(now, across, state.layers[across]);
    area.setAttribute("aria-label", descriptionOf(now, slice, across));
    area.replaceChildren(draw(now, slice, state.arrows, width));
  });
  const { cells, box } = field();
  const edge = box[across] / cells[across];
  const text = (n) => `${numberText(n * edge, 3)} to ${numberText((n + 1) * edge, 3)}`;
  const layer = slider(axes[across], cells[across] - 1, state.layers[across], text, (n) => {
    state.layers[across] = n;
    redraw();
  });
  return { element: element("div", {}, area, layer), redraw };
}

// The numbers of the chosen quantity in all cells, z running fastest.
function fieldOf(group, cells, box, { row, quantity }) {
  const { dataset, component, size, unit, text } = quantities[quantity];
  const data = rowOf(group.datasets[dataset], row);
  const flow = rowOf(group.datasets.flow, row);
  const count = cells[0] * cells[1] * cells[2];
  const valueAt = (cell) => {
    if (size) return Math.hypot(data[3 * cell], data[3 * cell + 1], data[3 * cell + 2]);
    return component === undefined ? data[cell] : data[3 * cell + component];
  };
  const values = Float64Array.from({ length: count }, (_, cell) => valueAt(cell));
  return { values, flow, cells, box, text, unit, ...rangeOf(values, component !== undefined) };
}

function rangeOf(values, signed) {
  const low = values.reduce((a, b) => Math.min(a, b), Infinity);
  const high = values.reduce((a, b) => Math.max(a, b), -Infinity);
  if (signed) {
    const size = Math.max(Math.abs(low), Math.abs(high)) || 1;
    return { range: [-size, size], scale: scales.diverging };
  }
  return { range: [low, high > low ? high : low + (Math.abs(low) || 1)], scale: scales.sequential };
}

// A layer of cells, the first of its two axes running fastest.
function sliceOf({ values, flow, cells, box }, across, layer) {
  const [a, b] = [0, 1, 2].filter((axis) => axis !== across);
  const [width, height] = [cells[a], cells[b]];
  const places = Array.from({ length: width * height }, (_, n) => {
    const place = [];
    place[a] = n % width;
    place[b] = Math.floor(n / width);
    place[across] = layer;
    return (place[0] * cells[1] + place[1]) * cells[2] + place[2];
  });
  return {
    width,
    height,
    edges: [box[a], box[b]],
    axes: [axes[a], axes[b]],
    values: places.map((cell) => values[cell]),
    arrows: places.map((cell) => [flow[3 * cell + a], flow[3 * cell + b]]),
  };
}

function draw({ range, scale }, slice, withArrows, width) {
  const { edges } = slice;
  const margin = 40;
  const inner = Math.min(width - margin - 14, 520);
  return Plot.plot({
    width: inner + margin + 14,
    height: Math.round((inner * edges[1]) / edges[0]) + 54,
    marginLeft: margin,
    marginRight: 14,
    marginTop: 18,
    marginBottom: 36,
    style: { background: "none", color: "var(--ink)", fontSize: "12px" },
    x: { domain: [0, edges[0]], label: slice.axes[0], labelAnchor: "center", labelArrow: "none", ticks: 5 },
    y: { domain: [0, edges[1]], label: slice.axes[1], labelAnchor: "top", labelArrow: "none", ticks: 5 },
    color: { type: "linear", domain: range, interpolate: scale, range: [0, 1] },
    marks: [
      Plot.raster(slice.values, {
        width: slice.width, height: slice.height, x1: 0, y1: 0, x2: edges[0], y2: edges[1], imageRendering: "pixelated",
      }),
      withArrows ? arrowsOf(slice, inner) : null,
      Plot.frame({ stroke: "var(--ink)" }),
    ],
  });
}

// White on a dark ground of their own, to be seen on all colours.
function arrowsOf({ width, height, edges, arrows }, pixels) {
  const most = Math.max(...arrows.map(([x, y]) => Math.hypot(x, y))) || 1;
  const cell = Math.min(pixels / width, (pixels * edges[1]) / edges[0] / height);
  const options = {
    x: (_, n) => (((n % width) + 0.5) * edges[0]) / width,
    y: (_, n) => ((Math.floor(n / width) + 0.5) * edges[1]) / height,
    rotate: ([x, y]) => (Math.atan2(x, y) * 180) / Math.PI,
    length: { value: arrows.map(([x, y]) => (Math.hypot(x, y) / most) * cell * 1.1), scale: null },
    anchor: "middle",
  };
  return [
    Plot.vector(arrows, { ...options, stroke: "#000", strokeOpacity: 0.55, strokeWidth: 3 }),
    Plot.vector(arrows, { ...options, stroke: "#fff", strokeWidth: 1.3 }),
  ];
}

function fillBar(bar, { range, scale, unit, text }) {
  const gradient = element("span", { class: "gradient" });
  gradient.style.background = gradientOf(scale);
  bar.replaceChildren(
    element("span", {}, `${text} (${unit})`),
    element("span", { class: "ends" }, element("span", {}, numberText(range[0], 3)), gradient, element("span", {}, numberText(range[1], 3))),
  );
}

function descriptionOf({ text, unit }, { values }, across) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  return `Map of the ${text} in a layer across ${axes[across]}: ${numberText(low)} to ${numberText(high)} ${unit}`;
}

// All cells, with the middles of their places.
function columnsOf({ values, flow, cells, box, text, unit }) {
  const steps = [cells[1] * cells[2], cells[2], 1];
  const middle = (axis) => Array.from(values, (_, cell) => (((Math.floor(cell / steps[axis]) % cells[axis]) + 0.5) * box[axis]) / cells[axis]);
  return [
    ...axes.map((name, axis) => ({ name, values: middle(axis) })),
    { name: `${text} (${unit})`, values },
    ...axes.map((name, axis) => ({ name: `flow U_${name}`, values: Array.from(values, (_, cell) => flow[3 * cell + axis]) })),
  ];
}
