// A slice through a field as a map of colours, with the flow in the slice as arrows.
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
  flow: { text: "flow |U|", dataset: "flow", size: true, unit: "length / time" },
  ...component("flow", "flow U", "length / time"),
  spin: { text: "spin |Ω|", dataset: "spin", size: true, unit: "radians / time" },
  ...component("spin", "spin Ω", "radians / time"),
  thermal_tr: { text: "thermal energy of translation", dataset: "thermal_tr", unit: "energy" },
  thermal_rot: { text: "thermal energy of rotation", dataset: "thermal_rot", unit: "energy" },
};

function component(dataset, text, unit) {
  return Object.fromEntries(
    axes.map((axis, n) => [`${dataset}_${axis}`, { text: `${text}_${axis}`, dataset, component: n, unit }]),
  );
}

/** `group`: the group of fields; `box`: its edges. Returns a figure with `show(row)`. */
export function fieldMap(group, box, notes) {
  const cells = group.datasets.density.shape.slice(1);
  const state = { row: group.rows - 1, quantity: "density", across: 2, layer: 0, arrows: true };
  const area = element("div", { class: "plot" });
  const bar = element("div", { class: "colour-bar" });
  const redraw = onWidth(area, (width) => {
    const slice = sliceOf(group, cells, box, state);
    area.replaceChildren(draw(slice, state, width));
    area.setAttribute("role", "img");
    area.setAttribute("aria-label", descriptionOf(slice, state));
    fillBar(bar, slice, quantities[state.quantity]);
  });
  const change = (key, parse = (x) => x) => (value) => {
    state[key] = parse(value);
    if (key === "across") replaceLayers();
    redraw();
    figure.refreshTable();
  };
  const layers = element("span");
  const replaceLayers = () => {
    state.layer = Math.min(state.layer, cells[state.across] - 1);
    layers.replaceChildren(layerSlider(cells, box, state, change("layer")));
  };
  replaceLayers();
  const available = Object.entries(quantities).filter(([, q]) => group.datasets[q.dataset]);
  const tools = [
    choice("Field", available.map(([key, q]) => [key, q.text]), state.quantity, change("quantity")),
    choice("Slice across", axes.map((axis, n) => [String(n), axis]), "2", change("across", Number)),
    layers,
    toggle("arrows of the flow", true, change("arrows")),
  ];
  const figure = figureOf(
    {
      title: "Fields",
      caption: "Means over the cells of the grid, in one layer of cells. Arrows show the flow within the layer.",
      notes,
      wide: true,
    },
    { tools, body: element("div", { class: "map" }, area, bar), columns: () => columnsOf(sliceOf(group, cells, box, state)) },
  );
  figure.show = (row) => {
    state.row = row;
    redraw();
    figure.refreshTable();
  };
  return figure;
}

function layerSlider(cells, box, state, onChange) {
  const axis = state.across;
  const text = (n) => {
    const edge = box[axis] / cells[axis];
    return `${axes[axis]} from ${numberText(n * edge, 3)} to ${numberText((n + 1) * edge, 3)}`;
  };
  return slider("Layer", cells[axis] - 1, state.layer, text, onChange);
}

// The two axes of the slice, and its values, the first axis running fastest.
function sliceOf(group, cells, box, { row, quantity, across, layer }) {
  const { dataset, component: part, size, unit, text } = quantities[quantity];
  const [a, b] = [0, 1, 2].filter((axis) => axis !== across);
  const [width, height] = [cells[a], cells[b]];
  const field = rowOf(group.datasets[dataset], row);
  const flow = rowOf(group.datasets.flow, row);
  const values = new Float64Array(width * height);
  const arrows = [];
  for (let n = 0; n < values.length; ++n) {
    const place = [];
    place[a] = n % width;
    place[b] = Math.floor(n / width);
    place[across] = layer;
    const cell = (place[0] * cells[1] + place[1]) * cells[2] + place[2];
    const vector = (from) => from.subarray(3 * cell, 3 * cell + 3);
    if (size) values[n] = Math.hypot(...vector(field));
    else if (part !== undefined) values[n] = field[3 * cell + part];
    else values[n] = field[cell];
    arrows.push([vector(flow)[a], vector(flow)[b]]);
  }
  const edges = [box[a], box[b]];
  return { axes: [axes[a], axes[b]], width, height, edges, values, arrows, unit, text, signed: part !== undefined };
}

