// Reads values off a chart: with the mouse, or with the arrow keys while the chart has the focus. The
// legend shows them, and a screen reader hears them.
import { element } from "../dom.js";
import { numberText } from "../numbers.js";
import { colourOf } from "./colours.js";

const svg = "http://www.w3.org/2000/svg";

/** `attach(plot, curves)` puts a drawn chart in place. */
export function makeReader(area, chart) {
  const legend = element("ul", { class: "legend" });
  const spoken = element("div", { class: "spoken", "aria-live": "polite" });
  area.append(spoken);
  area.tabIndex = 0;
  area.setAttribute("role", "application");
  area.setAttribute("aria-roledescription", "chart");
  area.setAttribute("aria-label", `${chart.title}. ${chart.y.label} over ${chart.x.label}. Arrow keys read values.`);

  let plot = null;
  let curves = [];
  let places = []; // x of all points, ascending, each once
  let position = null;

  const show = () => {
    const x = position === null ? null : places[position];
    drawRule(plot, x);
    legend.replaceChildren(...curves.map((curve) => legendItem(curve, x, curves.length)));
    if (x !== null) {
      legend.append(element("li", { class: "where" }, `${chart.x.label}: ${numberText(x)}`));
    }
  };
  const move = (to) => {
    position = to;
    show();
  };
  const speak = () => {
    const x = places[position];
    const values = curves.map((curve) => `${curve.name} ${numberText(valueAt(curve, x))}`);
    spoken.textContent = `${chart.x.label} ${numberText(x)}: ${values.join("; ")}`;
  };

  area.addEventListener("pointermove", (event) => {
    if (!plot || !places.length) return;
    const box = plot.getBoundingClientRect();
    const scale = plot.scale("x");
    const pixel = ((event.clientX - box.left) * plot.viewBox.baseVal.width) / box.width;
    move(nearest(places.map(scale.apply), pixel));
  });
  area.addEventListener("pointerleave", () => move(null));
  area.addEventListener("blur", () => move(null));
  area.addEventListener("keydown", (event) => {
    const steps = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10, Home: -Infinity, End: Infinity };
    const step = steps[event.key];
    if (step === undefined || !places.length) return;
    event.preventDefault();
    const from = position ?? (step > 0 ? -1 : places.length);
    move(Math.min(Math.max(from + step, 0), places.length - 1));
    speak();
  });

  return {
    legend,
    attach(drawn, shown) {
      plot?.remove();
      plot = drawn;
      curves = shown;
      const all = curves.flatMap((curve) => [...curve.x]).filter((x) => visible(plot, x));
      places = [...new Set(all)].sort((a, b) => a - b);
      position = null;
      plot.setAttribute("aria-hidden", "true");
      area.prepend(plot);
      show();
    },
  };
}

function visible(plot, x) {
  return Number.isFinite(x) && Number.isFinite(plot.scale("x").apply(x));
}

function nearest(pixels, pixel) {
  let best = 0;
  for (let n = 1; n < pixels.length; ++n) {
    if (Math.abs(pixels[n] - pixel) < Math.abs(pixels[best] - pixel)) best = n;
  }
  return best;
}

function valueAt(curve, x) {
  const n = curve.x.indexOf(x);
  return n < 0 ? NaN : curve.y[n];
}

function legendItem(curve, x, count) {
  const key = element("span", { class: ["key", curve.dashed && "dashed", (curve.points || curve.borders) && "dotted", curve.points === "alone" && "alone"].filter(Boolean).join(" ") });
  key.style.color = colourOf(curve.colour);
  if (curve.faint) key.style.opacity = 0.5;
  const value = x === null ? [] : [element("b", {}, numberText(valueAt(curve, x)))];
  return element("li", {}, count > 0 ? key : null, curve.name, " ", ...value);
}

function drawRule(plot, x) {
  plot.querySelector(".reading")?.remove();
  if (x === null) return;
  const rule = document.createElementNS(svg, "line");
  const pixel = plot.scale("x").apply(x);
  const [bottom, top] = plot.scale("y").range;
  for (const [name, value] of Object.entries({ class: "reading", x1: pixel, x2: pixel, y1: top, y2: bottom })) {
    rule.setAttribute(name, value);
  }
  plot.append(rule);
}