function rangeOf({ values, signed }) {
  const low = Math.min(...values);
  const high = Math.max(...values);
  if (!signed) return [Math.min(low, high), high > low ? high : low + (Math.abs(low) || 1)];
  const size = Math.max(Math.abs(low), Math.abs(high)) || 1;
  return [-size, size];
}

function draw(slice, state, width) {
  const { edges, values } = slice;
  const [low, high] = rangeOf(slice);
  const scale = slice.signed ? scales.diverging : scales.sequential;
  const inner = Math.min(width - 60, 520);
  return Plot.plot({
    width: inner + 60,
    height: Math.round((inner * edges[1]) / edges[0]) + 50,
    marginLeft: 44,
    marginBottom: 36,
    marginTop: 14,
    marginRight: 16,
    style: { background: "none", color: "var(--ink)", fontSize: "12px" },
    x: { domain: [0, edges[0]], label: slice.axes[0], labelAnchor: "center", labelArrow: "none" },
    y: { domain: [0, edges[1]], label: slice.axes[1], labelAnchor: "top", labelArrow: "none" },
    color: { type: "linear", domain: [low, high], interpolate: scale, range: [0, 1] },
    marks: [
      Plot.raster(values, {
        width: slice.width, height: slice.height, x1: 0, y1: 0, x2: edges[0], y2: edges[1], imageRendering: "pixelated",
      }),
      state.arrows ? arrowsOf(slice, inner) : null,
      Plot.frame({ stroke: "var(--ink)" }),
    ],
  });
}

function arrowsOf({ width, height, edges, arrows }, pixels) {
  const places = arrows.map((_, n) => n);
  const most = Math.max(...arrows.map(([x, y]) => Math.hypot(x, y))) || 1;
  const cell = Math.min(pixels / width, (pixels * edges[1]) / edges[0] / height);
  return Plot.vector(places, {
    x: (n) => (((n % width) + 0.5) * edges[0]) / width,
    y: (n) => ((Math.floor(n / width) + 0.5) * edges[1]) / height,
    rotate: (n) => (Math.atan2(arrows[n][0], arrows[n][1]) * 180) / Math.PI,
    length: { value: (n) => (Math.hypot(...arrows[n]) / most) * cell * 1.1, scale: null },
    anchor: "middle",
    stroke: "white",
    strokeWidth: 1.2,
  });
}

function fillBar(bar, slice, { unit, text }) {
  const [low, high] = rangeOf(slice);
  const gradient = element("span", { class: "gradient" });
  gradient.style.background = gradientOf(slice.signed ? scales.diverging : scales.sequential);
  bar.replaceChildren(
    element("span", {}, `${text} (${unit})`),
    element("span", { class: "ends" }, element("span", {}, numberText(low, 3)), gradient, element("span", {}, numberText(high, 3))),
  );
}

function descriptionOf(slice, state) {
  const [low, high] = rangeOf(slice);
  return `Map of the ${slice.text} in layer ${state.layer + 1} across ${axes[state.across]}: ${numberText(low)} to ${numberText(high)} ${slice.unit}`;
}

function columnsOf(slice) {
  const places = Array.from(slice.values, (_, n) => n);
  const middle = (n, count, edge) => ((n + 0.5) * edge) / count;
  return [
    { name: slice.axes[0], values: places.map((n) => middle(n % slice.width, slice.width, slice.edges[0])) },
    { name: slice.axes[1], values: places.map((n) => middle(Math.floor(n / slice.width), slice.height, slice.edges[1])) },
    { name: `${slice.text} (${slice.unit})`, values: slice.values },
    { name: `flow along ${slice.axes[0]}`, values: slice.arrows.map(([x]) => x) },
    { name: `flow along ${slice.axes[1]}`, values: slice.arrows.map(([, y]) => y) },
  ];
}
